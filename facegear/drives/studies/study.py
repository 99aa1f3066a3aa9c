"""What a study is: which numbers a reader may set, within which limits, and how they make a model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from facegear.drives.drive_file import parse_drive
from facegear.drives.drive_text import drive_text
from facegear.floquet.models import Model
from facegear.support.parameters import finite, integer_at_least, keep, one_of, positive
from facegear.support.types import FloatArray

Settings = Mapping[str, Any]
"""Names of controls to their values."""
READING_COLUMNS, READING_ROWS = 60, 40
"""Speeds and values of a map at reading resolution."""
# Speeds begin here, as a part of the highest one: below, tongues are narrower than a column.
_LOWEST = 1 / 20


@dataclass(frozen=True)
class Quantity:
    """A number that the reader sets.

    Attributes
    ----------
    name : str
        Key of the settings.
    label : str
        Symbol and unit as shown.
    lowest, highest, value : float
        Limits, and what it is at first, in the unit shown.
    step : float
        Distance between values that can be set, in the unit shown.
    unit : float
        SI value of the unit shown.
    parameter : str, optional
        The parameter of the model that this number is, as for :func:`facegear.floquet.models.replace_parameter`. One
        that has it can stand on the vertical axis.
    whole : bool
        Whether it counts something.
    when : tuple of str, optional
        Name of a choice and the options of it under which the number matters; always if left out.
    why : str
        Why the limits are what they are, where a reader may ask.
    """

    name: str
    label: str
    lowest: float
    highest: float
    value: float
    step: float
    unit: float = 1.0
    parameter: str | None = None
    whole: bool = False
    when: tuple[str, ...] = ()
    why: str = ""

    def __post_init__(self) -> None:
        for end in ("lowest", "highest", "value"):
            keep(self, **{end: finite(f"{end} of {self.name}", getattr(self, end))})
        if not self.lowest < self.highest or not self.lowest <= self.value <= self.highest:
            raise ValueError(
                f"value of {self.name} must lie between lowest={self.lowest!r} and highest={self.highest!r}, "
                f"got {self.value!r}"
            )
        keep(
            self,
            step=positive(f"step of {self.name}", self.step),
            unit=positive(f"unit of {self.name}", self.unit),
        )

    def matters(self, settings: Settings) -> bool:
        """Whether the number changes anything under these settings."""
        return not self.when or settings[self.when[0]] in self.when[1:]

    def si(self, value: float) -> float | int:
        """Turn a value shown into SI units, a whole one into an int."""
        number = finite(self.name, value)
        if not self.whole:
            return number * self.unit
        if not number.is_integer():
            raise ValueError(f"{self.name} must be a whole number, got {value!r}")
        return int(number)


@dataclass(frozen=True)
class Choice:
    """One of several that the reader picks.

    Attributes
    ----------
    name : str
        Key of the settings.
    label : str
        As shown.
    options : tuple of str
    value : str
        The one picked at first.
    """

    name: str
    label: str
    options: tuple[str, ...]
    value: str

    def __post_init__(self) -> None:
        if self.value not in self.options:
            raise ValueError(f"value of {self.name} must be one of {self.options}, got {self.value!r}")


Control = Quantity | Choice


@dataclass(frozen=True)
class Study:
    """What is explored: controls, the axes of the map, and the model they make.

    Attributes
    ----------
    controls : tuple of Quantity or Choice
        At least one quantity with a `parameter`.
    build : callable
        Settings in SI units, that of `speed` among them, to a model. Refuses what is impossible with a TypeError,
        ValueError or ArithmeticError whose message a reader can understand.
    vertical : str
        Name of the quantity on the vertical axis at first.
    speed : Quantity
        The highest speed on the horizontal axis; its label is that of the axis.
    columns, rows : int
        Speeds and values of the map, at least 2.
    content : callable, optional
        Settings in SI units to what a drive file says that means the same, keys and values by section; None where
        there is no such file.
    """

    controls: tuple[Control, ...]
    build: Callable[[Settings], Model]
    vertical: str
    speed: Quantity
    columns: int = READING_COLUMNS
    rows: int = READING_ROWS
    content: Callable[[Settings], Mapping[str, Any]] | None = None

    def __post_init__(self) -> None:
        names = [control.name for control in (*self.controls, self.speed)]
        if len(set(names)) < len(names):
            raise ValueError(f"controls must have names that differ, got {names}")
        self.swept(self.vertical)
        keep(
            self,
            columns=integer_at_least("columns", self.columns, 2),
            rows=integer_at_least("rows", self.rows, 2),
        )

    @property
    def sweepable(self) -> tuple[Quantity, ...]:
        """Quantities that can stand on the vertical axis."""
        return tuple(c for c in self.controls if isinstance(c, Quantity) and c.parameter is not None)

    def swept(self, name: str) -> Quantity:
        """Find the quantity of a name that can stand on the vertical axis."""
        for quantity in self.sweepable:
            if quantity.name == name:
                return quantity
        raise ValueError(f"vertical must be one of {[q.name for q in self.sweepable]}, got {name!r}")

    def settings(self, changes: Settings | None = None) -> dict[str, Any]:
        """Values as shown: the first ones, with changes.

        Raises
        ------
        ValueError
            For a change of something that is no control.
        """
        first = {control.name: control.value for control in (*self.controls, self.speed)}
        unknown = sorted(set(changes or {}) - set(first))
        if unknown:
            raise ValueError(f"settings must be among {', '.join(first)}, got {', '.join(unknown)}")
        return first | dict(changes or {})

    def model(self, settings: Settings) -> Model:
        """Build the model of settings as shown.

        Raises
        ------
        TypeError, ValueError, ArithmeticError
            If they do not go together.
        """
        return self.build(self._in_si(settings))

    def drive_text(self, settings: Settings) -> str:
        """Text of the drive file that means the same as settings as shown.

        Raises
        ------
        ValueError
            If there is no such file, or no valid one.
        """
        if self.content is None:
            raise ValueError("settings must be those of a drive to be written as a drive file")
        text = drive_text(self.content(self._in_si(settings)))
        parse_drive(text, "these settings")
        return text

    def _in_si(self, settings: Settings) -> dict[str, Any]:
        for control in self.controls:
            if isinstance(control, Choice):
                one_of(control.name, settings[control.name], control.options)
        return {
            control.name: (
                control.si(settings[control.name])
                if isinstance(control, Quantity)
                else settings[control.name]
            )
            for control in (*self.controls, self.speed)
        }

    def axes(self, settings: Settings, vertical: str) -> tuple[FloatArray, FloatArray]:
        """Speeds [rad/s] and values [SI] of a map.

        Parameters
        ----------
        settings : mapping
            As shown.
        vertical : str
            Name of the quantity on the vertical axis.

        Returns
        -------
        speeds : ndarray, shape (columns,)
            From a twentieth of the highest speed.
        values : ndarray, shape (rows,)
            Over the whole range of the quantity.
        """
        highest = float(self.speed.si(settings[self.speed.name]))
        quantity = self.swept(vertical)
        values = np.linspace(quantity.lowest, quantity.highest, self.rows) * quantity.unit
        return np.linspace(_LOWEST * highest, highest, self.columns), values


def shown_only(study: Study, names: Sequence[str]) -> Study:
    """Return the study with some of its controls, in the order given; the others keep their first values.

    Parameters
    ----------
    study : Study
    names : sequence of str
        Names of controls.

    Raises
    ------
    ValueError
        For a name that is no control, or if what is on the vertical axis is not among them.
    """
    known = {control.name: control for control in study.controls}
    missing = [name for name in names if name not in known]
    if missing:
        raise ValueError(f"names must be among {', '.join(known)}, got {', '.join(missing)}")
    hidden = {
        name: control.si(control.value) if isinstance(control, Quantity) else control.value
        for name, control in known.items()
        if name not in names
    }

    def build(settings: Settings) -> Model:
        return study.build(hidden | dict(settings))

    content = study.content

    def said(settings: Settings) -> Mapping[str, Any]:
        assert content is not None
        return content(hidden | dict(settings))

    return replace(
        study,
        controls=tuple(known[name] for name in names),
        build=build,
        content=None if content is None else said,
    )
