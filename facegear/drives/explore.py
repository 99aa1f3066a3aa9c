"""What the live explorer computes: a map at reading resolution in steps, and one cell of it in detail.

A :class:`Study` says which numbers the reader may set, within which limits, and how they make a model. Everything
here works without a screen; :mod:`facegear.drives.explorer` puts controls and figures on it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from facegear.drives.cell import UNSTABLE, CellDetail, cell_detail
from facegear.drives.drive_file import parse_drive
from facegear.drives.drive_text import drive_text
from facegear.floquet.models import Model, replace_parameter
from facegear.maps.stability_map import stability_map
from facegear.support.parameters import finite, integer_at_least, keep, one_of, positive
from facegear.support.types import FloatArray

Settings = Mapping[str, Any]
"""Names of controls to their values."""

READING_COLUMNS, READING_ROWS = 60, 40
"""Speeds and values of a map at reading resolution."""

# Speeds begin here, as a part of the highest one: below, tongues are narrower than a column.
_LOWEST = 1 / 20
# Cells of the first stage lie this many columns and rows apart, and slow maps are filled so many rows at a time: a row
# takes little longer than a few cells of it.
_COLUMN_STEP, _ROW_STEP, _SLOW_ROWS = 3, 5, 8


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


def map_stages(
    model: Model, speeds: FloatArray, parameter: str, values: FloatArray
) -> Iterator[xr.DataArray]:
    """Compute a stability map in steps, coarse at first.

    Parameters
    ----------
    model : Model
    speeds : ndarray, shape (S,)
        Ascending [rad/s].
    parameter : str
        As for :func:`facegear.maps.stability_map.stability_map`.
    values : ndarray, shape (V,)

    Yields
    ------
    xarray.DataArray, shape (V, S)
        Growth rates [1/s], with the period [s] of each speed as a coordinate. In the first, cells that are not yet
        computed have the value of a neighbour; attribute ``computed`` is the part of the cells that are final.
    """
    columns = np.arange(min(_COLUMN_STEP // 2, speeds.size - 1), speeds.size, _COLUMN_STEP)
    fast = _only_loads_change(model, float(speeds[-1]), parameter, values)
    step = 1 if fast else _ROW_STEP
    rows = np.arange(min(step // 2, values.size - 1), values.size, step)
    coarse = _chart(model, speeds[columns], parameter, values[rows])
    growth = coarse.values[_nearest(values.size, rows)][:, _nearest(speeds.size, columns)]
    periods = _periods(model, speeds)

    def stage(computed: float) -> xr.DataArray:
        return _labelled(coarse.dims[0], values, speeds, growth.copy(), periods, computed)

    yield stage(columns.size / speeds.size if fast else 0.0)
    if fast:
        missing = np.setdiff1d(np.arange(speeds.size), columns)
        if missing.size:
            growth[:, missing] = _chart(model, speeds[missing], parameter, values).values
            yield stage(1.0)
        return
    for start in range(0, values.size, _SLOW_ROWS):
        part = slice(start, min(start + _SLOW_ROWS, values.size))
        growth[part] = _chart(model, speeds, parameter, values[part]).values
        yield stage(part.stop / values.size)


def reading_map(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> xr.DataArray:
    """Return the last stage of :func:`map_stages` without those before it."""
    chart = _chart(model, speeds, parameter, values)
    return _labelled(chart.dims[0], values, speeds, chart.values, _periods(model, speeds), 1.0)


def _periods(model: Model, speeds: FloatArray) -> FloatArray:
    return np.array([model.system(float(speed)).period for speed in speeds])


def _labelled(
    name: Hashable,
    values: FloatArray,
    speeds: FloatArray,
    growth: FloatArray,
    periods: FloatArray,
    computed: float,
) -> xr.DataArray:
    return xr.DataArray(
        growth,
        dims=(name, "speed"),
        coords={name: values, "speed": speeds, "period": ("speed", periods)},
        name="growth_rate",
        attrs={"units": "1/s", "computed": computed},
    )


def _chart(model: Model, speeds: FloatArray, parameter: str, values: FloatArray) -> xr.DataArray:
    # One worker: starting others would take longer than the map.
    return stability_map(model, speeds, parameter, values, jobs=1, progress=False)


def _nearest(size: int, chosen: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.asarray(np.abs(np.arange(size)[:, np.newaxis] - chosen).argmin(axis=1))


def _only_loads_change(model: Model, speed: float, parameter: str, values: FloatArray) -> bool:
    """Whether the constant matrices and the shape vectors stay along a column, which makes it fast."""
    one, other = (replace_parameter(model, parameter, float(v)).system(speed) for v in values[[0, -1]])
    return all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("mass", "damping", "stiffness")
    ) and all(
        np.array_equal(a.shape.coefficients, b.shape.coefficients)
        for a, b in zip(one.loads, other.loads, strict=True)
    )


def unstable(chart: xr.DataArray) -> NDArray[np.bool_]:
    """Find the cells of a map whose growth in a period is more than rounding, shape (V, S)."""
    return np.asarray(np.expm1(chart.values * chart["period"].values) > UNSTABLE)


@dataclass(frozen=True, eq=False)
class View:
    """A map and one cell of it, as the explorer shows them.

    Attributes
    ----------
    study : Study
    settings : mapping
        As shown.
    vertical : Quantity
        On the vertical axis.
    chart : xarray.DataArray
        From :func:`reading_map`.
    value : float
        Of the vertical quantity in the cell [SI].
    detail : CellDetail
    """

    study: Study
    settings: Settings
    vertical: Quantity
    chart: xr.DataArray
    value: float
    detail: CellDetail


def view(
    study: Study, speed: float, value: float, vertical: str | None = None, changes: Settings | None = None
) -> View:
    """Compute what the explorer shows when the reader has clicked on a cell.

    Parameters
    ----------
    study : Study
    speed, value : float
        Of the cell, as shown on the axes.
    vertical : str, optional
        Name of the quantity on the vertical axis; that of the study if left out.
    changes : mapping, optional
        Settings that differ from the first ones, as shown.

    Returns
    -------
    View

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As the study refuses settings.
    """
    settings = study.settings(changes)
    quantity = study.swept(study.vertical if vertical is None else vertical)
    assert quantity.parameter is not None
    model = study.model(settings)
    speeds, values = study.axes(settings, quantity.name)
    chart = reading_map(model, speeds, quantity.parameter, values)
    chosen = float(quantity.si(value))
    detail = cell_detail(replace_parameter(model, quantity.parameter, chosen), speed * study.speed.unit)
    return View(study, settings, quantity, chart, chosen, detail)


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
