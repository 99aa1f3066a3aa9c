"""What a report shows over speed, as labelled arrays with units and tolerances; nothing is drawn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.drives.basis import unstable_share
from facegear.drives.drive_file import DriveFile
from facegear.drives.verdict import Case
from facegear.floquet.modal import modal_expansion
from facegear.floquet.models import Model, parameter_path
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import Tongue
from facegear.support.labelled import text, variable
from facegear.support.parameters import rad_per_s, rpm
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)
_speed = partial(variable, units="rpm", rtol=1e-7, atol=1e-4)
# A maximum is known to the square root of the accuracy of the values around it.
_peak = partial(variable, units="rpm", atol=0.1)


def describe(file: DriveFile) -> str:
    """Parameters of a drive file as text, for the provenance of arrays."""
    # The contact ratio in use besides the field: None there is that of the drive.
    ratio = file.transverse.gear.contact_ratio
    name = file.name.replace("\0", "\ufffd")  # netCDF takes any other character
    return f"{name}: {file.transverse}, {file.torsional}, contact_ratio = {ratio:.10g}"


def tongue_table(found: Sequence[Tongue], parameters: str) -> xr.Dataset:
    """Tongues of a model.

    Parameters
    ----------
    found : sequence of Tongue
        From :func:`facegear.maps.tracing.tongues`.
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        Over ``tongue``: ``lower``, ``upper``, ``peak`` [rpm], ``largest_growth`` [1/s]. Labels in the coordinate
        ``label``.
    """

    def column(name: str) -> FloatArray:
        return np.array([getattr(tongue, name) for tongue in found], dtype=float)

    return xr.Dataset(
        {
            "lower": _speed("tongue", rpm(column("lower")), "Lower border"),
            "upper": _speed("tongue", rpm(column("upper")), "Upper border"),
            "peak": _peak("tongue", rpm(column("peak")), "Speed of the largest growth"),
            "largest_growth": _growth("tongue", column("growth_rate"), "Largest growth rate of the tongue"),
        },
        coords={
            "tongue": np.arange(len(found)),
            "label": text("tongue", [tongue.label for tongue in found], "Label of the tongue"),
        },
        attrs={"parameters": parameters},
    )


def safe_windows(table: xr.Dataset, speeds: tuple[float, float]) -> xr.Dataset:
    """Intervals of speed between the tongues.

    Parameters
    ----------
    table : xarray.Dataset
        From :func:`tongue_table`.
    speeds : tuple of float
        Lowest and highest speed that the tongues were looked for in [rad/s].

    Returns
    -------
    xarray.Dataset
        Over ``window``, ascending: ``lower``, ``upper`` [rpm].
    """
    low, high = rpm(speeds[0]), rpm(speeds[1])
    starts = np.concatenate([[low], table["upper"].values])
    stops = np.concatenate([table["lower"].values, [high]])
    wide = stops - starts > 1e-9 * high
    return xr.Dataset(
        {
            "lower": _speed("window", starts[wide], "Lower end of the window"),
            "upper": _speed("window", stops[wide], "Upper end of the window"),
        },
        coords={"window": np.arange(int(wide.sum()))},
        attrs={"parameters": table.attrs["parameters"]},
    )


def combinations(model: Model, found: Sequence[Tongue], speeds_rpm: ArrayLike, parameters: str) -> xr.Dataset:
    """Mesh frequency against natural frequencies of the mean system and their combinations.

    Parameters
    ----------
    model : Model
    found : sequence of Tongue
        Tongues of the model; their combinations are followed over speed.
    speeds_rpm : array_like, shape (S,)
        Speeds of the face gear [rpm].
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        ``mesh_frequency`` (speed_rpm), ``natural_frequency`` (mode, speed_rpm), ``combination`` (label, speed_rpm)
        [Hz]: (ω_k ± ω_j)/(2πs), NaN where a mode does not oscillate; ``label`` is text.
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    systems = [model.system(float(speed)) for speed in rad_per_s(speeds)]
    means = [modal_expansion(system, 1).frequencies / (2 * math.pi) for system in systems]
    natural = np.full((max(mean.size for mean in means), speeds.size), np.nan)
    for i, mean in enumerate(means):
        natural[: mean.size, i] = mean
    kinds = {tongue.label: tongue.combination for tongue in found if tongue.combination.order > 0}
    combined = [
        (natural[c.j - 1] + (1 if c.kind == "sum" else -1) * natural[c.k - 1]) / c.order
        for c in kinds.values()
    ]
    frequency = partial(variable, units="Hz", rtol=1e-8, atol=1e-6)
    return xr.Dataset(
        {
            "mesh_frequency": frequency("speed_rpm", [1 / s.period for s in systems], "Mesh frequency"),
            "natural_frequency": frequency(
                ("mode", "speed_rpm"), natural, "Natural frequency of the mean system"
            ),
            "combination": frequency(
                ("label", "speed_rpm"),
                np.reshape(combined, (len(combined), speeds.size)),
                "Combination of natural frequencies over its order",
            ),
        },
        coords={
            "speed_rpm": speeds,
            "mode": np.arange(1, len(natural) + 1),
            "label": text("label", list(kinds), "Label of the combination"),
        },
        attrs={"parameters": parameters},
    )


