"""What maps need of a model: a system at each speed, names of its coordinates, and a copy with one parameter replaced.

A model is a frozen dataclass with a method ``system(speed)`` and a property ``coordinates``. Its parameters are its
own numbers and those of the dataclasses it holds: ``stiffness`` of a transverse model is that of its mesh load,
``thickness_ratio`` that of its body. Whatever is such a dataclass goes through maps, tongues, labels, cell details,
sensitivities, reports and explorers; none of them asks for its class.
"""

from __future__ import annotations

import dataclasses
import difflib
from dataclasses import dataclass
from functools import cache
from numbers import Real
from typing import Any, Protocol, TypeVar, get_args, get_type_hints

from numpy.typing import ArrayLike

from facegear.floquet.periodic import PeriodicSystem, require_system
from facegear.support.kinds import named
from facegear.support.types import FloatArray


class Surface(Protocol):
    """One shape of a disk, for drawing what a coordinate does to it."""

    @property
    def inner_radius(self) -> float:
        """Radius of the inner edge [m]."""
        ...

    @property
    def outer_radius(self) -> float:
        """Radius of the outer edge [m]."""
        ...

    def deflection(self, radius: ArrayLike, angle: ArrayLike) -> FloatArray:
        """Deflection at r [m] and θ [rad], broadcast against each other, for a unit of the coordinate."""
        ...


@dataclass(frozen=True)
class Coordinate:
    """One generalised coordinate of a model: what it is called, and where it is.

    Attributes
    ----------
    name : str
        Such as "pinion", or "1 circle, 2 diameters, cos".
    unit : str
        Of the coordinate, such as "rad".
    part : str
        What moves, such as "face gear"; coordinates of the same part with surfaces make one deflection.
    surface : Surface, optional
        The shape that a unit of the coordinate gives a disk; None for the motion of a rigid body, drawn over time.
    """

    name: str
    unit: str
    part: str = ""
    surface: Surface | None = None


class Model(Protocol):
    """Anything with a periodic system at each speed [rad/s] and names for its coordinates."""

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Generalised coordinates, in the order of all matrices and shape vectors."""
        ...

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion at a constant speed [rad/s]."""
        ...


ModelT = TypeVar("ModelT", bound=Model)


def require_model(model: object) -> None:
    """Refuse what is no model, such as a system at one speed or a part of a model.

    Raises
    ------
    TypeError
        Saying what it is.
    """
    if isinstance(model, type) or not callable(getattr(model, "system", None)):
        raise TypeError(
            f"model must have a method system(speed), as fg.Transverse(body, load) has, got {named(model)}"
        )


def system_at(model: Model, speed: float) -> PeriodicSystem:
    """Return the system of a model at a speed [rad/s], and refuse one that returns something else.

    Raises
    ------
    TypeError
        Saying what it is.
    """
    system = model.system(speed)
    require_system(system, "what model.system(speed) returns")
    return system


def parameter_names(model: object) -> tuple[str, ...]:
    """Dotted names of the numbers a model is made of, its own first, then those of the dataclasses it holds.

    Parameters
    ----------
    model : dataclass
        For example :class:`facegear.mechanics.transverse.Transverse`.

    Returns
    -------
    tuple of str
        Such as ``"load.stiffness"``, ``"body.thickness_ratio"``, ``"body.drive.pinion_teeth"``.
    """
    found: list[str] = []
    level: list[tuple[str, Any]] = [("", model)]
    while level:
        below: list[tuple[str, Any]] = []
        for prefix, part in level:
            for field in dataclasses.fields(part) if is_part(part) else ():
                value = getattr(part, field.name)
                if is_part(value):
                    below.append((f"{prefix}{field.name}.", value))
                elif field.init and (_is_number(value) or _takes_number(part, field.name)):
                    found.append(prefix + field.name)
        level = below
    return tuple(found)


