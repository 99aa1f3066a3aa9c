"""Arrays of chapter 6's figures of the stress under a force at the rim, with units and tolerances."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from facegear.mechanics.inplane import EdgeLoadStress, harmonic_field, spin_per_speed
from facegear.mechanics.plate import Body
from facegear.support.labelled import variable
from facegear.support.parameters import finite_array, rad_per_s
from facegear.symbolic.lame import bessel_stresses
from facegear.symbolic.michell import michell_stresses

_STRESSES = {"radial": "σ_rr", "shear": "σ_rθ", "hoop": "σ_θθ"}


def described(body: Body, **values: float) -> str:
    """Parameters as text, for the provenance of a figure."""
    given = {
        "pinion_teeth": body.drive.pinion_teeth,
        "gear_teeth": body.drive.gear_teeth,
        "thickness_ratio": body.thickness_ratio,
        "bore_radius_mm": round(body.bore_radius * 1e3, 9),
    }
    return ", ".join(f"{name} = {value:.10g}" for name, value in (given | values).items())


def harmonic_stresses(stress: EdgeLoadStress, samples: int = 61) -> xr.Dataset:
    """Amplitudes of every harmonic of the plane stress against the radius (Figs 6.3 to 6.5).

    Parameters
    ----------
    stress : EdgeLoadStress
    samples : int, optional
        Radii from bore to rim.

    Returns
    -------
    xarray.Dataset
        ``radial``, ``shear``, ``hoop`` (harmonic, radius) [Pa], factors of sin kθ, cos kθ, sin kθ (6-22).
    """
    body = stress.body
    radius = np.linspace(body.bore_radius, body.outer_radius, samples)
    numbers = np.arange(stress.harmonics + 1)
    scale = stress.edge_stress(1)
    tables = {
        name: variable(
            ("harmonic", "radius"),
            np.stack([getattr(stress, name)(int(k), radius) for k in numbers]),
            f"Amplitude of {symbol}",
            "Pa",
            atol=1e-10 * abs(scale),
        )
        for name, symbol in _STRESSES.items()
    }
    parameters = described(body, force=stress.force, speed=stress.speed)
    return xr.Dataset(
        tables, coords={"harmonic": numbers, "radius": radius}, attrs={"parameters": parameters}
    )


def summed_stress(loads: Sequence[EdgeLoadStress], radii: int = 41, angles: int = 181) -> xr.Dataset:
    """Plane stress of several forces together, all their harmonics summed.

    Parameters
    ----------
    loads : sequence of EdgeLoadStress
        On one body.
    radii, angles : int, optional
        Points between bore and rim, and round the disk.

    Returns
    -------
    xarray.Dataset
        ``radial``, ``shear``, ``hoop`` (radius, angle) [Pa].

    Raises
    ------
    ValueError
        If there is no load or the loads are on different bodies.
    """
    if not loads or any(load.body != loads[0].body for load in loads):
        raise ValueError(f"loads must be at least one field, all on one body, got {loads!r}")
    body = loads[0].body
    radius = np.linspace(body.bore_radius, body.outer_radius, radii)
    angle = np.linspace(0.0, 2 * np.pi, angles)
    fields = [load.field(radius[:, np.newaxis], angle) for load in loads]
    scale = max(abs(load.edge_stress(1)) for load in loads)
    tables = {
        name: variable(
            ("radius", "angle"),
            np.sum([field[i] for field in fields], axis=0),
            symbol,
            "Pa",
            atol=1e-9 * scale,
        )
        for i, (name, symbol) in enumerate(_STRESSES.items())
    }
    told = "; ".join(
        f"{load.direction} {load.force:.10g} N at {load.angle:.10g}, {load.harmonics} harmonics"
        for load in loads
    )
    return xr.Dataset(
        tables,
        coords={"radius": radius, "angle": angle},
        attrs={"parameters": f"{described(body, speed=loads[0].speed)}, loads = {told}"},
    )


def near_load(body: Body, harmonics: Sequence[int], distances: ArrayLike, inward: float) -> xr.Dataset:
    """Stress towards the point of the load against Flamant's half-plane, along a straight line from it.

    A half-plane under a force along its edge is stressed towards the force's point only, by -2F cos γ/(πhd) at the
    distance d in the direction γ from the force.

    Parameters
    ----------
    body : Body
        The disk, at rest.
    harmonics : sequence of int
        Numbers of harmonics to sum.
    distances : array_like, shape (D,)
        d over the outer radius [-].
    inward : float
        γ, angle of the line from the tangent at the load, into the disk [rad].

    Returns
    -------
    xarray.Dataset
        ``ratio`` (harmonics, distance), the disk's stress over the half-plane's [-].
    """
    d = finite_array("distances", distances)
    # In units of the outer radius, load at (1, 0) along y.
    x, y = 1 - d * math.sin(inward), d * math.cos(inward)
    radius, theta = np.hypot(x, y), np.arctan2(y, x)
    # Components of the line's direction along r and θ
    along_r = -math.sin(inward) * np.cos(theta) + math.cos(inward) * np.sin(theta)
    along_theta = math.sin(inward) * np.sin(theta) + math.cos(inward) * np.cos(theta)
    half_plane = -2 * math.cos(inward) / (math.pi * body.thickness * body.outer_radius * d)
    rows = []
    for count in harmonics:
        stress = EdgeLoadStress(body, 1.0, harmonics=count)
        radial, shear, hoop = stress.field(radius * body.outer_radius, theta)
        towards = radial * along_r**2 + 2 * shear * along_r * along_theta + hoop * along_theta**2
        rows.append(towards / half_plane)
    return xr.Dataset(
        {
            "ratio": variable(
                ("harmonics", "distance"), rows, "Stress over that of a half-plane", "1", atol=1e-8
            )
        },
        coords={"harmonics": list(harmonics), "distance": d},
        attrs={"parameters": f"{described(body)}, inward = {inward:.10g}"},
    )


def equilibrium(body: Body, speed: float, samples: int = 41) -> tuple[float, float]:
    """Largest error of the moment of k = 0 and of the force of k = 1 through any circle of the disk.

    Parameters
    ----------
    body : Body
    speed : float
        Ω2 [rad/s].
    samples : int, optional
        Radii of the circles.

    Returns
    -------
    moment, force : float
        Over F_t a and F_t [-]. Moment through a circle, plus the moment of inertia forces outside it by quadrature,
        must be F_t a. The inertia forces of k = 1 have no resultant, so that the force through a circle must be F_t.
    """
    stress = EdgeLoadStress(body, 1.0, speed)
    x = np.linspace(body.bore_ratio, 1.0, samples)
    mean, first = stress.harmonic(0), stress.harmonic(1)
    points, weights = np.polynomial.legendre.leggauss(40)
    # ∫ Ω*² x² V dx from each radius to the rim
    half = (1.0 - x) / 2
    nodes = x[:, np.newaxis] + half[:, np.newaxis] * (points + 1.0)
    spin = speed * spin_per_speed(body)
    inertia = spin**2 * half * ((nodes**2 * mean.unknowns(nodes)[1, 0]) @ weights)
    moment = x * mean.unknowns(x)[3, 0] - inertia
    force = first.unknowns(x)[2:, 0].sum(axis=0)
    return float(np.abs(moment - 1.0).max()), float(np.abs(force - 1.0).max())


def closed_forms(body: Body, harmonics: Sequence[int], speeds_rpm: ArrayLike, digits: int = 15) -> xr.Dataset:
    """Errors of Lamé's potentials in few digits and of collocation, against the potentials in 40 digits.

    Parameters
    ----------
    body : Body
    harmonics : sequence of int
        k.
    speeds_rpm : array_like
        Speeds of the face gear [rpm], above 0.
    digits : int, optional
        Digits of the arithmetic; 15 is double precision.

    Returns
    -------
    xarray.Dataset
        ``potentials`` and ``collocation`` (harmonic, speed_rpm): largest error of the three stresses over the disk,
        over the stress at the rim [-]; NaN where the digits do not suffice to solve for the constants at all.
        ``michell`` (harmonic), collocation at rest against Michell's solution, and ``speed_effect`` (harmonic,
        speed_rpm), largest change of a stress from rest.
    """
    c, nu = body.bore_ratio, body.material.poissons_ratio
    x = np.linspace(c, 1.0, 6)
    speeds = finite_array("speeds_rpm", speeds_rpm, "rpm")
    shape = (len(harmonics), speeds.size)
    potentials, collocation, effect = np.full(shape, np.nan), np.empty(shape), np.empty(shape)
    michell = np.empty(len(harmonics))
    for i, k in enumerate(harmonics):
        rest = harmonic_field(c, nu, 0.0, k).stresses(x)[:, 0]
        michell[i] = np.abs(rest - michell_stresses(k, x.tolist(), nu, c)).max()
        for j, speed in enumerate(speeds):
            spin = float(rad_per_s(speed)) * spin_per_speed(body)
            exact = np.array(bessel_stresses(k, x.tolist(), spin, nu, c, digits=40))
            found = harmonic_field(c, nu, spin, k).stresses(x)[:, 0]
            collocation[i, j] = np.abs(found - exact).max()
            effect[i, j] = np.abs(found - rest).max()
            try:
                few = np.array(bessel_stresses(k, x.tolist(), spin, nu, c, digits=digits))
            except ZeroDivisionError:
                continue
            potentials[i, j] = np.abs(few - exact).max()
    both = ("harmonic", "speed_rpm")
    return xr.Dataset(
        {
            "potentials": variable(
                both, potentials, f"Error of Lamé's potentials in {digits} digits", "1", 0.5, 1e-12
            ),
            "collocation": variable(both, collocation, "Error of collocation", "1", atol=1e-11),
            "michell": variable(
                "harmonic", michell, "Collocation minus Michell's solution, at rest", "1", atol=1e-11
            ),
            "speed_effect": variable(both, effect, "Change from rest", "1", rtol=1e-6, atol=1e-11),
        },
        coords={"harmonic": list(harmonics), "speed_rpm": speeds},
        attrs={"parameters": f"{described(body)}, digits = {digits}"},
    )
