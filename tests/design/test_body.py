from dataclasses import replace

import pytest

from facegear.design import body as design
from facegear.design.teeth import constant_diametral_pitch, root_stress
from facegear.maps.lobes import StableRangeError
from facegear.mechanics.contact import Contact
from facegear.mechanics.paths import point_contact
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.support.parameters import rad_per_s, watt
from tests.comparing import agree

DRIVE = constant_diametral_pitch(25)
LOAD = MeshLoad(stiffness=0.8, damping=1e-5, mass=1.0)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: design.Requirements(1.0, 1.0, 0.5, (1.0, 2.0)), "safety_factor"),
        (lambda: design.Requirements(1.0, 1.0, 1.5, (2.0, 1.0)), "speeds"),
        (lambda: design.critical_thickness(DRIVE, LOAD, (30.0, 20.0)), "speeds"),
        (lambda: design.critical_thickness(DRIVE, LOAD, (1.0, 2.0, 3.0)), "speeds"),
        (
            lambda: design.critical_thickness(DRIVE, LOAD, (20.0, 30.0), thickness_range=(0.04, 40.0)),
            "thickness",
        ),
        (lambda: design.critical_thickness(DRIVE, LOAD, (20.0, 30.0), contact_ratio=0.5), "contact_ratio"),
    ],
)
def test_wrong_input_names_the_parameter(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_lobe_a_of_figure_4_9():
    """Printed, read off a plot: h/a ≈ 0.0375 for 0 to 300 rpm. Nothing else reaches this high between 150 and 300."""
    speeds = tuple(rad_per_s([150.0, 300.0]).tolist())
    result = design.critical_thickness(DRIVE, LOAD, speeds, thickness_range=(0.036, 0.039))
    assert result.thickness_ratio == pytest.approx(0.0375, abs=1.5e-4)
    assert result.lobe.label == "(1+1)/1"
    assert result.lobes == tuple(sorted(result.lobes, key=lambda lobe: -lobe.thickness_ratio))


def test_the_teeth_may_touch_otherwise():
    """At a point, on its own clock, the lobe of the test above is gone."""
    cut, speeds = replace(DRIVE, shaper_teeth=26), tuple(rad_per_s([150.0, 300.0]).tolist())
    contact = Contact(path=point_contact, sharing="mean")
    with pytest.raises(StableRangeError, match=r"down to h/a = 0\.036 the model is stable"):
        design.critical_thickness(cut, LOAD, speeds, thickness_range=(0.036, 0.039), contact=contact)
    with pytest.raises(ValueError, match="ContactPath needs contact along lines"):
        design.critical_thickness(cut, LOAD, speeds)


@pytest.mark.slow
@pytest.mark.parametrize("flow", [design.design_body, design.design_family])
def test_design_flow_of_teeth_that_touch_otherwise(flow):
    cut, speeds = replace(DRIVE, shaper_teeth=26), tuple(rad_per_s([150.0, 300.0]).tolist())
    needed = design.Requirements(float(watt(600.0)), float(rad_per_s(5000.0)), 1.5, speeds)
    contact = Contact(path=point_contact, sharing="mean")
    one = (cut, LOAD, needed) if flow is design.design_body else ([cut], LOAD, needed, [speeds[1]])
    with pytest.raises(StableRangeError, match=r"down to h/a = 0\.036 the model is stable"):
        flow(*one, thickness_range=(0.036, 0.039), contact=contact)


@pytest.mark.slow
def test_design_flow():
    speeds = tuple(rad_per_s([150.0, 300.0]).tolist())
    needed = design.Requirements(float(watt(600.0)), float(rad_per_s(5000.0)), 1.5, speeds)
    ((result,),) = design.design_family([DRIVE], LOAD, needed, [speeds[1]], (0.036, 0.039), jobs=1)
    alone = design.design_body(DRIVE, LOAD, needed, (0.036, 0.039))
    # One of the two limits the threads of BLAS; the tip of a lobe is found to 1e-6 of the thickness.
    assert agree(alone, result, rel=1e-6)
    assert result.body == Body(DRIVE, result.critical.thickness_ratio)
    assert result.allowable_stress == pytest.approx(439.9e6 / 1.5)
    # With fewer teeth of the same pitch the pinion is smaller and the force at its teeth larger.
    small = constant_diametral_pitch(22)
    assert result.root_stress < result.allowable_stress
    assert root_stress(small, needed.power, needed.pinion_speed) > result.allowable_stress
