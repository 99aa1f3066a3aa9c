"""Widgets of the explorer: what a control of a study looks like, and lines of text beside it."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import ipywidgets

from facegear.drives.studies.study import Choice, Control, Quantity
from facegear.plotting.style import GREY, INK, VERMILION


def look(label: str = "17rem") -> dict[str, Any]:
    """Width of a widget and of its label."""
    return {
        "layout": ipywidgets.Layout(width="98%"),
        "style": {"description_width": label},
    }


def menu_of(label: str, options: Sequence[Any], value: Any) -> Any:
    """Return a menu, with a label short enough that its options are not cut."""
    return ipywidgets.Dropdown(options=options, value=value, description=label, **look("10rem"))


def widget_of(control: Control) -> Any:
    """Return the menu or slider of a control. A slider shows no number: :func:`entry_of` does, and takes any."""
    if isinstance(control, Choice):
        return menu_of(control.label, control.options, control.value)
    limits = {"min": control.lowest, "max": control.highest, "step": control.step, "value": control.value}
    kind = ipywidgets.IntSlider if control.whole else ipywidgets.FloatSlider
    if control.whole:
        limits = {name: int(number) for name, number in limits.items()}
    shape = {"layout": ipywidgets.Layout(flex="1 1 auto", width="auto"), "style": look()["style"]}
    return kind(**limits, description=control.label, continuous_update=False, readout=False, **shape)


def entry_of(quantity: Quantity) -> Any:
    """Return the field beside a slider, with its number in all digits."""
    return ipywidgets.Text(
        value=shown(quantity.value),
        placeholder=quantity.label,
        continuous_update=False,
        layout=ipywidgets.Layout(width="6rem", flex="0 0 auto"),
    )


def shown(value: float) -> str:
    """Write a number of a slider in the digits it has."""
    return f"{value:.10g}"


def typed(quantity: Quantity, text: str) -> float | int:
    """Read what was typed into a field.

    Raises
    ------
    ValueError
        If it is no number, or not one that the quantity can have here.

    Examples
    --------
    >>> module = Quantity("module", "module [mm]", 1.0, 8.0, 3.175, 0.025)
    >>> typed(module, "4.25")
    4.25
    >>> typed(module, "0")
    Traceback (most recent call last):
    ValueError: module [mm] must lie between 1 and 8 here, got 0
    """
    try:
        number = float(text)
    except ValueError:
        raise ValueError(f"{quantity.label} must be a number, got {text!r}") from None
    if not quantity.lowest <= number <= quantity.highest:
        ends = f"{shown(quantity.lowest)} and {shown(quantity.highest)}"
        why = f": {quantity.why}" if quantity.why else ""
        raise ValueError(f"{quantity.label} must lie between {ends} here, got {text}{why}")
    if not quantity.whole:
        return number
    if not number.is_integer():
        raise ValueError(f"{quantity.label} must be a whole number, got {text}")
    return int(number)


#: Class of what still shows the settings before the last change.
BEHIND = "facegear-behind"
# Labels of controls are cut at the end by default, where symbol and unit stand; on a narrow page controls stand below
# theirs.
WHOLE_LABELS = """<style>
.facegear-explorer .widget-label {
  white-space: normal; overflow: visible; height: auto; line-height: 1.25; align-self: center;
}
.facegear-behind {opacity: 0.35}
@media (max-width: 40rem) {
  .facegear-explorer :is(.widget-dropdown, .widget-slider, .widget-text) {flex-wrap: wrap; height: auto}
  .facegear-explorer :is(.widget-dropdown, .widget-slider, .widget-text) > .widget-label {
    flex: 0 0 100%; width: 100% !important; text-align: left;
  }
  .facegear-explorer select {height: 2rem}
  .facegear-explorer .slider-container {height: 1.4rem; margin-top: 0.8rem; min-width: 8rem}
}
</style>"""


def small(text: str) -> str:
    """HTML of how far something is."""
    return f'<p class="facegear-status" style="color:{GREY}">{escape(text)}</p>'


def said(text: str) -> str:
    """HTML of what became of something."""
    return f'<p role="status" style="line-height:1.4;white-space:normal">{escape(text)}</p>'


def refused(problem: Exception) -> str:
    """HTML of why the settings of the controls are not possible."""
    return (
        f'<p role="alert" style="color:{INK};border-left:4px solid {VERMILION};padding:0 0.6em;'
        f'line-height:1.4;white-space:normal"><b>Not possible:</b> {escape(_of_settings(problem))}. '
        "The map still shows the last settings that were.</p>"
    )


def _of_settings(problem: Exception) -> str:
    """Words of a refusal; that it is of the settings, as a file would say of itself, is said already."""
    return str(problem).removeprefix("these settings: ")
