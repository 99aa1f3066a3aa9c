"""How much power a face gear bears: flutter of the disk alone, and the largest power at which a speed range is stable.

A force that stays tangent to the bent rim feeds a wave which runs against it: while the rim's slope is s the force
does work F s ∂w/∂t. In K_f of (6-27) that is the rim term of the mean shear, which couples a wave with itself only
and makes ω² of the mode (m, n) complex,

    ω² ∓ iε,    ε = n F_t R_mn(a)²/(2πρah),

or, where a force with the same moment presses at radii r with parts ϖ of it, n F_t a Σ ϖ R_mn(r)²/r² over 2πρh,

so that it grows at ε/(2ω) while the viscous disk takes away ξω²/2. The two are equal at ε = ξω³, at any speed: the
loss belongs to the material and turns with it, and so do the waves. This holds for a disk alone; a pinion that holds
the waves in place changes it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from facegear.floquet.models import replace_parameter
from facegear.floquet.modes import natural_exponents
from facegear.floquet.multipliers import growth_rate
from facegear.maps.peaks import critical_value, growth_peak
from facegear.maps.tracing import Tongue, tongues
from facegear.mechanics.disk import disk_matrices
from facegear.mechanics.edge_stiffness import DrivingForce, Following
from facegear.mechanics.plate import Body
from facegear.mechanics.pressed_points import Spread, points_on
from facegear.mechanics.spreads import RIM_POINT
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import ascending, nonnegative, within
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

# Powers, over the critical one of the disk alone, at which a disk is tried.
_FIRST, _RATIO, _LAST = 1 / 8, 1.15, 100.0
# The same for a whole drive, at which tongues are looked for.
_LEVELS = (0.3, 0.6, 0.8, 1.0, 1.2, 1.5, 1.9, 2.4, 3.0)
# Window in which the peak of a tongue is looked for as the power changes, relative to its speed.
# Flutter of the mean system has no sharp peak, so that it may lie far away.
_WINDOWS = {"window": 0.004, "widest": 0.03, "resolution": 3e-5}
_MOST_TURNS = 30


def mode_critical_powers(body: Body, pinion_speed: float, spread: Spread = RIM_POINT) -> FloatArray:
    """Power at which each mode of the disk alone begins to flutter under a follower force, to first order.

    Parameters
    ----------
    body : Body
    pinion_speed : float
        Ω1 at that power [rad/s].
    spread : Spread, optional
        Where the force presses.

    Returns
    -------
    ndarray, shape (M + 1, N + 1)
        P = ξω³/(ε/P) [W]; infinite without nodal diameters, where the disk has no slope along the force.

    Raises
    ------
    TypeError, ValueError
        If `pinion_speed` is not a number greater than 0.
    """
    points = points_on(body, spread)
    squares = np.stack([modes.continued(points.radius) ** 2 for modes in body.modes], axis=1)
    tilt = squares @ (points.share / points.radius**2) / body.outer_radius**2
    diameters = np.arange(body.nodal_diameters + 1)
    material = body.material
    growth = diameters * DrivingForce(1.0, pinion_speed).newtons(body.drive) * tilt
    growth /= 2 * math.pi * material.density * body.outer_radius * body.thickness
    loss = material.viscous_loss_factor * body.eigenvalues**1.5
    powers = np.full(growth.shape, math.inf)
    np.divide(loss, growth, out=powers, where=growth > 0.0)
    return powers


def disk_growth_rate(
    body: Body,
    force: DrivingForce,
    speed: float,
    *,
    angles: Sequence[float] = (0.0,),
    senses: Sequence[int] | None = None,
) -> float:
    """Growth rate of the disk alone under driving forces: its largest eigenvalue's real part.

    Parameters
    ----------
    body : Body
    force : DrivingForce
        Of each pinion.
    speed : float
        Ω2 of the face gear [rad/s], 0 or greater.
    angles : sequence of float
        Where the forces act [rad], one each.
    senses : sequence of int, optional
        1 for a force in the sense in which the disk turns, -1 for one against it. Default: all 1.

    Returns
    -------
    float
        [1/s].

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range.
    """
    damping, stiffness = disk_matrices(body, speed)
    stiffness = stiffness + force.stiffness(body, speed, angles, senses)
    return float(natural_exponents(np.eye(len(stiffness)), damping, stiffness).real.max())


@one_thread()
def critical_power(
    body: Body,
    pinion_speed: float,
    speed: float,
    *,
    following: Following = "follower",
    harmonics: int = 5,
    angles: Sequence[float] = (0.0,),
    senses: Sequence[int] | None = None,
    highest_power: float = 0.0,
    spread: Spread = RIM_POINT,
) -> float:
    """Smallest power of each of one or more equal pinions at which the disk alone is unstable.

    Powers 15 % apart are tried upwards, and the first change of stability is then found as a root.

    Parameters
    ----------
    body : Body
        With a viscous loss factor above 0.
    pinion_speed : float
        Ω1 at that power [rad/s].
    speed : float
        Ω2 of the face gear [rad/s], 0 or greater.
    following, harmonics
        As for :class:`facegear.mechanics.edge_stiffness.DrivingForce`.
    angles : sequence of float
        Where the forces act [rad], one each. Follower forces add up: two of them make the disk flutter at half the
        power of each.
    senses : sequence of int, optional
        As for :func:`disk_growth_rate`.
    highest_power : float
        Powers up to this one [W] are tried in any case.
    spread : Spread
        Where each force presses.

    Returns
    -------
    float
        [W]; infinite if the disk is stable up to 100 times the power at which a follower force makes a mode flutter,
        or up to `highest_power` if that is more, and without nodal diameters, where the force does no work on the rim.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range, or the disk has no damping, so that it is never
        asymptotically stable.
    """
    if body.material.viscous_loss_factor == 0.0:
        raise ValueError(
            "viscous_loss_factor of the body's material must be greater than 0: without damping any power flutters"
        )
    unit = float(mode_critical_powers(body, pinion_speed, spread).min())
    if unit == math.inf:
        return math.inf

    def growth(share: float) -> float:
        force = DrivingForce(share * unit, pinion_speed, following, harmonics, spread)
        return disk_growth_rate(body, force, speed, angles=angles, senses=senses)

    low, high = 0.0, _FIRST
    last = max(_LAST, nonnegative("highest_power", highest_power, "W") / unit)
    while growth(high) <= 0.0:
        if high > last:
            return math.inf
        low, high = high, high * _RATIO
    return unit * float(brentq(growth, low, high, xtol=1e-12, rtol=1e-12))


@dataclass(frozen=True)
class PowerLimit:
    """Largest power at which a speed range is stable.

    Attributes
    ----------
    power : float
        [W]; 0 if the range is not stable even without power, infinite if no limit was found.
    speed : float
        Ω2 where it is lost first [rad/s], NaN if nowhere.
    label : str
        Modes and order of the instability there, as :attr:`facegear.maps.tracing.Tongue.label`; empty if there is none.
    """

    power: float
    speed: float
    label: str


@one_thread()
def largest_power(model: Transverse, speeds: ArrayLike, *, tolerance: float = 1e-3) -> PowerLimit:
    """Largest power below which a drive is stable at all speeds of a range.

    All tongues are looked for at powers that rise to 3 times the critical power of the disk alone, until there are
    some. The strongest is followed down to the power at which its largest growth rate vanishes. Just below that all
    tongues are looked for once more, and the strongest followed, until there are none. What can be missed is an
    instability that comes and goes between two of the powers tried below the result.

    Parameters
    ----------
    model : Transverse
        With a driving force, whose own power does not matter.
    speeds : (low, high)
        Range of Ω2 [rad/s].
    tolerance : float
        Relative accuracy of the power, 1e-6 to 0.1.

    Returns
    -------
    PowerLimit

    Raises
    ------
    TypeError, ValueError
        If the model has no driving force, the range is not two ascending positive numbers, or the tolerance is
        outside its range.
    ArithmeticError
        If the peak of a tongue is lost.
    """
    if model.force is None:
        raise ValueError("force of the model must be a DrivingForce, got None")
    tolerance = within("tolerance", tolerance, 1e-6, 0.1)
    low, high = ascending("speeds", speeds, "rad/s")
    unit = float(mode_critical_powers(model.body, model.force.pinion_speed, model.force.spread).min())

    def at(power: float) -> Transverse:
        return replace_parameter(model, "force.power", power)

    if found := tongues(at(0.0), (low, high)):
        worst = max(found, key=lambda tongue: tongue.growth_rate)
        return PowerLimit(0.0, worst.peak, worst.label)
    if unit == math.inf:
        return PowerLimit(math.inf, math.nan, "")
    stable, level = 0.0, 0.0
    for share in _LEVELS:
        stable, level = level, share * unit
        if found := tongues(at(level), (low, high)):
            break
    lowest = PowerLimit(math.inf, math.nan, "")
    while found:
        strongest = max(found, key=lambda tongue: tongue.growth_rate)
        lowest = _tip(at, stable, level, strongest, (low, high), tolerance / 2)
        level = lowest.power * (1 - tolerance)
        found = tongues(at(level), (low, high))
    return lowest


def _tip(
    at: Callable[[float], Transverse],
    stable: float,
    unstable: float,
    tongue: Tongue,
    speeds: tuple[float, float],
    tolerance: float,
) -> PowerLimit:
    """Follow a tongue down to its tip: in turn the power at which its speed is stable, and the worst speed there."""
    speed, power = tongue.peak, unstable

    def here(value: float) -> tuple[float, float]:
        return speed, growth_rate(at(value).system(speed))

    for _ in range(_MOST_TURNS):
        above = power
        power, _ = critical_value(here, stable, above, rtol=tolerance / 4)
        if power > above * (1 - tolerance):
            return PowerLimit(power, speed, tongue.label)
        speed, value = growth_peak(at(power), speed, speeds, **_WINDOWS)
        if here(stable)[1] >= 0.0 or value <= 0.0:
            return PowerLimit(power, speed, tongue.label)
    raise ArithmeticError(f"the tip of tongue {tongue.label} was not found in {_MOST_TURNS} turns")
