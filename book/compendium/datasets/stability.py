"""Arrays of chapter 2's figures, labelled, with units and the tolerances at which they are checked.

Charts hold growth rates, not black and white. At the border of a tongue of an undamped system two multipliers meet
and the growth rate starts like a square root, so that rounding of 1e-15 in the transition matrix may show as 1e-7.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq

from facegear.floquet import methods
from facegear.floquet import multipliers as floquet
from facegear.floquet.columns import family_spectral_radii
from facegear.floquet.hsu import ResonanceBand, resonance_bands
from facegear.floquet.models import Model, replace_parameter
from facegear.floquet.periodic import PeriodicSystem
from facegear.maps.stability_map import stability_map
from facegear.mechanics import classical
from facegear.support.labelled import text, variable
from facegear.support.parameters import finite_array, integer_at_least
from facegear.support.types import FloatArray

_growth = partial(variable, units="1/s", atol=1e-6)
_frequency = partial(variable, units="rad/s", atol=1e-9)

#: Families of transition curves of Mathieu's equation: parity and period in units of T0 of the motion on them.
CURVES = ("cosine, period 1", "sine, period 1", "cosine, period 2", "sine, period 2")


def swing(depth: float, frequencies: Sequence[float], shown: Sequence[float], cycles: int = 12) -> xr.Dataset:
    """Motion of Mathieu's equation from rest, and its multipliers against the parametric frequency.

    Parameters
    ----------
    depth : float
        ε [-].
    frequencies : sequence of float
        ω [rad/s] at which multipliers are computed, ω0 = 1.
    shown : sequence of float
        ω [rad/s] at which the motion is computed from q = 1, q̇ = 0.
    cycles : int, optional
        Parametric periods of the motion.

    Returns
    -------
    xarray.Dataset
        ``multiplier_real``, ``multiplier_imag`` (frequency, number): the first has the larger modulus, or the
        positive imaginary part; ``motion`` (shown, time), time in parametric periods.
    """
    cycles = integer_at_least("cycles", cycles, 1)
    pairs = np.array([floquet.multipliers(classical.Mathieu(depth).system(w)) for w in frequencies])
    first = np.where(np.abs(pairs.imag) > 0, pairs[:, :1].real + 1j * np.abs(pairs.imag), pairs)[:, 0]
    multiplier = np.stack([first, 1.0 / first], axis=1)
    time = np.linspace(0.0, cycles, 40 * cycles + 1)
    motion = np.array([_motion(classical.Mathieu(depth).system(w), time) for w in shown])
    both = ("frequency", "number")
    return xr.Dataset(
        {
            "multiplier_real": variable(
                both, multiplier.real, "Real part of the multipliers", "1", atol=1e-6
            ),
            "multiplier_imag": variable(
                both, multiplier.imag, "Imaginary part of the multipliers", "1", atol=1e-6
            ),
            "motion": variable(("shown", "time"), motion, "Motion", "1", rtol=1e-6, atol=1e-7),
        },
        coords={
            "frequency": list(frequencies),
            "number": [1, 2],
            "shown": list(shown),
            "time": time,
        },
        attrs={"parameters": f"depth = {depth:.10g}"},
    )


def _motion(system: PeriodicSystem, periods: FloatArray) -> FloatArray:
    """q(t) from q = 1, q̇ = 0, by an integrator of SciPy."""

    def rate(fraction: float, state: FloatArray) -> FloatArray:
        return np.asarray(system.period * system.state_matrix(fraction) @ state)

    solution = solve_ivp(
        rate, (0.0, periods[-1]), [1.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-12, t_eval=periods
    )
    return np.asarray(solution.y[0])


def transition_curves(depths: ArrayLike, count: int, harmonics: int = 60) -> xr.Dataset:
    """Borders of the tongues of undamped Mathieu's equation from a tridiagonal eigenproblem.

    On a border there is a periodic motion Σ c_m cos mz or Σ c_m sin mz, z = ωt/2, m all even or all odd. Harmonic
    balance of q'' + a (1 + ε cos 2z) q = 0 gives m² c_m = a [c_m + ε/2 (c_{m-2} + c_{m+2})], a symmetric problem
    with a = (2ω0/ω)².

    Parameters
    ----------
    depths : array_like, shape (E,)
        ε [-], from 0 to below 1.
    count : int
        Curves of each family.
    harmonics : int, optional
        Harmonics kept.

    Returns
    -------
    xarray.Dataset
        ``border`` (family, number, depth): ω/ω0, the first tongue first; ``family`` numbers :data:`CURVES`.

    Raises
    ------
    ValueError
        If a depth is 1 or more, where the stiffness changes sign.
    """
    values = _depths_below_one(depths)
    count = integer_at_least("count", count, 1)
    border = np.empty((4, count, values.size))
    for family, (start, first_row) in enumerate(((0, 1.0), (2, 0.0), (1, 0.5), (1, -0.5))):
        m = start + 2.0 * np.arange(harmonics)
        for i, depth in enumerate(values):
            right = np.eye(harmonics) + depth / 2.0 * (np.eye(harmonics, k=1) + np.eye(harmonics, k=-1))
            if start == 1:
                # cos z and sin z meet themselves: cos 2z cos z = (cos z + cos 3z)/2, with minus for the sine.
                right[0, 0] += first_row * depth
            elif start == 0:
                # The constant term counts once: scale it to keep the matrix symmetric.
                right[0, 1] = right[1, 0] = depth / np.sqrt(2.0)
            a = eigh(np.diag(m**2), right, eigvals_only=True)
            a = a[1:] if start == 0 else a  # a = 0 is the free motion without a spring.
            border[family, :, i] = 2.0 / np.sqrt(a[:count])
    return xr.Dataset(
        {"border": _frequency(("family", "number", "depth"), border, "Border of a tongue, ω0 = 1")},
        coords={"family": np.arange(4), "number": np.arange(1, count + 1), "depth": values},
        attrs={"parameters": f"harmonics = {harmonics}"},
    )


def chart(growth: xr.DataArray, description: str) -> xr.Dataset:
    """Growth rates over one parameter of a classical equation and its parametric frequency.

    Parameters
    ----------
    growth : xarray.DataArray
        From :func:`facegear.maps.stability_map.stability_map`, over the parameter and ``speed``, which is here the
        frequency ω [rad/s].
    description : str
        Parameters of the system, for the provenance.

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (parameter, frequency) [1/s].
    """
    parameter = str(growth.dims[0])
    return xr.Dataset(
        {"growth_rate": _growth((parameter, "frequency"), growth.values, "Growth rate ln max|λ|/T0")},
        coords={parameter: growth[parameter].values, "frequency": growth["speed"].values},
        attrs={"parameters": description},
    )


def meissner_borders(depths: ArrayLike, count: int, frequencies: tuple[float, float]) -> xr.Dataset:
    """Borders of the tongues of undamped Meissner's equation with a duty of one half, from their closed form.

    Motions on a border are even or odd about the middle of either part. Matched where the parts meet, with
    A = p T0/4 and B = r T0/4 of :func:`facegear.mechanics.classical.meissner_trace`, that gives four
    equations, the first two with period T0, the others with 2 T0:
    p sin A cos B + r cos A sin B = 0, r sin A cos B + p cos A sin B = 0,
    p sin A sin B = r cos A cos B, r sin A sin B = p cos A cos B.

    Parameters
    ----------
    depths : array_like, shape (E,)
        ε [-], from 0 to below 1.
    count : int
        Curves of each family, the largest frequencies first.
    frequencies : tuple of float
        Lowest and highest ω/ω0 at which to look.

    Returns
    -------
    xarray.Dataset
        ``border`` (family, number, depth): ω/ω0, NaN where there are fewer.

    Raises
    ------
    ValueError
        If a depth is outside [0, 1).
    """
    values = _depths_below_one(depths)
    count = integer_at_least("count", count, 1)
    low, high = finite_array("frequencies", frequencies)
    border = np.full((4, count, values.size), np.nan)
    # Equal steps in the period, in which the equations oscillate evenly.
    grid = 1.0 / np.linspace(1.0 / high, 1.0 / low, 2001)

    def matched(frequency: Any, family: int, depth: float) -> Any:
        p, r = np.sqrt(1.0 + depth), np.sqrt(1.0 - depth)
        a, b = p * np.pi / (2.0 * frequency), r * np.pi / (2.0 * frequency)
        first, second = (p, r) if family in (0, 2) else (r, p)
        if family < 2:
            return first * np.sin(a) * np.cos(b) + second * np.cos(a) * np.sin(b)
        return first * np.sin(a) * np.sin(b) - second * np.cos(a) * np.cos(b)

    for family in range(4):
        for i, depth in enumerate(values):
            sign = np.sign(matched(grid, family, depth))
            crossings = np.flatnonzero(sign[:-1] * sign[1:] < 0)[:count]
            border[family, : crossings.size, i] = [
                brentq(matched, grid[k + 1], grid[k], args=(family, depth), xtol=1e-14) for k in crossings
            ]
    return xr.Dataset(
        {"border": _frequency(("family", "number", "depth"), border, "Border of a tongue, ω0 = 1")},
        coords={"family": np.arange(4), "number": np.arange(1, count + 1), "depth": values},
        attrs={"parameters": f"Meissner, duty = 0.5, frequencies = {low:.10g} to {high:.10g}"},
    )


def _depths_below_one(depths: ArrayLike) -> FloatArray:
    values = finite_array("depths", depths)
    if (values < 0.0).any() or (values >= 1.0).any():
        raise ValueError(f"depths must lie in [0, 1), got {values.min():g} to {values.max():g}")
    return values


def damped_charts(frequencies: ArrayLike, depths: ArrayLike, damping_ratios: Sequence[float]) -> xr.Dataset:
    """Charts of Mathieu's equation for several damping ratios.

    Parameters
    ----------
    frequencies : array_like, shape (W,)
        ω [rad/s], ω0 = 1, ascending.
    depths : array_like, shape (E,)
        ε [-].
    damping_ratios : sequence of float
        ϑ [-].

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (damping_ratio, depth, frequency) [1/s].
    """
    charts = [
        chart(stability_map(classical.Mathieu(1.0, zeta), frequencies, "depth", depths), "")
        for zeta in damping_ratios
    ]
    joined = xr.concat(charts, dim=xr.Variable("damping_ratio", list(damping_ratios)), combine_attrs="drop")
    joined["growth_rate"].attrs = charts[0]["growth_rate"].attrs
    joined.attrs["parameters"] = "Mathieu, natural_frequency = 1"
    return joined


def duty_chart(frequencies: ArrayLike, duties: ArrayLike, depth: float) -> xr.Dataset:
    """Growth rates of Meissner's equation over the duty of its square wave and the parametric frequency.

    Parameters
    ----------
    frequencies : array_like, shape (W,)
        ω [rad/s], ω0 = 1, ascending.
    duties : array_like, shape (D,)
        Part of the period with the higher stiffness [-].
    depth : float
        ε [-].

    Returns
    -------
    xarray.Dataset
        ``growth_rate`` (duty, frequency) [1/s].
    """
    speeds = finite_array("frequencies", frequencies)
    # Along the frequency, for along the duty the jumps move. Two pieces of constant stiffness: one exponential each is
    # exact.
    rows = [
        family_spectral_radii(classical.Meissner(depth, duty).system, speeds, methods.AlignedStepwise(2))
        for duty in finite_array("duties", duties)
    ]
    return xr.Dataset(
        {
            "growth_rate": _growth(
                ("duty", "frequency"), np.log(rows) * speeds / (2.0 * np.pi), "Growth rate ln max|λ|/T0"
            )
        },
        coords={"duty": np.asarray(duties, dtype=float), "frequency": speeds},
        attrs={"parameters": f"Meissner, depth = {depth:.10g}"},
    )


def bands(model: Model, depths: Sequence[float], order: int, description: str) -> xr.Dataset:
    """Hsu's bands of the parametric frequency against the depth of modulation.

    Parameters
    ----------
    model : Model
        With a parameter ``depth``.
    depths : sequence of float
        ε [-], ascending.
    order : int
        Highest s.
    description : str
        Parameters of the system, for the provenance.

    Returns
    -------
    xarray.Dataset
        ``lower``, ``upper``, ``centre`` [rad/s] over (band, depth), NaN where damping closes the band; labels like
        "(1+2)/1" in the coordinate ``label``.
    """
    # Bands do not depend on the frequency at which the system is taken.
    systems = [replace_parameter(model, "depth", float(depth)).system(2.0) for depth in depths]
    found: list[dict[str, ResonanceBand]] = [
        {band.label: band for band in resonance_bands(system, order=order)} for system in systems
    ]
    labels = sorted({label for row in found for label in row}, key=lambda name: _first(found, name).centre)

    def table(name: str) -> FloatArray:
        return np.array(
            [[getattr(row[label], name) if label in row else np.nan for row in found] for label in labels]
        ).reshape(len(labels), len(depths))

    both = ("band", "depth")
    return xr.Dataset(
        {
            "lower": _frequency(both, table("lower"), "Lower border of the band"),
            "upper": _frequency(both, table("upper"), "Upper border of the band"),
            "centre": _frequency(both, table("centre"), "Combination of natural frequencies over s"),
        },
        coords={
            "band": np.arange(1, len(labels) + 1),
            "label": text("band", labels, "Label of the band"),
            "depth": list(depths),
        },
        attrs={"parameters": description},
    )


def _first(found: Sequence[dict[str, ResonanceBand]], label: str) -> ResonanceBand:
    return next(row[label] for row in found if label in row)


def hsu_errors(depths: Sequence[float]) -> xr.Dataset:
    """Hsu's borders of Mathieu's first tongue against the exact ones, and the tongue that he does not see.

    Parameters
    ----------
    depths : sequence of float
        ε [-].

    Returns
    -------
    xarray.Dataset
        Over ``depth``: ``width`` of the first tongue, ``error`` (the larger of its two border errors),
        ``second_width`` of the second tongue, which has no band [rad/s], ω0 = 1.
    """
    hsu = bands(classical.Mathieu(1.0), depths, 6, "")
    curves = transition_curves(depths, 1)["border"].values[:, 0]
    # Tongue 1 has the period 2 T0, tongue 2 the period T0.
    low, high = np.sort(curves[2:], axis=0)
    error = np.maximum(np.abs(hsu["lower"].values[0] - low), np.abs(hsu["upper"].values[0] - high))
    second = np.sort(curves[:2], axis=0)
    return xr.Dataset(
        {
            "width": _frequency("depth", high - low, "Width of the first tongue"),
            "error": _frequency("depth", error, "Largest error of Hsu's borders"),
            "second_width": _frequency("depth", second[1] - second[0], "Width of the second tongue"),
        },
        coords={"depth": list(depths)},
        attrs={"parameters": "Mathieu, undamped"},
    )
