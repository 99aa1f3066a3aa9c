"""Arrays of chapter 3's figures, labelled, with units and the tolerances at which they are checked."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

from facegear.geometry import flanks
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.geometry.timed_pairs import PairStates
from facegear.support.labelled import variable
from facegear.support.parameters import integer_at_least
from facegear.support.types import FloatArray

# The geometry is exact to rounding; what a different machine or library changes stays well below these.
_length = partial(variable, units="m", atol=1e-11)
_angle = partial(variable, units="rad", atol=1e-10)


def describe(drive: Drive, **more: float) -> str:
    """Parameters of a figure as text, for its provenance."""
    values = {
        "pinion_teeth": drive.pinion_teeth,
        "gear_teeth": drive.gear_teeth,
        "module_mm": round(drive.module * 1e3, 9),
        "pressure_angle_deg": round(float(np.degrees(drive.pressure_angle)), 9),
        "shaft_angle_deg": round(float(np.degrees(drive.shaft_angle)), 9),
        **more,
    }
    return ", ".join(f"{name} = {value:.10g}" for name, value in values.items())


def tooth_and_contact_lines(drive: Drive, lines: int = 13, points: int = 33) -> xr.Dataset:
    """Compute the generated tooth with its contact lines and contact points (Figs 3.5, 3.8), in the gear's frame Γ2.

    Parameters
    ----------
    drive : Drive
    lines : int, optional
        Contact lines, equally spaced in rotation from first to last contact; those two have no length.
    points : int, optional
        Points on each line.

    Returns
    -------
    xarray.Dataset
        ``surface`` (flank, along, across, axis), ``line`` (fraction, point, axis), ``midpoint`` (fraction, axis) [m],
        ``length`` (fraction) [m], ``contact_radius`` (fraction) [m], ``contact_angle`` (fraction) [rad].
    """
    lines = integer_at_least("lines", lines, 3)
    fraction = np.linspace(0.0, 1.0, lines)
    rotation = drive.entry_rotation * (1.0 - fraction) + drive.exit_rotation * fraction
    contact = drive.contact_lines(rotation)
    region = drive.contact_region
    # A fixed point turned back with the gear is the point on its tooth: gear_to_fixed at the opposite rotation.
    midpoint = flanks.gear_to_fixed(region, contact.contact_point, -rotation)
    return xr.Dataset(
        {
            "surface": _length(
                ("flank", "along", "across", "axis"),
                np.stack([drive.tooth_flank(flank=side).points for side in (1, -1)]),
                "Points of both flanks",
            ),
            "line": _length(("fraction", "point", "axis"), contact.gear_points(points), "Contact lines"),
            "midpoint": _length(("fraction", "axis"), midpoint, "Contact points"),
            "length": _length("fraction", contact.length, "Length of the contact line"),
            "contact_radius": _length("fraction", contact.radius, "Radius of the contact point"),
            "contact_angle": _angle("fraction", contact.angle, "Angle of the contact point, fixed in space"),
        },
        coords={"fraction": fraction, "flank": [1, -1]},
        attrs={"parameters": describe(drive)},
    )


def _pairs(states: PairStates) -> dict[str, np.ndarray]:
    """Radius, angle and length with NaN where a pair is not in mesh."""
    return {
        name: np.where(states.in_contact, getattr(states, name), np.nan)
        for name in ("radius", "angle", "length")
    }


def contact_point_positions(
    drive: Drive, contact_ratio: float, pairs: int = 4, samples: int = 401
) -> xr.Dataset:
    """Positions of the contact points of successive tooth pairs against the rotation of the face gear (Fig. 3.9).

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        Mesh periods that a pair stays in mesh.
    pairs, samples : int, optional
        Tooth pairs that enter one after the other, and instants.

    Returns
    -------
    xarray.Dataset
        ``radius`` [m] and ``angle`` [rad] over (pair, time), NaN where a pair is not in mesh; ``time`` in mesh
        periods. The attribute ``instants`` holds the instants A (the second pair enters), B (the first leaves) and
        C (the third enters).
    """
    path = ContactPath(drive, contact_ratio)
    time = np.linspace(0.0, pairs - 1.0 + contact_ratio, samples)
    states = _pairs(path.overlaid(pairs, time * drive.angular_pitch))
    return xr.Dataset(
        {
            "radius": _length(("pair", "time"), states["radius"], "Radius of the contact point"),
            "angle": _angle(("pair", "time"), states["angle"], "Angle of the contact point"),
        },
        coords={"pair": np.arange(1, pairs + 1), "time": time},
        attrs={
            "parameters": describe(drive, contact_ratio=contact_ratio),
            "instants": np.array([1.0, contact_ratio, 2.0]),
        },
    )


def contact_centroid_instants(drive: Drive, contact_ratio: float, instants: Sequence[float]) -> xr.Dataset:
    """Contact lines, contact points and centroid on the gear plane at chosen instants (Figs 3.10, 3.11).

    Where they truly lie on the tooth: the travel about the gear's axis is not compressed with the contact ratio.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        Mesh periods that a pair stays in mesh.
    instants : sequence of float
        Times in mesh periods, each in [0, 1).

    Returns
    -------
    xarray.Dataset
        Over (instant, pair): ``line_across`` and ``line_radial`` (with ``point``), ``point_across``,
        ``point_radial``, ``length`` [m], NaN for a pair not in mesh; over instant: ``centroid_across``,
        ``centroid_radial`` [m].
    """
    time = np.asarray(instants, dtype=float)
    pairs = np.arange(int(np.ceil(contact_ratio)))
    fraction = (time[:, None] + pairs) / contact_ratio
    in_mesh = fraction <= 1.0
    contact = drive.contact_lines(
        drive.entry_rotation * (1.0 - fraction[in_mesh]) + drive.exit_rotation * fraction[in_mesh]
    )

    def spread(values: FloatArray) -> FloatArray:
        """Values of the pairs in mesh over (instant, pair), NaN elsewhere."""
        array = np.full((*fraction.shape, *values.shape[1:]), np.nan)
        array[in_mesh] = values
        return array

    lines, length = spread(contact.fixed_points()), spread(contact.length)
    radius, angle = spread(contact.radius), spread(contact.angle)
    weight = np.nan_to_num(length) / np.nansum(length, axis=1, keepdims=True)
    mean_radius, mean_angle = (np.sum(weight * np.nan_to_num(each), axis=1) for each in (radius, angle))
    both = ("instant", "pair")
    return xr.Dataset(
        {
            "line_across": _length((*both, "point"), lines[..., 0], "Contact line, across"),
            "line_radial": _length((*both, "point"), -lines[..., 1], "Contact line, radial"),
            "point_across": _length(both, np.sin(angle) * radius, "Contact point, across"),
            "point_radial": _length(both, np.cos(angle) * radius, "Contact point, radial"),
            "length": _length(both, length, "Length of the contact line"),
            "centroid_across": _length(
                "instant", np.sin(mean_angle) * mean_radius, "Contact centroid, across"
            ),
            "centroid_radial": _length(
                "instant", np.cos(mean_angle) * mean_radius, "Contact centroid, radial"
            ),
        },
        coords={"instant": time, "pair": pairs + 1},
        attrs={"parameters": describe(drive, contact_ratio=contact_ratio)},
    )


def contact_centroid_motion(drive: Drive, contact_ratio: float, samples: int = 401) -> xr.Dataset:
    """Contact points and contact centroid over two mesh periods (Fig. 3.12).

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        Mesh periods that a pair stays in mesh.
    samples : int, optional
        Instants.

    Returns
    -------
    xarray.Dataset
        ``radius`` [m], ``angle`` [rad] over (pair, time), NaN where not in mesh; ``centroid_radius``
        [m] and ``centroid_angle`` [rad] over ``time`` in mesh periods.
    """
    path = ContactPath(drive, contact_ratio)
    time = np.linspace(0.0, 2.0, samples)
    # Pairs that entered before the first instant are shown too.
    count = path.pairs + 1
    states = _pairs(path.overlaid(count + 1, (time + path.pairs - 1) * drive.angular_pitch))
    centroid = path.centroid(time)
    return xr.Dataset(
        {
            "radius": _length(("pair", "time"), states["radius"], "Radius of the contact point"),
            "angle": _angle(("pair", "time"), states["angle"], "Angle of the contact point"),
            "centroid_radius": _length("time", centroid.radius, "Radius of the contact centroid"),
            "centroid_angle": _angle("time", centroid.angle, "Angle of the contact centroid"),
        },
        coords={"pair": np.arange(count + 1), "time": time},
        attrs={"parameters": describe(drive, contact_ratio=contact_ratio)},
    )


def mesh_length(drive: Drive, contact_ratio: float, samples: int = 201) -> xr.Dataset:
    """Total length of the contact lines of all pairs in mesh over one mesh period.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        Mesh periods that a pair stays in mesh.
    samples : int, optional
        Instants.

    Returns
    -------
    xarray.Dataset
        ``total_length`` [m] over ``time`` in mesh periods.
    """
    time = np.linspace(0.0, 1.0, samples)
    total = ContactPath(drive, contact_ratio).pair_states(time).length.sum(axis=0)
    return xr.Dataset(
        {"total_length": _length("time", total, "Total length of the contact lines")},
        coords={"time": time},
        attrs={"parameters": describe(drive, contact_ratio=contact_ratio)},
    )


def skew_lines(drive: Drive, contact_ratio: float, pairs: int = 3, samples: int = 401) -> xr.Dataset:
    """Skew line (3-22) beside the true radius of the contact points (Fig. 3.13).

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        Mesh periods that a pair stays in mesh.
    pairs, samples : int, optional
        Tooth pairs that enter one after the other, and instants.

    Returns
    -------
    xarray.Dataset
        ``radius`` and ``skew_radius`` [m] over (pair, time), NaN where a pair is not in mesh.
    """
    time = np.linspace(0.0, pairs - 1.0 + contact_ratio, samples)
    true = _pairs(ContactPath(drive, contact_ratio).overlaid(pairs, time * drive.angular_pitch))
    age = time - np.arange(pairs)[:, None]
    line = SkewLine(drive, contact_ratio)
    in_mesh = (age >= 0.0) & (age <= contact_ratio)
    whole = np.clip(np.floor(age), 0, line.pairs - 1).astype(int)
    skew = np.take_along_axis(line.pair_states(age).radius, whole[None], axis=0)[0]
    return xr.Dataset(
        {
            "radius": _length(("pair", "time"), true["radius"], "Radius of the contact point"),
            "skew_radius": _length(
                ("pair", "time"), np.where(in_mesh, skew, np.nan), "Radius on the skew line (3-22)"
            ),
        },
        coords={"pair": np.arange(1, pairs + 1), "time": time},
        attrs={"parameters": describe(drive, contact_ratio=contact_ratio)},
    )
