"""Arrays of the driving force spread over teeth: what it makes of K_f, of critical powers and of maps over power."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from compendium.datasets.inplane import described
from compendium.datasets.power import driving_force_of
from facegear.design.envelope import critical_power, mode_critical_powers
from facegear.floquet.modes import natural_exponents
from facegear.floquet.stepping import aligned_edges, exponentials
from facegear.geometry.drive import Drive
from facegear.maps.stability_map import stability_map
from facegear.mechanics.disk import disk_matrices
from facegear.mechanics.edge_stiffness import DrivingForce, Following
from facegear.mechanics.plate import Body
from facegear.mechanics.pressed_points import Spread
from facegear.mechanics.pressed_stiffness import pressed_stiffness
from facegear.mechanics.spreads import RIM_POINT, ContactPointsAt, ToothPatches
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import text, variable
from facegear.support.parameters import finite_array, rad_per_s
from facegear.support.types import FloatArray

Spreads = Callable[[Drive], Mapping[str, Spread]]
"""The spreads to be compared, by their names, of a drive."""

_critical = partial(variable, units="W", rtol=1e-8)
_growth = partial(variable, units="1/s", rtol=1e-6, atol=1e-3)
# Powers, over that at which a following force makes a mode flutter, between which a change of stability is looked for.
_FIRST, _RATIO, _LAST = 0.5, 1.15, 200.0


def stiffness_changes(
    bodies: Mapping[str, Body], spreads: Spreads, pinion_speed: float, speed: float, *, harmonics: int = 5
) -> xr.Dataset:
    """Compare what spreads of a force make of K_f and of the critical power of the disk alone.

    Parameters
    ----------
    bodies : mapping of str to Body
        Of one number of coordinates.
    spreads : callable
        Spreads by their names, of a drive.
    pinion_speed : float
        Ω1 at the powers [rad/s].
    speed : float
        Ω2 [rad/s].
    harmonics : int, optional
        Largest harmonic of the force.

    Returns
    -------
    xarray.Dataset
        Over (body, spread): ``dead`` and ``following``, norms of both parts of K_f over those of a force at the rim
        [-]; ``change``, norm of the difference of K_f of a following force from that at the rim, over its own [-];
        ``critical`` and ``dead_critical`` [W], of a following and of a dead force; ``first_order`` (body, spread,
        diameters) [W], of the modes without nodal circles under a following force.
    """
    rows = []
    for body in bodies.values():
        rim = pressed_stiffness(body, speed, harmonics, (0.0,), RIM_POINT)
        row = []
        for spread in spreads(body.drive).values():
            own = pressed_stiffness(body, speed, harmonics, (0.0,), spread)
            sizes = [np.linalg.norm(part) / np.linalg.norm(at) for part, at in zip(own, rim, strict=True)]
            away = np.linalg.norm(sum(own) - sum(rim)) / np.linalg.norm(sum(rim))
            powers = [
                critical_power(
                    body, pinion_speed, speed, following=following, harmonics=harmonics, spread=spread
                )
                for following in ("follower", "dead")
            ]
            modes = mode_critical_powers(body, pinion_speed, spread)[0, 1:]
            row.append([*sizes, away, *powers, *modes])
        rows.append(row)
    table = np.asarray(rows, dtype=float)
    names = list(spreads(next(iter(bodies.values())).drive))
    both = ("body", "spread")
    relative = partial(variable, both, units="1", atol=1e-9)
    return xr.Dataset(
        {
            "dead": relative(table[..., 0], "Norm of K_f of a dead force over that at the rim"),
            "following": relative(table[..., 1], "Norm of what following adds over that at the rim"),
            "change": relative(table[..., 2], "Norm of the change of K_f over that of K_f at the rim"),
            "critical": _critical(both, table[..., 3], "Critical power of a following force"),
            "dead_critical": _critical(both, table[..., 4], "Critical power of a dead force"),
            "first_order": _critical(
                (*both, "diameters"), table[..., 5:], "Critical power of the modes, first order"
            ),
        },
        coords={
            "body": np.arange(len(bodies)),
            "body_name": text("body", list(bodies), "Body"),
            "spread": np.arange(len(names)),
            "spread_name": text("spread", names, "Where the force presses"),
            "diameters": np.arange(1, table.shape[-1] - 4),
        },
        attrs={
            "parameters": "; ".join(described(body) for body in bodies.values())
            + f"; power_speed = {pinion_speed:.10g}, speed = {speed:.10g}, harmonics = {harmonics}"
        },
    )


def tilt_along_face(bodies: Mapping[str, Body], samples: int = 61) -> xr.Dataset:
    """Work of a following force on a mode by its radius: (R/r)² over that at the rim, for one moment.

    Parameters
    ----------
    bodies : mapping of str to Body
        Of one largest number of nodal diameters.
    samples : int, optional
        Radii from bore to rim.

    Returns
    -------
    xarray.Dataset
        ``tilt`` (body, diameters, place) [-] of the modes without nodal circles; r over the outer radius in ``radius``
        (body, place) and that of the teeth's inner end in ``face`` (body).
    """
    radii = [np.linspace(body.bore_ratio, 1.0, samples) for body in bodies.values()]
    tilt = [
        [(modes(x)[0] / modes(1.0)[0] / x) ** 2 for modes in body.modes[1:]]
        for body, x in zip(bodies.values(), radii, strict=True)
    ]
    relative = partial(variable, units="1", atol=1e-10)
    return xr.Dataset(
        {
            "tilt": relative(("body", "diameters", "place"), tilt, "Square of R/r over that at the rim"),
            "radius": relative(("body", "place"), radii, "Radius over outer radius"),
            "face": relative(
                "body",
                [body.drive.inner_radius / body.outer_radius for body in bodies.values()],
                "Inner end of the teeth over outer radius",
            ),
        },
        coords={
            "body": np.arange(len(bodies)),
            "body_name": text("body", list(bodies), "Body"),
            "diameters": np.arange(1, len(tilt[0]) + 1),
            "place": np.arange(samples),
        },
        attrs={"parameters": "; ".join(described(body) for body in bodies.values())},
    )


def partly_following(
    bodies: Mapping[str, Body],
    spreads: Spreads,
    pinion_speed: float,
    speed: float,
    parts: Sequence[float],
    *,
    harmonics: int = 5,
) -> xr.Dataset:
    """Critical power of the disk alone against the part of the force's tilt that follows the slope.

    Parameters
    ----------
    bodies, spreads, pinion_speed, speed, harmonics
        As for :func:`stiffness_changes`.
    parts : sequence of float
        χ from 0, dead, to 1, following: the force tilts by χ times the slope.

    Returns
    -------
    xarray.Dataset
        ``critical`` (body, spread, part) [W]; infinite without nodal diameters, and where none is found up to
        200 times the power at which a following force makes a mode flutter.
    """
    table = [
        [
            [_critical_of_part(body, spread, pinion_speed, speed, part, harmonics) for part in parts]
            for spread in spreads(body.drive).values()
        ]
        for body in bodies.values()
    ]
    names = list(spreads(next(iter(bodies.values())).drive))
    return xr.Dataset(
        {"critical": _critical(("body", "spread", "part"), table, "Critical power")},
        coords={
            "body": np.arange(len(bodies)),
            "body_name": text("body", list(bodies), "Body"),
            "spread": np.arange(len(names)),
            "spread_name": text("spread", names, "Where the force presses"),
            "part": np.asarray(parts, dtype=float),
        },
        attrs={
            "parameters": "; ".join(described(body) for body in bodies.values())
            + f"; power_speed = {pinion_speed:.10g}, speed = {speed:.10g}, harmonics = {harmonics}"
        },
    )


def _critical_of_part(
    body: Body, spread: Spread, pinion_speed: float, speed: float, part: float, harmonics: int
) -> float:
    """Smallest power at which the disk alone is unstable under a force that follows in part [W]."""
    damping, stiffness = disk_matrices(body, speed)
    dead, following = pressed_stiffness(body, speed, harmonics, (0.0,), spread)
    unit = float(mode_critical_powers(body, pinion_speed, spread).min())
    if unit == math.inf:
        return math.inf
    loaded = DrivingForce(unit, pinion_speed).newtons(body.drive) * (dead + part * following)

    def growth(share: float) -> float:
        return float(natural_exponents(np.eye(len(loaded)), damping, stiffness + share * loaded).real.max())

    low, high = 0.0, _FIRST
    while growth(high) <= 0.0:
        if high > _LAST:
            return math.inf
        low, high = high, high * _RATIO
    return unit * float(brentq(growth, low, high, xtol=1e-12, rtol=1e-12))


def power_maps(
    model: Transverse,
    spreads: Mapping[str, Spread],
    powers: Sequence[float],
    speeds_rpm: ArrayLike,
    values: ArrayLike,
    *,
    jobs: int = -1,
) -> xr.Dataset:
    """Compute maps over speed and bearing stiffness at several powers, for spreads of the force (Figs 6.6, 6.7).

    Parameters
    ----------
    model : Transverse
        With a driving force.
    spreads : mapping of str to Spread
    powers : sequence of float
        [W].
    speeds_rpm, values : array_like
        Speeds of the face gear [rpm] and bearing stiffnesses μ.
    jobs : int, optional
        Number of workers.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` and ``dead`` (spread, power, stiffness, speed_rpm) [1/s], under a following and a dead force.
    """
    force = driving_force_of(model)
    shown, heights = finite_array("speeds_rpm", speeds_rpm, "rpm"), finite_array("values", values)

    def charts(following: Following) -> list[list[FloatArray]]:
        return [
            [
                stability_map(
                    replace(model, force=replace(force, power=power, following=following, spread=spread)),
                    np.asarray(rad_per_s(shown)),
                    "stiffness",
                    heights,
                    jobs=jobs,
                ).values
                for power in powers
            ]
            for spread in spreads.values()
        ]

    axes = ("spread", "power", "stiffness", "speed_rpm")
    return xr.Dataset(
        {
            "growth_rate": _growth(axes, charts("follower"), "Growth rate, following force"),
            "dead": _growth(axes, charts("dead"), "Growth rate, dead force"),
        },
        coords={
            "spread": np.arange(len(spreads)),
            "spread_name": text("spread", list(spreads), "Where the force presses"),
            "power": np.asarray(powers, dtype=float),
            "stiffness": heights,
            "speed_rpm": shown,
        },
        attrs={
            "parameters": described(model.body, power_speed=force.pinion_speed, harmonics=force.harmonics)
        },
    )


def within_the_period(
    model: Transverse, tooth: Spread, speeds_rpm: ArrayLike, *, sub_intervals: int = 48
) -> xr.Dataset:
    """Compute what the mean over a mesh period leaves out: K_f at each instant, and growth rates with it.

    The stress is taken to follow the force at once. Transition matrices are products of Magnus steps of fourth order
    between the instants at which the system is not smooth, once with K_f of each instant and once with its mean.

    Parameters
    ----------
    model : Transverse
        With one pinion and a driving force, whose own spread does not matter; its contact says where the pairs are, if
        it tells them apart.
    tooth : Spread
        What each tooth presses.
    speeds_rpm : array_like, shape (S,)
        Speeds of the face gear [rpm].
    sub_intervals : int, optional
        Of the mesh period.

    Returns
    -------
    xarray.Dataset
        ``departure`` (instant), norm of K_f at an instant less its mean, over that of the mean [-], at t/T0 in
        ``instant``; ``moving`` and ``mean`` (speed_rpm) [1/s], growth rates with K_f of each instant and with its mean.
    """
    force, body = driving_force_of(model), model.body
    pairs = replace(model.contact, sharing="each")
    shown = finite_array("speeds_rpm", speeds_rpm, "rpm")
    edges = aligned_edges(model.system(float(rad_per_s(500.0))).breakpoints, sub_intervals)
    length = np.diff(edges)
    # Both Gauss nodes of each sub-interval
    nodes = edges[:-1, np.newaxis] + length[:, np.newaxis] * (0.5 + np.array([-1.0, 1.0]) / math.sqrt(12.0))

    def at(fraction: float) -> FloatArray:
        spread = ToothPatches(ContactPointsAt(pairs, fraction), tooth)
        # Speed changes K_f by a ten-thousandth (chapter 6): one serves all.
        dead, following = pressed_stiffness(body, 0.0, force.harmonics, (0.0,), spread)
        return force.newtons(body.drive) * (dead + following)

    moving = np.stack([at(fraction) for fraction in nodes.ravel().tolist()])
    mean = np.tensordot(np.repeat(length / 2, 2), moving, axes=1)
    departure = np.linalg.norm(moving - mean, axis=(1, 2)) / np.linalg.norm(mean)
    rows = [
        [_growth_with(model, speed, nodes, length, stiffness) for speed in rad_per_s(shown).tolist()]
        for stiffness in (moving, np.broadcast_to(mean, moving.shape))
    ]
    return xr.Dataset(
        {
            "departure": variable(
                "instant", departure, "Departure of K_f from its mean", "1", rtol=1e-6, atol=1e-9
            ),
            "moving": _growth("speed_rpm", rows[0], "Growth rate with K_f of each instant"),
            "mean": _growth("speed_rpm", rows[1], "Growth rate with the mean of K_f"),
        },
        coords={"instant": nodes.ravel(), "speed_rpm": shown},
        attrs={"parameters": described(body, power=force.power, power_speed=force.pinion_speed)},
    )


def _growth_with(
    model: Transverse, speed: float, nodes: FloatArray, length: FloatArray, stiffness: FloatArray
) -> float:
    """Growth rate of a model with K_f given at the nodes (m, 2) of sub-intervals, (2 m, n, n) [1/s]."""
    system = replace(model, force=None).system(speed)
    n = system.size
    state = system.state_matrix(nodes.ravel())
    state[:, n:, :n] -= np.linalg.solve(system.mass_matrix(nodes.ravel()), stiffness)
    h = (length * system.period)[:, np.newaxis, np.newaxis]
    first, second = h * state[0::2], h * state[1::2]
    commutator = first @ second - second @ first
    transition = np.eye(2 * n)
    for step in exponentials((first + second) / 2.0 - commutator * math.sqrt(3.0) / 12.0):
        transition = step @ transition
    return float(np.log(np.abs(np.linalg.eigvals(transition)).max()) / system.period)
