"""The study of a drive: where its controls stand, and every setting makes a drive or says why not."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from facegear.drives.explore import reading_map
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.study import Choice
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.mechanics import cases
from facegear.mechanics.spreads import FaceStrip
from tests.drives.studies.models import THREE


@pytest.mark.parametrize("start", [cases.FIGURES["4.5a"].model(), THREE])
def test_controls_of_a_drive_stand_at_first_where_its_model_does(start):
    study = drive_study(start)
    built = study.model(study.settings())
    one, other = (model.system(60.0) for model in (start, built))
    for name in ("damping", "stiffness", "period"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-9)
    assert len(one.loads) == len(other.loads)
    for a, b in zip(one.loads, other.loads, strict=True):
        assert (a.stiffness, a.damping, a.mass) == pytest.approx((b.stiffness, b.damping, b.mass), rel=1e-9)
        assert a.shape(0.3) == pytest.approx(b.shape(0.3), rel=1e-9)


def test_a_force_on_places_that_cannot_be_chosen_is_refused():
    elsewhere = replace(THREE, force=replace(THREE.force, spread=FaceStrip()))
    with pytest.raises(
        ValueError, match=r"force of the model must press on one point of the rim or .*, got FaceStrip"
    ):
        drive_study(elsewhere)


def refusal(study, changes):
    """Return what is said against settings, None if nothing."""
    try:
        study.model(study.settings(changes))
    except (TypeError, ValueError, ArithmeticError) as problem:
        return str(problem)
    return None


@given(st.data())
@settings(max_examples=40)
def test_a_drive_is_made_or_refused_with_a_sentence(data):
    study = drive_study(THREE)
    changes = {}
    for control in study.controls:
        if isinstance(control, Choice):
            changes[control.name] = data.draw(st.sampled_from(control.options))
        elif control.whole:
            changes[control.name] = data.draw(st.integers(int(control.lowest), int(control.highest)))
        else:
            changes[control.name] = data.draw(st.floats(control.lowest, control.highest))
    said = refusal(study, changes)
    assert said is None or re.search("got|leave no face width|is too few", said)


def test_impossible_teeth_are_named():
    study = drive_study(THREE)
    with pytest.raises(ValueError, match="gear_teeth must exceed pinion_teeth=60, got 50"):
        study.model(study.settings({"pinion_teeth": 60, "gear_teeth": 50}))
    with pytest.raises(ValueError, match="bore_radius must"):
        study.model(study.settings({"bore_radius": 200.0, "module": 1.0}))


@pytest.mark.slow
def test_few_teeth_at_a_high_ratio_are_explored():
    """Contact lines end on the pinion's base circle, where the contact point's speed has no limit."""
    study = drive_study(THREE)
    few = study.model(study.settings({"pinion_teeth": 18, "gear_teeth": 124, "pinions": "1"}))
    values = np.array([0.4, 1.0])
    chart = reading_map(few, np.array([55.0, 60.0]), "load.stiffness", values)
    expected = [
        [growth_rate(replace_parameter(few, "load.stiffness", v).system(speed)) for speed in (55.0, 60.0)]
        for v in values
    ]
    np.testing.assert_allclose(chart.values, expected, atol=1e-5)
