"""Draw the map of the title page, for the light and the dark theme, from the arrays of this build.

`python tools/draw_vignette.py build/arrays/ch04_figure_4_04a.nc build/pictures`
"""

import sys
from pathlib import Path

from compendium.plotting.vignette import DARK, LIGHT, vignette
from facegear.support.labelled import load


def main(arrays: Path, folder: Path) -> None:
    """Write `vignette_light.svg` and `vignette_dark.svg`."""
    chart = load(arrays)
    folder.mkdir(parents=True, exist_ok=True)
    for name, look in {"light": LIGHT, "dark": DARK}.items():
        vignette(chart, look).savefig(folder / f"vignette_{name}.svg", dpi=200, metadata={"Date": None})


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
