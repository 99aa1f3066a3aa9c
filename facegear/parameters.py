"""Checked inputs: what every quantity may be, units at the edges, material and mesh load.

Inside the package everything is in SI units and radians. Every public entry checks what it is given with the
functions below, so that one wrong number ends in one sentence that names the parameter.
"""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

WATT_PER_HORSEPOWER = 745.69987


def _shown(value: Any, unit: str) -> str:
    return f"{value!r} {unit}".rstrip()


def finite(name: str, value: Any, unit: str = "") -> float:
    """Check that `value` is one finite real number and return it as a float.

    Parameters
    ----------
    name : str
        Name of the parameter, for the message.
    value : object
        What the caller gave.
    unit : str, optional
        Unit, for the message.

    Raises
    ------
    TypeError
        Not a real number (a boolean is none either).
    ValueError
        NaN or infinite.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, Real):
        raise TypeError(f"{name} must be a real number{_in(unit)}, got {value!r}")
    try:
        number = float(value)
    except OverflowError:  # an integer of more than 308 digits
        number = math.inf
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite{_in(unit)}, got {value!r}")
    return number


def _in(unit: str) -> str:
    return f" in {unit}" if unit else ""


def positive(name: str, value: Any, unit: str = "") -> float:
    """Check that `value` is finite and greater than zero; parameters and errors as in `finite`."""
    number = finite(name, value, unit)
    if number <= 0.0:
        raise ValueError(f"{name} must be greater than 0{_in(unit)}, got {_shown(value, unit)}")
    return number


def nonnegative(name: str, value: Any, unit: str = "") -> float:
    """Check that `value` is finite and not below zero; parameters and errors as in `finite`."""
    number = finite(name, value, unit)
    if number < 0.0:
        raise ValueError(f"{name} must be 0 or greater{_in(unit)}, got {_shown(value, unit)}")
    return number


def within(name: str, value: Any, lowest: float, highest: float, unit: str = "", hint: str = "") -> float:
    """Check that `value` lies in the closed interval [lowest, highest].

    Parameters
    ----------
    name, value, unit
        As in `finite`.
    lowest, highest : float
        Ends of the valid interval, both allowed.
    hint : str, optional
        Appended to the message, for example the likely wrong unit.

    Raises
    ------
    TypeError, ValueError
        As in `finite`, and ValueError outside the interval. A value that would be valid after multiplying or
        dividing by 1000 is named as a likely mistake of units.
    """
    number = finite(name, value, unit)
    if lowest <= number <= highest:
        return number
    message = f"{name} must lie in [{lowest:.6g}, {highest:.6g}]{_in(unit)}, got {_shown(value, unit)}"
    for factor in (1e-3, 1e3):
        if not hint and lowest <= number * factor <= highest:
            hint = f"wrong by a factor of 1000? {name}={number * factor:.6g} would be valid"
    raise ValueError(f"{message} ({hint})" if hint else message)


def angle_within(name: str, value: Any, lowest_deg: float, highest_deg: float) -> float:
    """Check an angle [rad] against limits [degree]; an angle that looks like degrees is named as such."""
    number = finite(name, value, "rad")
    # The limits themselves, however they were converted, are valid.
    slack = 1e-12
    if math.radians(lowest_deg) - slack <= number <= math.radians(highest_deg) + slack:
        return number
    hint = ""
    if lowest_deg <= number <= highest_deg:
        hint = f" (looks like degrees: use math.radians({value!r}))"
    raise ValueError(
        f"{name} must lie between {lowest_deg:g}° and {highest_deg:g}°, that is in "
        f"[{math.radians(lowest_deg):.4f}, {math.radians(highest_deg):.4f}] rad, got {value!r}{hint}"
    )


def integer_at_least(name: str, value: Any, lowest: int) -> int:
    """Check that `value` is a whole number of at least `lowest` and return it as an int.

    Raises
    ------
    TypeError
        Not an integer; a float with an integer value is refused too, since a tooth count is counted.
    ValueError
        Below `lowest`.
    """
    if isinstance(value, bool | np.bool_) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be an integer of at least {lowest}, got {value!r}")
    number = int(value)
    if number < lowest:
        raise ValueError(f"{name} must be at least {lowest}, got {value!r}")
    return number


def one_of(name: str, value: Any, choices: Collection[str]) -> None:
    """Check that `value` is one of a few words.

    Raises
    ------
    ValueError
        Naming the words that are valid.
    """
    # Not only `in`: arrays compare element by element.
    if not isinstance(value, str) or value not in choices:
        raise ValueError(f"{name} must be {' or '.join(map(repr, choices))}, got {value!r}")


def finite_array(name: str, values: ArrayLike, unit: str = "") -> FloatArray:
    """Check that every entry is a finite real number and return a float array of the same shape.

    Raises
    ------
    TypeError
        Not numeric, or complex.
    ValueError
        An entry is NaN or infinite.
    """
    array = np.asarray(values)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be real numbers{_in(unit)}, got {values!r}")
    if not np.all(np.isfinite(array)):
        bad = array[~np.isfinite(array)].flat[0]
        raise ValueError(f"{name} must be finite{_in(unit)}, got an entry {bad!r}")
    return array.astype(np.float64)


def known_keys(
    name: str, value: Any, required: Collection[str], optional: Collection[str] = ()
) -> dict[str, Any]:
    """Check that `value` is a mapping with every required key and no unknown one, and return it as a dict.

    Parameters
    ----------
    name : str
        Name of the mapping, for the message.
    value : object
        What was read.
    required, optional : collection of str
        Keys that must, and that may, be there.

    Raises
    ------
    TypeError
        Not a mapping.
    ValueError
        A key is missing or unknown.
    """
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} must be a mapping with the keys {', '.join(required)}, got {value!r}")
    missing = [key for key in required if key not in value]
    unknown = [str(key) for key in value if key not in {*required, *optional}]
    if missing or unknown:
        faults = [f"missing {', '.join(missing)}"] * bool(missing) + [f"unknown {', '.join(unknown)}"] * bool(
            unknown
        )
        raise ValueError(
            f"{name} must have the keys {', '.join((*required, *optional))}: {' and '.join(faults)}"
        )
    return dict(value)


def rad_per_s(speed_rpm: ArrayLike) -> Any:
    """Convert revolutions per minute to rad/s; a number gives a number, an array an array."""
    return np.multiply(speed_rpm, math.pi / 30.0)[()]


def rpm(speed: ArrayLike) -> Any:
    """Convert rad/s to revolutions per minute; a number gives a number, an array an array."""
    return np.multiply(speed, 30.0 / math.pi)[()]


def watt(power_hp: ArrayLike) -> Any:
    """Convert horsepower (745.69987 W) to watt; a number gives a number, an array an array."""
    return np.multiply(power_hp, WATT_PER_HORSEPOWER)[()]


@dataclass(frozen=True)
class Material:
    """Isotropic linear elastic material of the face-gear body.

    Parameters
    ----------
    density : float
        ρ [kg/m³], from 100 to 30000.
    youngs_modulus : float
        E [Pa], from 1e8 to 2e12.
    poissons_ratio : float
        ν, from 0 to 0.5.
    viscous_loss_factor : float
        ξ [s], from 0 to 0.01: damping stress over elastic stress rate.
    yield_strength : float
        σ_Y [Pa], from 1e6 to 1e10.

    Raises
    ------
    TypeError, ValueError
        A value is not a number or outside the range named above.
    """

    density: float
    youngs_modulus: float
    poissons_ratio: float
    viscous_loss_factor: float
    yield_strength: float

    def __post_init__(self) -> None:
        within("density", self.density, 100.0, 30e3, "kg/m³")
        within("youngs_modulus", self.youngs_modulus, 1e8, 2e12, "Pa")
        within("poissons_ratio", self.poissons_ratio, 0.0, 0.5)
        within("viscous_loss_factor", self.viscous_loss_factor, 0.0, 0.01, "s")
        within("yield_strength", self.yield_strength, 1e6, 1e10, "Pa")


STEEL = Material(
    density=7840.0,
    youngs_modulus=200e9,
    poissons_ratio=0.3,
    viscous_loss_factor=5e-6,
    yield_strength=439.9e6,
)
"""Table 4.3 of the dissertation."""


@dataclass(frozen=True)
class MeshLoad:
    """Pinion and its bearing as the face gear feels them, dimensionless (4-17 to 4-19).

    Parameters
    ----------
    stiffness : float
        μ, bearing stiffness over the reference stiffness of the disk (4-17), 0 or greater.
    damping : float
        ζ [s], bearing damping over bearing stiffness (4-18), from 0 to 0.01.
    mass : float
        τ, pinion mass over its nominal mass (4-19), 0 or greater.

    Raises
    ------
    TypeError, ValueError
        A value is not a number or outside the range named above.
    """

    stiffness: float
    damping: float
    mass: float

    def __post_init__(self) -> None:
        nonnegative("stiffness", self.stiffness)
        within("damping", self.damping, 0.0, 0.01, "s")
        nonnegative("mass", self.mass)
