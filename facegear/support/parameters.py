"""Checked inputs: what every quantity may be, and units at the edges.

Inside the package everything is in SI units and radians. Every public entry checks what it is given with the
functions below, so that one wrong number ends in one sentence that names the parameter. What they return is a
Python float or int, or an array of float64, and that is what is kept: a NumPy number brings a width of its own, in
which ``np.int8(70) - 1`` still fits and ``np.int8(70) + 70`` does not. A boolean is no number.
"""

import math
from collections.abc import Collection, Mapping
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from facegear.support.types import FloatArray

WATT_PER_HORSEPOWER = 745.69987


def _plain(value: Any) -> Any:
    """Python object of a NumPy scalar, which prints as a number; anything else as it is."""
    return value.item() if isinstance(value, np.generic) else value


def _shown(value: Any, unit: str) -> str:
    return f"{_plain(value)!r} {unit}".rstrip()


# A time span of NumPy passes for an integer (it is registered as one), a boolean of Python is one.
_NO_NUMBERS = (bool, np.bool_, np.timedelta64)


def keep(instance: object, **checked: Any) -> None:
    """Put values that have been checked, and so turned into Python's own, into fields of a frozen dataclass.

    Parameters
    ----------
    instance : dataclass
        The one that is being made, in its ``__post_init__``.
    **checked
        Values by the names of their fields.
    """
    for name, value in checked.items():
        object.__setattr__(instance, name, value)


def designed(words: str, step: str | None = None) -> dict[str, str]:
    """Metadata of a dataclass field that a designer can change by parts of its value.

    Parameters
    ----------
    words : str
        What the field is called in a table of changes.
    step : str, optional
        Of a field that lists places, such as angles, of which the first is where one counts from: dotted attribute of
        the dataclass by whose parts the others are moved.

    Returns
    -------
    dict
        For ``dataclasses.field(metadata=…)``; :func:`facegear.design.changes.possible_changes` reads it.
    """
    return {"designed": words} if step is None else {"designed": words, "step": step}


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
    number = _real(name, value, unit)
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite{_in(unit)}, got {_plain(value)!r}")
    return number


def _real(name: str, value: Any, unit: str) -> float:
    """Value as a float, infinite and undefined ones among them."""
    if type(value) is float:  # as nearly all are
        return value
    if isinstance(value, _NO_NUMBERS) or not isinstance(value, Real):
        raise TypeError(f"{name} must be a real number{_in(unit)}, got {_plain(value)!r}")
    try:
        return float(value)
    except OverflowError:  # an integer of more than 308 digits
        return math.inf


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


def within(
    name: str, value: Any, lowest: float, highest: float, unit: str = "", hint: str | None = None
) -> float:
    """Check that `value` lies in the closed interval [lowest, highest].

    Parameters
    ----------
    name, value, unit
        As in `finite`.
    lowest, highest : float
        Ends of the valid interval, both allowed.
    hint : str, optional
        Appended to the message, for example the likely wrong unit; nothing is guessed then, nor where it is empty.

    Raises
    ------
    TypeError
        As in `finite`.
    ValueError
        Outside the interval, as NaN is, too. A value with a unit that would be valid after multiplying or dividing by
        1000 is named as a likely mistake of units.
    """
    bounded = math.isfinite(highest - lowest)
    number = _real(name, value, unit) if bounded else finite(name, value, unit)
    if lowest <= number <= highest:
        return number
    message = f"{name} must lie in [{lowest:.6g}, {highest:.6g}]{_in(unit)}, got {_shown(value, unit)}"
    for factor in (1e-3, 1e3):
        if unit and hint is None and lowest <= number * factor <= highest:
            hint = f"wrong by a factor of 1000? {name}={number * factor:.6g} would be valid"
    raise ValueError(f"{message} ({hint})" if hint else message)


def angle_within(name: str, value: Any, lowest_deg: float, highest_deg: float) -> float:
    """Check an angle [rad] against limits [degree]; an angle that looks like degrees is named as such."""
    number = _real(name, value, "rad")
    # The limits themselves, however they were converted, are valid.
    slack = 1e-12
    if math.radians(lowest_deg) - slack <= number <= math.radians(highest_deg) + slack:
        return number
    hint = ""
    if lowest_deg <= number <= highest_deg:
        hint = f" (looks like degrees: use math.radians({_plain(value)!r}))"
    raise ValueError(
        f"{name} must lie between {lowest_deg:g}° and {highest_deg:g}°, that is in "
        f"[{math.radians(lowest_deg):.4f}, {math.radians(highest_deg):.4f}] rad, got {_plain(value)!r}{hint}"
    )


def whole_number(name: str, value: Any, which: str = "") -> int:
    """Check that `value` is an integer, of any sign, and return it as an int; `which` goes into the message.

    Raises
    ------
    TypeError
        Not an integer; a float with an integer value is none.
    """
    if isinstance(value, _NO_NUMBERS) or not isinstance(value, Integral):
        raise TypeError(f"{name} must be an integer{which}, got {_plain(value)!r}")
    return int(value)


