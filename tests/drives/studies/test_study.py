"""What a study is: axes, controls that are shown, descriptions that go together."""

from dataclasses import replace

import numpy as np
import pytest

from facegear.drives.cell import cell_detail
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.study import Choice, Quantity, Study, shown_only
from facegear.mechanics import cases
from facegear.mechanics.classical import Meissner
from facegear.mechanics.properties import MeshLoad
from facegear.support.parameters import rad_per_s


def test_axes_are_in_si_units_and_cover_the_range():
    study = replace(drive_study(), columns=5, rows=3)
    speeds, values = study.axes(study.settings({"highest_speed": 600.0}), "damping")
    assert speeds == pytest.approx(rad_per_s(np.linspace(30.0, 600.0, 5)))
    assert values == pytest.approx([0.0, 1e-4, 2e-4])


def test_controls_that_are_not_shown_keep_their_values():
    study = shown_only(drive_study(), ["mass", "stiffness"])
    assert [control.name for control in study.controls] == ["mass", "stiffness"]
    model = study.model(study.settings({"mass": 0.5}))
    assert model.load == MeshLoad(1.0, 3e-6, 0.5)
    assert model.body == cases.CASE_1


SQUARE = Meissner(depth=0.6, duty=0.4)
SPEED = Quantity("highest_speed", "speed", 1.0, 5.0, 2.6, 0.1)
DEPTH = Quantity("depth", "depth", 0.0, 0.9, 0.4, 0.1, parameter="depth")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: Quantity("depth", "depth", 0.0, 0.9, 1.4, 0.1), "value of depth must lie between"),
        (lambda: Quantity("depth", "depth", 0.0, 0.9, 0.4, 0.0), "step of depth must be greater than 0"),
        (lambda: Choice("wave", "wave", ("a", "b"), "c"), "value of wave must be one of"),
        (lambda: Study((DEPTH, DEPTH), lambda s: SQUARE, "depth", SPEED), "names that differ"),
        (lambda: Study((DEPTH,), lambda s: SQUARE, "duty", SPEED), "vertical must be one of"),
        (lambda: drive_study().settings({"teeth": 3}), "settings must be among .*, got teeth"),
        (lambda: shown_only(drive_study(), ["teeth"]), "names must be among .*, got teeth"),
        (lambda: shown_only(drive_study(), ["mass"]), "vertical must be one of"),
        (
            lambda: drive_study().model(drive_study().settings({"pinion_teeth": 26.5})),
            "whole number",
        ),
        (lambda: cell_detail(SQUARE, -1.0), "speed must be greater than 0"),
        (lambda: replace(drive_study(), columns=1), "columns must be at least 2"),
    ],
)
def test_wrong_descriptions_are_refused(wrong, message):
    with pytest.raises(ValueError, match=message):
        wrong()
