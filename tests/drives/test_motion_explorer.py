"""The explorer of a gearbox with play without a browser: what its sliders do."""

import re
from dataclasses import replace

import numpy as np
import pytest

from facegear.drives import motion_explorer
from facegear.drives.play import Motion
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.torsional import Torsional

PLAY = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)


def text(html):
    return re.sub(r"<[^>]+>", "", html.value)


@pytest.fixture(scope="module")
def widget():
    return motion_explorer.MotionExplorer(PLAY, 640.0)


def test_a_slider_follows_another_motion(widget):
    assert "640 rpm" in text(widget.report)
    assert "repeats every 2 periods, flanks part" in text(widget.report)
    drawn = widget.picture.value
    widget.controls["speed"].value = 700.0
    assert "repeats each period, stays pressed" in text(widget.report)
    assert "data:image/png" in widget.picture.value != drawn


def test_damping_and_torque_are_those_of_the_sliders(widget):
    """With twice the torque and twice the gap, teeth are pressed in twice as far."""
    widget.controls["speed"].value = 700.0
    size = float(re.search(r"by up to ([0-9.]+)", text(widget.report))[1])
    widget.controls["gap"].value, widget.controls["torque"].value = 200.0, 1600.0
    assert float(re.search(r"by up to ([0-9.]+)", text(widget.report))[1]) == pytest.approx(
        2 * size, rel=1e-3
    )


def test_a_start_beyond_a_slider_is_refused():
    with pytest.raises(
        ValueError, match=r"backlash \[µm\] must lie between 1 and 500 for its slider, got 900"
    ):
        motion_explorer.MotionExplorer(replace(PLAY, gap=9e-4), 640.0)


@pytest.mark.parametrize(
    "wrong", [None, PLAY.torsional, replace(PLAY, torsional=Torsional(PLAY.torsional.gearbox.in_si))]
)
def test_what_is_no_gearbox_in_multiples_is_refused(wrong):
    with pytest.raises(
        TypeError, match="play must be a Backlash of a gearbox in multiples of its mesh stiffness"
    ):
        motion_explorer.MotionExplorer(wrong, 640.0)


def test_motions_that_do_not_repeat_are_drawn_where_periods_begin_and_growing_ones_not():
    irregular = Motion(3e-5, "irregular", None, np.full((24, 6), 1e-6))
    assert motion_explorer.motion_figure(PLAY, irregular).axes[0].get_xlabel() == (
        "mesh deformation as periods begin [µm]"
    )
    growing = Motion(np.inf, "grows beyond a thousand times", None, np.full((24, 6), np.nan))
    assert motion_explorer.motion_figure(PLAY, growing) is None
    assert motion_explorer.told(growing, 640.0).endswith("under the torque: grows beyond a thousand times.")