def integer_at_least(name: str, value: Any, lowest: int) -> int:
    """Check that `value` is a whole number of at least `lowest` and return it as an int.

    Raises
    ------
    TypeError
        Not an integer; a float with an integer value is refused too, since a tooth count is counted.
    ValueError
        Below `lowest`.
    """
    number = whole_number(name, value, f" of at least {lowest}")
    if number < lowest:
        raise ValueError(f"{name} must be at least {lowest}, got {number!r}")
    return number


def integer_within(name: str, value: Any, lowest: int, highest: int) -> int:
    """Check that `value` is a whole number from `lowest` to `highest`; errors as in `integer_at_least`."""
    number = whole_number(name, value, f" from {lowest} to {highest}")
    if not lowest <= number <= highest:
        raise ValueError(f"{name} must be an integer from {lowest} to {highest}, got {number!r}")
    return number


def number_of_workers(name: str, value: Any) -> int:
    """Check a number of workers as joblib takes it: 1 or more, or -1 for all processors, -2 for all but one.

    Raises
    ------
    TypeError, ValueError
        Not an integer, or 0.
    """
    number = whole_number(name, value, ": 1 or more workers, or -1 for all processors")
    if number == 0:
        raise ValueError(f"{name} must be 1 or more workers, or -1 for all processors, got 0")
    return number


def ascending(name: str, values: Any, unit: str = "") -> tuple[float, float]:
    """Check that a range is two positive, ascending numbers, and return them.

    Raises
    ------
    TypeError, ValueError
        Naming what is wrong.
    """
    listed = isinstance(values, list | tuple) or (isinstance(values, np.ndarray) and values.ndim == 1)
    if not listed or len(values) != 2:
        raise ValueError(f"{name} must be two numbers, lowest and highest, got {values!r}")
    low, high = (positive(name, value, unit) for value in values)
    if low >= high:
        raise ValueError(f"{name} must ascend, got {values!r}")
    return low, high


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
        Not numeric, complex, or with a boolean among its entries.
    ValueError
        An entry is NaN or infinite.
    """
    array = _real_array(name, values, unit)
    if not np.isfinite(array).all():
        bad = array[~np.isfinite(array)].flat[0]
        raise ValueError(f"{name} must be finite{_in(unit)}, got an entry {_plain(bad)!r}")
    return array


def _real_array(name: str, values: Any, unit: str = "") -> FloatArray:
    """Values as a new array of float64, infinite and undefined ones among them."""
    if type(values) is np.ndarray and values.dtype == np.float64:  # as nearly all are
        return np.array(values)
    try:
        array = np.asarray(values)
    except ValueError:  # rows of different lengths
        array = np.empty(0, dtype=object)
    mixed = isinstance(values, list | tuple) and _holds_no_number(values)
    if array.dtype.kind not in "iuf" or mixed:
        raise TypeError(f"{name} must be real numbers{_in(unit)}, got {values!r}")
    # What passes the largest double becomes infinite, which is told as such.
    with np.errstate(over="ignore"):
        return array.astype(np.float64)


def _holds_no_number(values: Any) -> bool:
    """Whether lists within lists hold a boolean, which NumPy would take for a number among others."""
    if isinstance(values, list | tuple):
        return any(map(_holds_no_number, values))
    if isinstance(values, np.ndarray):
        return values.dtype.kind in "bm"
    return isinstance(values, _NO_NUMBERS)


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


def _converted(name: str, values: ArrayLike, factor: float) -> Any:
    """Values times a factor, in float64 whatever their own type: a float for a number, else an array."""
    if np.asarray(values).dtype.kind not in "iuf":
        raise TypeError(f"{name} must be real numbers, got {_plain(values)!r}")
    product = np.multiply(values, factor, dtype=np.float64)[()]
    return float(product) if np.ndim(product) == 0 else product


def rad_per_s(speed_rpm: ArrayLike) -> Any:
    """Convert revolutions per minute to rad/s; a number gives a number, an array an array.

    Examples
    --------
    >>> import facegear as fg
    >>> round(fg.rad_per_s(600.0), 4)
    62.8319
    """
    return _converted("speed_rpm", speed_rpm, math.pi / 30.0)


def rpm(speed: ArrayLike) -> Any:
    """Convert rad/s to revolutions per minute; a number gives a number, an array an array.

    Examples
    --------
    >>> import facegear as fg
    >>> round(fg.rpm(62.8319), 2)
    600.0
    """
    return _converted("speed", speed, 30.0 / math.pi)


def watt(power_hp: ArrayLike) -> Any:
    """Convert horsepower (745.69987 W) to watt; a number gives a number, an array an array.

    Examples
    --------
    >>> import facegear as fg
    >>> round(fg.watt(1000.0))
    745700
    """
    return _converted("power_hp", power_hp, WATT_PER_HORSEPOWER)
