"""Widgets of the explorer: what a control of a study looks like, and lines of text beside it."""

from __future__ import annotations

from decimal import Decimal
from html import escape
from typing import Any

import ipywidgets

from facegear.drives.studies.study import Choice, Control
from facegear.plotting.style import GREY, INK, VERMILION


def look() -> dict[str, Any]:
    """Width of a widget and of its label."""
    return {
        "layout": ipywidgets.Layout(width="98%"),
        "style": {"description_width": "17rem"},
    }


def widget_of(control: Control) -> Any:
    """Return the menu or slider of a control."""
    if isinstance(control, Choice):
        return ipywidgets.Dropdown(
            options=list(control.options), value=control.value, description=control.label, **look()
        )
    limits = {"min": control.lowest, "max": control.highest, "step": control.step, "value": control.value}
    if control.whole:
        limits = {name: int(number) for name, number in limits.items()}
        return ipywidgets.IntSlider(**limits, description=control.label, continuous_update=False, **look())
    places = max(0, -int(Decimal(str(control.step)).normalize().as_tuple().exponent))
    return ipywidgets.FloatSlider(
        **limits,
        description=control.label,
        readout_format=f".{places}f",
        continuous_update=False,
        **look(),
    )


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
        f'line-height:1.4;white-space:normal"><b>Not possible:</b> {escape(str(problem))}. '
        "The map still shows the last settings that were.</p>"
    )
