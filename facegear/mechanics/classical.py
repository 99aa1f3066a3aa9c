"""Classical periodic systems whose stability is known in closed form or from tables (section 2.1).

One coordinate with natural frequency ω0, depth of modulation ε and damping ratio ϑ,

    q̈ + 2 ϑ ω0 q̇ + ω0² [1 + ε w(ωt)] q = 0,

is Mathieu's equation for w = cos and Meissner's for a square wave. Two coordinates with one modulated spring have
combination resonances, and a pair of gears has a mesh stiffness that steps as tooth pairs enter and leave.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from facegear.floquet.periodic import ContactLoad, PeriodicSystem
from facegear.floquet.piecewise import SAME_INSTANT, PiecewiseChebyshev
from facegear.support.parameters import finite, finite_array, nonnegative, positive, within
from facegear.support.types import FloatArray


@lru_cache(maxsize=1)
def cosine_wave() -> PiecewiseChebyshev:
    """Return w(ωt) = cos ωt."""
    return PiecewiseChebyshev.fit(lambda x, piece: np.cos(2.0 * np.pi * x), [0.0])


@lru_cache(maxsize=64)
def square_wave(duty: float) -> PiecewiseChebyshev:
    """Return w = +1 over the first part of the period, -1 over the rest.

    Parameters
    ----------
    duty : float
        The first part as a fraction of the period [-], between 0.001 and 0.999.

    Raises
    ------
    TypeError, ValueError
        If ``duty`` is outside this range.
    """
    duty = within("duty", duty, 0.001, 0.999)
    return PiecewiseChebyshev(np.array([0.0, duty]), np.array([1.0, -1.0])[:, None, None])


@lru_cache(maxsize=64)
def tooth_pair_wave(contact_ratio: float, droop: float) -> PiecewiseChebyshev:
    """Sum over the tooth pairs in mesh of their stiffness, relative to that of one pair at mid-sweep.

    Parameters
    ----------
    contact_ratio, droop : float
        As in :func:`gear_pair`.

    Raises
    ------
    TypeError, ValueError
        If one is outside its range.
    """
    contact_ratio = within("contact_ratio", contact_ratio, 1.0, 5.0)
    droop = within("droop", droop, 0.0, 1.0)
    # So close to a whole number a pair leaves as the next one enters.
    nearest = round(contact_ratio)
    if abs(contact_ratio - nearest) <= SAME_INSTANT:
        contact_ratio = float(nearest)
    whole = int(np.floor(contact_ratio))
    rest = contact_ratio - whole
    breakpoints = [0.0] if rest == 0.0 else [0.0, rest]

    def total(x: FloatArray, piece: int) -> FloatArray:
        count = whole + 1 if rest > 0.0 and piece == 0 else whole
        share = (x + np.arange(count)[:, None]) / contact_ratio
        return np.asarray((1.0 - droop * (2.0 * share - 1.0) ** 2).sum(axis=0))

    return PiecewiseChebyshev.fit(total, breakpoints)


def hill(
    frequency: float,
    depth: float,
    wave: PiecewiseChebyshev,
    damping_ratio: float = 0.0,
    natural_frequency: float = 1.0,
) -> PeriodicSystem:
    """Hill's equation with one coordinate: any periodic stiffness (2-1).

    Parameters
    ----------
    frequency : float
        Parametric frequency ω = 2π/T0 [rad/s].
    depth : float
        Depth of modulation ε [-], not negative.
    wave : PiecewiseChebyshev
        w over the fraction of the period, one component.
    damping_ratio : float
        ϑ [-], from 0 to below 1.
    natural_frequency : float
        ω0 [rad/s].

    Returns
    -------
    PeriodicSystem
        Its one load has the stiffness ε ω0² and the weight w.

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.

    Examples
    --------
    >>> from facegear.floquet.multipliers import growth_rate
    >>> round(growth_rate(mathieu(frequency=2.0, depth=0.2)), 4)
    0.0499
    """
    frequency = positive("frequency", frequency, "rad/s")
    natural_frequency = positive("natural_frequency", natural_frequency, "rad/s")
    damping_ratio = within("damping_ratio", damping_ratio, 0.0, np.nextafter(1.0, 0.0))
    stiffness = nonnegative("depth", depth) * natural_frequency**2
    load = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=stiffness, weight=wave)
    return PeriodicSystem(
        mass=np.eye(1),
        damping=np.array([[2.0 * damping_ratio * natural_frequency]]),
        stiffness=np.array([[natural_frequency**2]]),
        loads=(load,),
        period=2.0 * np.pi / frequency,
    )


def mathieu(
    frequency: float, depth: float, damping_ratio: float = 0.0, natural_frequency: float = 1.0
) -> PeriodicSystem:
    """Mathieu's equation q̈ + 2ϑω0 q̇ + ω0² (1 + ε cos ωt) q = 0.

    With z = ωt/2 it is the standard form q'' + (a - 2 p cos 2z) q = 0, a = (2ω0/ω)², p = -ε a/2, apart from the
    damping.

    Parameters
    ----------
    frequency, depth, damping_ratio, natural_frequency
        As in :func:`hill`.

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    TypeError, ValueError
        As :func:`hill`.
    """
    return hill(frequency, depth, cosine_wave(), damping_ratio, natural_frequency)


def meissner(
    frequency: float,
    depth: float,
    duty: float = 0.5,
    damping_ratio: float = 0.0,
    natural_frequency: float = 1.0,
) -> PeriodicSystem:
    """Meissner's equation: stiffness ω0² (1 + ε) over the first part of the period, ω0² (1 - ε) over the rest.

    Parameters
    ----------
    frequency, depth, damping_ratio, natural_frequency
        As in :func:`hill`.
    duty : float
        The first part as a fraction of the period [-], between 0.001 and 0.999.

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    TypeError, ValueError
        As :func:`hill`.
    """
    return hill(frequency, depth, square_wave(duty), damping_ratio, natural_frequency)


def meissner_trace(
    frequency: ArrayLike,
    depth: ArrayLike,
    duty: ArrayLike = 0.5,
    damping_ratio: float = 0.0,
    natural_frequency: float = 1.0,
) -> FloatArray:
    """Trace of the transition matrix of Meissner's equation in closed form.

    tr Φ = exp(-ϑω0T0) [2 cos a cos b - (p/r + r/p) sin a sin b] with p² = ω0² (1 + ε - ϑ²), r² = ω0² (1 - ε - ϑ²),
    a = p d T0 and b = r (1 - d) T0, d the duty; the undamped equation is stable while |tr Φ| < 2.

    Parameters
    ----------
    frequency, depth, duty : array_like
        As in :func:`meissner`, broadcast against each other.
    damping_ratio, natural_frequency : float
        As in :func:`meissner`.

    Returns
    -------
    array
        Of the broadcast shape [-].
    """
    given = {"frequency": frequency, "depth": depth, "duty": duty}
    w, eps, d = np.broadcast_arrays(*(finite_array(name, values) for name, values in given.items()))
    damping_ratio = finite("damping_ratio", damping_ratio)
    natural_frequency = finite("natural_frequency", natural_frequency, "rad/s")
    period = 2.0 * np.pi / w
    # Complex, because the softer part has no frequency where ε + ϑ² > 1.
    p, r = (natural_frequency * np.sqrt(1.0 + sign * eps - damping_ratio**2 + 0j) for sign in (1.0, -1.0))
    a, b = p * d * period, r * (1.0 - d) * period
    # sin b / r stays finite where r vanishes.
    share = np.where(np.abs(b) > 1e-8, np.sin(b) / np.where(r == 0.0, 1.0, r), (1.0 - d) * period)
    bracket = 2.0 * np.cos(a) * np.cos(b) - (p + r**2 / p) * np.sin(a) * share
    return np.asarray(np.exp(-damping_ratio * natural_frequency * period) * bracket.real)


def coupled_pair(
    frequency: float,
    depth: float,
    coupling: float = 0.0,
    circulation: float = 0.0,
    damping: float = 0.0,
    stiffnesses: tuple[float, float] = (1.0, 3.5),
) -> PeriodicSystem:
    """Two unit masses, the spring of the first one modulated: q̈ + c q̇ + [K + ε cos ωt e1 e1ᵀ] q = 0.

    K has `stiffnesses` on its diagonal and κ - χ, κ + χ off it. Coupled by a spring (κ) the pair has resonances of
    the sum type; coupled by a circulatory force (χ), one that does work along closed paths as a follower force
    does, of the difference type.

    Parameters
    ----------
    frequency : float
        Parametric frequency ω [rad/s].
    depth : float
        ε [N/m], not negative.
    coupling, circulation : float
        κ and χ [N/m].
    damping : float
        c [N s/m] of each mass, not negative.
    stiffnesses : tuple of float
        Diagonal of K [N/m], positive.

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    TypeError, ValueError
        Naming the parameter, or if K has no two positive, distinct eigenvalues.
    """
    first, second = (positive(f"stiffnesses[{i}]", stiffnesses[i], "N/m") for i in (0, 1))
    kappa = finite("coupling", coupling, "N/m")
    chi = finite("circulation", circulation, "N/m")
    K = np.array([[first, kappa - chi], [kappa + chi, second]])
    apart = (first - second) ** 2 / 4.0 + kappa**2 - chi**2
    if apart <= 0.0 or np.linalg.det(K) <= 0.0:
        raise ValueError(
            f"coupling and circulation must leave K two positive, distinct eigenvalues, got coupling={coupling!r}, "
            f"circulation={circulation!r} with stiffnesses={stiffnesses!r}"
        )
    load = ContactLoad(
        PiecewiseChebyshev.constant([1.0, 0.0]),
        stiffness=nonnegative("depth", depth, "N/m"),
        weight=cosine_wave(),
    )
    return PeriodicSystem(
        mass=np.eye(2),
        damping=nonnegative("damping", damping, "N s/m") * np.eye(2),
        stiffness=K,
        loads=(load,),
        period=2.0 * np.pi / positive("frequency", frequency, "rad/s"),
    )


def gear_pair(
    mesh_frequency: float,
    contact_ratio: float,
    pair_stiffness: float = 0.6,
    pair_damping: float = 0.0,
    droop: float = 0.0,
    shaft_stiffnesses: tuple[float, float] = (0.5, 1.0),
    shaft_damping: float = 0.0,
    masses: tuple[float, float] = (1.0, 1.5),
) -> PeriodicSystem:
    """Pinion and gear on sprung shafts with the mesh stiffness of the tooth pairs in contact.

    Coordinates are the motions of both base circles along the line of action. A pair's stiffness over its sweep is
    k [1 - κ (2s - 1)²], s from 0 at entry to 1 at exit: with κ = 0 the mesh stiffness steps, with κ = 1 it has
    kinks only, because every pair enters and leaves without stiffness.

    Parameters
    ----------
    mesh_frequency : float
        ω = 2π/T0 [rad/s], T0 the mesh period.
    contact_ratio : float
        Mesh periods that a pair stays in mesh [-], from 1 to 5.
    pair_stiffness, pair_damping : float
        k [N/m] and c [N s/m] of one pair at mid-sweep, not negative; damping follows the stiffness.
    droop : float
        κ [-], from 0 to 1.
    shaft_stiffnesses : tuple of float
        Stiffness of both shafts, reduced to the line of action [N/m], positive.
    shaft_damping : float
        Damping of each [N s/m], not negative.
    masses : tuple of float
        Both inertias reduced to the line of action [kg], positive.

    Returns
    -------
    PeriodicSystem

    Raises
    ------
    TypeError, ValueError
        Naming the parameter and what would be valid.
    """
    load = ContactLoad(
        PiecewiseChebyshev.constant([1.0, -1.0]),
        stiffness=nonnegative("pair_stiffness", pair_stiffness, "N/m"),
        damping=nonnegative("pair_damping", pair_damping, "N s/m"),
        weight=tooth_pair_wave(contact_ratio, droop),
    )
    shafts = [positive(f"shaft_stiffnesses[{i}]", shaft_stiffnesses[i], "N/m") for i in (0, 1)]
    return PeriodicSystem(
        mass=np.diag([positive(f"masses[{i}]", masses[i], "kg") for i in (0, 1)]),
        damping=nonnegative("shaft_damping", shaft_damping, "N s/m") * np.eye(2),
        stiffness=np.diag(shafts),
        loads=(load,),
        period=2.0 * np.pi / positive("mesh_frequency", mesh_frequency, "rad/s"),
    )