def parameter_path(model: object, name: str) -> tuple[str, ...]:
    """Path of field names that lead to a parameter.

    Parameters
    ----------
    model : dataclass
    name : str
        Name of a field, or a dotted name where the same one occurs twice. Of equal names the one nearest to the
        model is meant, if there is only one there.

    Raises
    ------
    TypeError
        If the model is not a dataclass.
    ValueError
        If there is no such parameter, naming those that exist, or if several are equally near.
    """
    if not is_part(model):
        raise TypeError(f"model must be a dataclass with a method system(speed), got {type(model).__name__}")
    names = parameter_names(model)
    if name in names:
        return tuple(name.split("."))
    matches = [other for other in names if other.endswith(f".{name}")]
    nearest = min((other.count(".") for other in matches), default=0)
    matches = [other for other in matches if other.count(".") == nearest]
    if not matches:
        last = {other.rpartition(".")[2]: other for other in reversed(names)}
        near = difflib.get_close_matches(str(name).rpartition(".")[2], last, n=3)
        meant = f"; {' or '.join(sorted(last[word] for word in near))}?" if near else ""
        raise ValueError(
            f"parameter must be one of {', '.join(names)} (the last part is enough), got {name!r}{meant}"
        )
    if len(matches) > 1:
        raise ValueError(f"parameter {name!r} could be {' or '.join(matches)}: give the dotted name")
    return tuple(matches[0].split("."))


def replace_parameter(model: ModelT, name: str, value: float) -> ModelT:
    """Return the model with one of its parameters replaced.

    Parameters
    ----------
    model : dataclass with a method ``system``
    name : str
        As for :func:`parameter_path`.
    value : float
        New value, in the unit of the field. A field declared as ``int``, or as that or None, takes whole numbers only.

    Raises
    ------
    TypeError, ValueError
        From :func:`parameter_path`, or from the model's own check of the value.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=1.0, damping=3e-6, mass=1.0))
    >>> fg.replace_parameter(model, "thickness_ratio", 0.05).body.thickness_ratio
    0.05
    """
    replaced: ModelT = replace_at(model, parameter_path(model, name), value)
    return replaced


def value_of(model: object, name: str) -> float:
    """Present value of a parameter of a model, named as for :func:`parameter_path`.

    Raises
    ------
    TypeError, ValueError
        From :func:`parameter_path`, or if the parameter is optional and not given.
    """
    part: Any = model
    for field in parameter_path(model, name):
        part = getattr(part, field)
    if part is None:
        raise ValueError(f"{name} is None, the model's default: give it a number to start from")
    return float(part)


def is_whole_number(model: object, name: str) -> bool:
    """Whether a parameter counts something, as teeth: its field is declared as ``int``, or as that or None."""
    *outer, last = parameter_path(model, name)
    part: Any = model
    for field in outer:
        part = getattr(part, field)
    return _counts(part, last)


def replace_at(part: Any, path: tuple[str, ...], value: Any) -> Any:
    """Return a dataclass with the parameter at the end of a path of fields replaced.

    Parameters
    ----------
    part : dataclass
    path : tuple of str
        From :func:`parameter_path`.
    value : float
        As for :func:`replace_parameter`.
    """
    name, rest = path[0], path[1:]
    if rest:
        return dataclasses.replace(part, **{name: replace_at(getattr(part, name), rest, value)})
    # Text and booleans are left to the part's own check, which names them.
    if _counts(part, name) and _is_number(value) and float(value).is_integer():
        return dataclasses.replace(part, **{name: int(value)})
    return dataclasses.replace(part, **{name: value})


def is_part(value: Any) -> bool:
    """Whether a value is a dataclass whose fields are parameters of the model that holds it."""
    return dataclasses.is_dataclass(value) and not isinstance(value, type)


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _takes_number(part: Any, name: str) -> bool:
    """Whether an optional field that is None now is declared to take a number."""
    return getattr(part, name) is None and float in get_args(_declared(part).get(name))


def _counts(part: object, name: str) -> bool:
    """Whether a field is declared to take whole numbers only."""
    declared = _declared(part).get(name)
    return declared is int or (int in get_args(declared) and float not in get_args(declared))


def _declared(part: object) -> dict[str, Any]:
    """Return declared types of the fields of a dataclass."""
    kind: Any = type(part)
    return _type_hints(kind)


# Resolving annotations takes longer than anything else here.
_type_hints = cache(get_type_hints)
