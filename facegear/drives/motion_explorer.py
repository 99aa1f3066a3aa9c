"""The live explorer of a gearbox with play: speed, torque and gap, and the motion that it ends in from rest."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from typing import Any

import ipywidgets
import numpy as np
from matplotlib.figure import Figure

from facegear.drives.play import Motion, motion_arrays, motion_from_rest
from facegear.floquet.models import replace_parameter, value_of
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import ProportionalGearbox
from facegear.plotting.interactive import image
from facegear.plotting.motions import motions
from facegear.plotting.style import FAINT, INK, VERMILION, panels, styled
from facegear.support.kinds import named
from facegear.support.parameters import finite, rad_per_s

_POINTS = 401
_REFUSALS = (TypeError, ValueError, ArithmeticError)


@styled
def _as_periods_begin(play: Backlash, motion: Motion) -> Figure:
    """Draw a motion that does not repeat itself where mesh periods begin, in the phase plane."""
    figure, (plane,) = panels(height=3.6)
    n = motion.ends.shape[1] // 2
    size, rate = (play.torsional.deformation(part) for part in (motion.ends[:, :n], motion.ends[:, n:]))
    plane.plot(1e6 * size, 1e3 * rate, "o", color=VERMILION, markersize=4)
    plane.axvspan(-5e5 * play.gap, 5e5 * play.gap, color=FAINT, linewidth=0)
    plane.set(xlabel="mesh deformation as periods begin [µm]", ylabel="its rate [mm/s]")
    return figure


def motion_figure(play: Backlash, motion: Motion) -> Figure | None:
    """Draw where a gearbox with play ends, None where it ends nowhere.

    Parameters
    ----------
    play : Backlash
    motion : Motion
        From :func:`facegear.drives.play.motion_from_rest`.
    """
    if motion.orbit is not None:
        return motions(motion_arrays(play, [motion.orbit], _POINTS), play.gap)
    return _as_periods_begin(play, motion) if np.isfinite(motion.compression) else None


def told(motion: Motion, speed_rpm: float) -> str:
    """Say what the motion at a speed [rpm] is, and how far it presses the teeth."""
    size = (
        f"; teeth are pressed in by up to {1e6 * motion.compression:.4g} µm"
        if np.isfinite(motion.compression)
        else ""
    )
    return f"At {speed_rpm:.4g} rpm of the face gear, from rest under the torque: {motion.words}{size}."


class MotionExplorer:
    """Sliders for speed, torque, gap and mesh damping; the motion over time and in the phase plane.

    Parameters
    ----------
    play : Backlash
        Where the sliders stand at first. Its gearbox is a
        :class:`facegear.mechanics.gearboxes.ProportionalGearbox`, whose damping is a time.
    speed_rpm : float
        Of the face gear at first, 100 to 1000.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind, or a value lies outside the range of its slider.
    """

    def __init__(self, play: Backlash, speed_rpm: float) -> None:
        if not isinstance(play, Backlash) or not isinstance(play.torsional.gearbox, ProportionalGearbox):
            raise TypeError(
                "play must be a Backlash of a gearbox in multiples of its mesh stiffness, a ProportionalGearbox, got "
                f"{named(play)}"
            )
        speed_rpm = finite("speed_rpm", speed_rpm, "rpm")
        self._play = play
        damping = value_of(play.torsional, "mesh_damping")
        self.controls = {
            "speed": _slider("speed of the face gear [rpm]", 100.0, 1000.0, 1.0, speed_rpm),
            "torque": _slider("torque of the load [N m]", 50.0, 5000.0, 50.0, play.torque),
            "gap": _slider("backlash [µm]", 1.0, 500.0, 1.0, 1e6 * play.gap),
            "mesh_damping": _slider("mesh damping c_m/k_m [µs]", 0.5, 100.0, 0.5, 1e6 * damping),
        }
        self.report, self.picture = ipywidgets.HTML(), ipywidgets.HTML()
        self.widget = ipywidgets.VBox([*self.controls.values(), self.report, self.picture])
        for control in self.controls.values():
            control.observe(lambda _: self.refresh(), "value")
        self.refresh()

    def _repr_mimebundle_(self, **options: Any) -> Any:
        return self.widget._repr_mimebundle_(**options)

    def refresh(self) -> None:
        """Follow the motion for what the sliders say, or say why there is none."""
        speed, torque, gap, damping = (float(control.value) for control in self.controls.values())
        try:
            gearbox = replace_parameter(self._play.torsional, "mesh_damping", 1e-6 * damping)
            play = replace(self._play, torsional=gearbox, torque=torque, gap=1e-6 * gap)
            motion = motion_from_rest(play, float(rad_per_s(speed)))
        except _REFUSALS as problem:
            self._say(f"Not possible: {problem}.")
            self.picture.value = ""
            return
        self._say(told(motion, speed))
        figure = motion_figure(play, motion)
        self.picture.value = "" if figure is None else image(figure, told(motion, speed))

    def _say(self, words: str) -> None:
        self.report.value = f'<p style="color:{INK};line-height:1.4;white-space:normal">{escape(words)}</p>'


def _slider(label: str, lowest: float, highest: float, step: float, value: float) -> Any:
    if not lowest <= value <= highest:
        raise ValueError(
            f"{label} must lie between {lowest:g} and {highest:g} for its slider, got {value:.6g}"
        )
    return ipywidgets.FloatSlider(
        value,
        min=lowest,
        max=highest,
        step=step,
        description=label,
        continuous_update=False,
        readout_format=".1f" if step < 1.0 else ".0f",
        layout=ipywidgets.Layout(width="min(36rem, 98%)"),
        style={"description_width": "15rem"},
    )
