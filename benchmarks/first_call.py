"""Time `facegear.stability_map` in a process that has not computed anything yet; prints one line of JSON.

Run from the repository root: ``python -m benchmarks.first_call SIZE WORKERS``. Fig. 4.4(a), one pinion, with all that a
user of a new drive pays for: imports, radial modes, the path of contact.
"""

import json
import resource
import sys
import time


def processor_seconds() -> float:
    """Processor time of this process and its children."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(part.ru_utime + part.ru_stime for part in used)


def main() -> None:
    size, workers = map(int, sys.argv[1:])
    marks = [(time.perf_counter(), processor_seconds())]

    import numpy as np
    import xarray

    import facegear as fg

    # xarray imports Dask, where that is installed, with its first array.
    xarray.DataArray(0.0)

    drive = fg.Drive(26, 130, 3.175e-3)
    pinion = fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0)
    model = fg.Transverse(fg.Body(drive, thickness_ratio=0.03), pinion)
    stability_map = fg.stability_map
    speeds, values = fg.rad_per_s(np.linspace(10.0, 1000.0, size)), np.linspace(2.0 / size, 2.0, size)
    marks.append((time.perf_counter(), processor_seconds()))
    for _ in range(2):
        chart = stability_map(model, speeds, "stiffness", values, jobs=workers, progress=False)
        marks.append((time.perf_counter(), processor_seconds()))
    names = ("imports", "first call", "second call")
    spans = {
        name: {"seconds": after[0] - before[0], "processor_seconds": after[1] - before[1]}
        for name, before, after in zip(names, marks[:-1], marks[1:], strict=True)
    }
    print(json.dumps(spans | {"error_estimate": chart.attrs["error_estimate"]}))


if __name__ == "__main__":
    main()