def growth_map(
    model: Model, parameter: str, values: ArrayLike, speeds_rpm: ArrayLike, parameters: str, *, jobs: int = 1
) -> xr.Dataset:
    """Growth rates over speed and one parameter.

    Parameters
    ----------
    model : Model
    parameter : str
        As for :func:`facegear.maps.stability_map.stability_map`.
    values : array_like, shape (V,)
        Its values, in SI.
    speeds_rpm : array_like, shape (S,)
        Speeds of the face gear [rpm].
    parameters : str
        For the provenance.
    jobs : int
        Number of workers.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (parameter, speed_rpm) [1/s], unstable where positive.
    """
    speeds = np.asarray(speeds_rpm, dtype=float)
    chart = stability_map(model, rad_per_s(speeds), parameter, values, jobs=jobs, progress=False)
    name = parameter_path(model, parameter)[-1]
    return xr.Dataset(
        {"growth_rate": _growth((name, "speed_rpm"), chart.values, "Growth rate ln(max|λ|)/T0")},
        coords={name: np.asarray(values, dtype=float), "speed_rpm": speeds},
        attrs={"parameters": f"{parameters}, swept = {parameter}"},
    )


def basis_table(computed: Sequence[Case], parameters: str) -> xr.Dataset:
    """How the unstable part of the speeds moves from basis to basis.

    Parameters
    ----------
    computed : sequence of Case
    parameters : str
        For the provenance.

    Returns
    -------
    xarray.Dataset
        Over ``basis``: ``nodal_circles``, ``nodal_diameters``, ``unstable_share``, ``moved`` [-], NaN for the first
        basis of a case; name of the case in the coordinate ``case_name``.
    """
    rows = [(case, step) for case in computed for step in case.found.steps]
    share = partial(variable, "basis", units="1", rtol=1e-6, atol=1e-6)
    return xr.Dataset(
        {
            "nodal_circles": variable("basis", [s.nodal_circles for _, s in rows], "Nodal circles M", "1"),
            "nodal_diameters": variable(
                "basis", [s.nodal_diameters for _, s in rows], "Nodal diameters N", "1"
            ),
            "unstable_share": share(
                [unstable_share(s.tongues, case.found.speeds) for case, s in rows],
                "Unstable part of the speeds",
            ),
            "moved": share(
                [s.moved for _, s in rows], "Part in which this basis and the one before disagree"
            ),
        },
        coords={
            "basis": np.arange(len(rows)),
            "case_name": text("basis", [case.name for case, _ in rows], "Name of the case"),
        },
        attrs={"parameters": parameters},
    )
