"""Contact ellipse of two elastic bodies pressed together at a point, after Hertz."""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq
from scipy.special import elliprd, elliprf

from facegear.support.parameters import positive

# Forces [N] and moduli [Pa] for which Hertz' ellipse is computed: below and above it is no size that a number can have.
_LEAST_FORCE, _LARGEST_MODULUS = 1e-12, 1e15


@dataclass(frozen=True)
class Ellipse:
    """Contact ellipse of two elastic bodies pressed together (Hertz).

    Attributes
    ----------
    long, short : float
        Semi-axes [m].
    approach : float
        By which bodies come nearer [m].
    pressure : float
        In the middle [Pa].
    """

    long: float
    short: float
    approach: float
    pressure: float


def contact_ellipse(smaller: float, larger: float, force: float, modulus: float) -> Ellipse:
    """Find the ellipse for two principal curvatures of the gap.

    Semi-axes follow from Carlson's integrals (Johnson, Contact Mechanics, section 4.2): a curvature is
    F/(πE*) R_D(0, other², own²) of the semi-axes, the approach 3F/(2πE*) R_F(0, long², short²).

    Parameters
    ----------
    smaller, larger : float
        Curvatures, both positive [1/m].
    force : float
        Along the normal [N].
    modulus : float
        E* [Pa].

    Returns
    -------
    Ellipse

    Raises
    ------
    TypeError, ValueError
        If force or modulus is not a number greater than 0, `force` is below 1e-12 N or `modulus` above 1e15 Pa.

    Examples
    --------
    >>> sphere = contact_ellipse(100.0, 100.0, force=10.0, modulus=1e11)  # of 10 mm radius on a plane
    >>> round(1e6 * sphere.long, 2) == round(1e6 * (3 * 10.0 * 0.01 / (4 * 1e11)) ** (1 / 3), 2)
    True
    """
    force, modulus = positive("force", force, "N"), positive("modulus", modulus, "Pa")
    if force < _LEAST_FORCE:
        raise ValueError(f"force must be at least {_LEAST_FORCE:g} N, got {force!r} N")
    if modulus > _LARGEST_MODULUS:
        raise ValueError(f"modulus must be at most {_LARGEST_MODULUS:g} Pa, got {modulus!r} Pa")

    def excess(logarithm: float) -> float:
        k = math.exp(logarithm)  # (short/long)²
        return math.log(float(elliprd(0.0, 1.0, k)) / float(elliprd(0.0, k, 1.0))) - math.log(
            larger / smaller
        )

    k = math.exp(float(brentq(excess, -80.0, 0.0, xtol=1e-14))) if larger > smaller else 1.0
    scale = force / (math.pi * modulus)
    long = (scale * float(elliprd(0.0, k, 1.0)) / smaller) ** (1.0 / 3.0)
    short = long * math.sqrt(k)
    approach = 1.5 * scale * float(elliprf(0.0, long**2, short**2))
    return Ellipse(long, short, approach, 1.5 * force / (math.pi * long * short))
