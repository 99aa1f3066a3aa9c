"""One look for every figure: colours that colour-blind readers can tell apart, sizes that survive a narrow screen."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
from matplotlib import rcsetup
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import QuadMesh
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedFormatter

P = ParamSpec("P")
R = TypeVar("R")

# Okabe and Ito's palette, in the order in which it is used for lines.
BLUE, VERMILION, GREEN, ORANGE, SKY, PURPLE = "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7"
INK, GREY, FAINT = "#222222", "#767676", "#D9D9D9"
STEEL = "#B8C4CE"  # bodies of gears

# White is stable. The lightest unstable colour is well off white, and all get darker with growth, in grey too.
GROWTH = LinearSegmentedColormap.from_list("growth", mpl.colormaps["YlGnBu"](np.linspace(0.28, 1.0, 256)))

# Inches; the text column of the book is about 7.3 in wide at 100 dpi.
WIDTH = 7.2

_SETTINGS = {
    "axes.edgecolor": INK,
    "axes.grid": True,
    "axes.labelsize": 11,
    "axes.linewidth": 0.8,
    "axes.prop_cycle": rcsetup.cycler(color=[BLUE, VERMILION, GREEN, ORANGE, SKY, PURPLE]),
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 11,
    "figure.facecolor": "white",
    "font.size": 11,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "legend.fontsize": 10,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "mathtext.fontset": "cm",
    "savefig.facecolor": "white",
    "xtick.labelsize": 10,
    "ytick.labelsize": 10,
}


# A hyphen before a number, where no word, formula or other number ends.
_HYPHEN = re.compile(r"(?<![\w$\\{}^.)\]-])-(?=[\d.])")


def styled(draw: Callable[P, R]) -> Callable[P, R]:
    """Run a drawing function under the book's settings, leaving Matplotlib's own as they were.

    Numbers in the texts of a figure that it returns have a minus sign, as those that Matplotlib writes itself.
    """

    @functools.wraps(draw)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> R:
        with mpl.rc_context(_SETTINGS):  # type: ignore[arg-type]
            drawn = draw(*args, **kwargs)
            if isinstance(drawn, Figure):
                _write_minus_signs(drawn)
            return drawn

    return wrapper


def with_minus_signs(text: str) -> str:
    """Write a minus sign for the hyphen before a number; formulas, which have theirs, are left alone.

    Examples
    --------
    >>> with_minus_signs("-0.25 at (1-8), 1e-05") == "\N{MINUS SIGN}0.25 at (1-8), 1e-05"
    True
    """
    parts = text.split("$")
    # Without a second dollar sign the first one is a dollar sign.
    formulas = len(parts) % 2 == 1
    return "$".join(
        part if formulas and number % 2 else _HYPHEN.sub("\N{MINUS SIGN}", part)
        for number, part in enumerate(parts)
    )


def _write_minus_signs(figure: Figure) -> None:
    for text in figure.findobj(Text):
        text.set_text(with_minus_signs(text.get_text()))
    for axis in figure.findobj(Axis):
        for formatter in (axis.get_major_formatter(), axis.get_minor_formatter()):
            if isinstance(formatter, FixedFormatter):
                formatter.seq = [with_minus_signs(label) for label in formatter.seq]


def panels(rows: int = 1, columns: int = 1, height: float = 4.0, **options: Any) -> tuple[Figure, list[Axes]]:
    """Figure of the book's width with a flat list of its axes.

    Parameters
    ----------
    rows, columns : int
        Grid of axes.
    height : float
        Height of the figure [in].
    **options
        Passed to :meth:`matplotlib.figure.Figure.subplots`.
    """
    # Not pyplot's figure: nothing is registered globally, nothing has to be closed.
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, list(axes.ravel())


def draw_unstable(
    axes: Axes, speed: Any, value: Any, growth: Any, largest: float, colours: Colormap = GROWTH
) -> QuadMesh:
    """Colour the unstable cells of a map; stable ones stay empty.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    speed, value : array_like
        Columns and rows of the map, in the units of the axes.
    growth : array_like, shape (rows, columns)
        Growth rates [1/s].
    largest : float
        Growth rate of the darkest colour [1/s].
    colours : matplotlib.colors.Colormap, optional
    """
    return axes.pcolormesh(
        speed,
        value,
        np.ma.masked_less_equal(growth, 0.0),
        cmap=colours,
        norm=Normalize(0.0, largest),
        shading="nearest",
        rasterized=True,
    )


def draw_border(axes: Axes, speed: Any, value: Any, growth: Any) -> None:
    """Draw the line between stable and unstable cells, if there is one."""
    if (growth > 0).any() and (growth <= 0).any():
        axes.contour(speed, value, growth, levels=[0.0], colors=INK, linewidths=0.7)


def darkest(growth: Any) -> float:
    """Growth rate of the darkest colour: the largest, unless nine unstable cells in ten stay below a third of it.

    Parameters
    ----------
    growth : ndarray
        Growth rates of all cells on one scale [1/s].

    Examples
    --------
    >>> darkest(np.array([-1.0, 2.0, 5.0]))
    5.0
    """
    unstable = growth[growth > 0.0]
    if not unstable.size:
        return 1e-9
    largest, most = float(unstable.max()), float(np.quantile(unstable, 0.9))
    return most if 3.0 * most < largest else largest


def growth_bar(figure: Figure, axes: Sequence[Axes], drawn: Any, *, beyond: bool = False) -> None:
    """Put the scale of growth rates below the lowest map, as near whatever the height of the figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    axes : sequence of matplotlib.axes.Axes
        What it stands for.
    drawn : matplotlib.cm.ScalarMappable
        Whose colours it explains.
    beyond : bool
        Whether some cells grow faster than its end, which an arrow says.
    """
    height = figure.get_figheight()
    figure.colorbar(
        drawn,
        ax=list(axes),
        label="growth rate [1/s]",
        location="bottom",
        shrink=0.6,
        aspect=40,
        fraction=0.25 / height,
        pad=0.15 / height,
        extend="max" if beyond else "neither",
    )


def label_line(axes: Axes, text: str, xy: tuple[float, float], xytext: tuple[float, float]) -> None:
    """Name a feature beside it, with a thin leader, instead of in a legend."""
    axes.annotate(
        text,
        xy=xy,
        xytext=xytext,
        textcoords="offset points",
        arrowprops={"arrowstyle": "-", "color": GREY, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0},
        color=INK,
    )
