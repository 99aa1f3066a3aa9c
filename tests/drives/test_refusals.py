"""What models refuse, told in the words of the file."""

import re

import pytest
import yaml

from facegear.drives.drive_file import parse_drive
from facegear.drives.drive_keys import SECTIONS
from facegear.drives.examples import example_text
from facegear.drives.refusals import told
from facegear.maps.tracing import tongues
from facegear.mechanics.contact import Contact
from facegear.support.parameters import within
from tests.drives.drive_files import BOTH_FACES, CASE_1, refusal

TEETH = CASE_1 + "\nteeth:\n  tooth_damping_us: 10\n"


def test_of_a_body_too_soft_each_key_that_could_help_is_named():
    told = refusal(yaml.safe_dump(yaml.safe_load(BOTH_FACES) | {"material": {"youngs_modulus_GPa": 1}}))
    keys = ("body.thickness_ratio", "material.youngs_modulus_GPa", "material.density_kg_per_m3")
    assert all(key in told for key in keys)


def test_too_few_teeth_are_told_in_the_words_of_the_file():
    few = TEETH.replace("pinion_teeth: 26", "pinion_teeth: 18").replace("gear_teeth: 130", "gear_teeth: 90")
    few = few.replace("bore_radius_mm: 50", "bore_radius_mm: 30")
    told = refusal(few)
    assert re.match(
        r"teeth: gears.pinion_teeth = 18 is too few for a section teeth, whose model follows the moving contact "
        r"\(gears.gear_teeth = 90, .* 22 pinion teeth are enough",
        told,
    )
    assert "rate" not in told.replace("ratio", "")
    assert parse_drive(few.split("\nteeth:")[0]).teeth is None


def raised(work):
    with pytest.raises((ValueError, ArithmeticError)) as caught:
        work()
    return caught.value


@pytest.mark.parametrize(
    "key", [k for k in SECTIONS["body"].keys if k.kind == "number"], ids=lambda k: k.name
)
def test_a_range_is_told_in_the_units_of_the_file(key):
    low, high, wrong = (key.to_si(value) for value in (1.0, 2.0, 3.0))
    unit = " in mm, got 3 mm" if key.unit else ", got 3.0"
    expected = f"body.{key.name} must lie in [1, 2]{unit}"
    error = raised(lambda: within(key.si_name, wrong, low, high, "m" if key.unit else ""))
    assert told(error) == expected
    assert told(ValueError(f"x: {error}; so it is")) == f"x: {expected}; so it is"


def test_speeds_are_told_in_rpm():
    error = raised(lambda: within("speed", 10.0, 0.0, 6.0, "rad/s", "rpm?"))
    assert (
        told(error)
        == "the speed of the face gear must be greater than 0 and at most 57.2958 rpm, got 95.493 rpm"
    )
    assert told(ValueError("lost near 10 rad/s, between 1 and 6 rad/s")) == (
        "lost near 95.493 rpm, between 9.5493 and 57.2958 rpm"
    )
    # Of a motion, not of the gear.
    assert (
        told(ValueError("the fastest motion, 3000 rad/s, takes")) == "the fastest motion, 3000 rad/s, takes"
    )


def test_a_mass_that_cannot_follow_is_that_of_the_file():
    drive = parse_drive(CASE_1).drive
    error = raised(lambda: Contact(rate="total", sharing="mean").require_one_load(drive, 1.0))
    text = told(error)
    assert text.startswith("pinions.mass must be 0 where a mean contact point is followed that jumps")
    assert text.endswith("got pinions.mass = 1.0")
    assert '"' not in text


def test_what_is_said_to_programmers_is_not_told():
    """Multipliers of any model are lost in rounding somewhere: the class of another method is none of the file."""
    model = parse_drive(CASE_1).transverse
    error = raised(lambda: tongues(model, (30.0, 60.0), threshold=1e-12, progress=False))
    assert "facegear.floquet.radau" in str(error)
    assert "facegear" not in told(error)
    assert told(error).startswith("multipliers are known to")
    # What made the matrices stiff is not known: 100 MW on a pinion did with dampers as usual.
    assert told(error).endswith("as where dampers or forces are very strong")
    for model_error in (
        "system must be stable for a steady response, got max|λ| = 1.2; allow_unstable=True finds the motion that any "
        "disturbance would leave",
        "known to 1e-8 at best; take it out with facegear.WithoutRigidMotion(model), which changes no other multiplier",
    ):
        assert not re.search("facegear|True", told(ValueError(model_error)))


def test_a_torque_that_is_refused_is_told_as_the_power_of_the_file():
    text = example_text("localized")
    told_of = refusal(re.sub(r"power_kW: .*", "power_kW: 1e5", text))
    low, high = map(float, re.search(r"operation.power_kW must lie in \[(\S+), (\S+)\] kW", told_of).groups())
    assert "at operation.pinion_speed_rpm = 5000 rpm" in told_of
    assert "torque" not in told_of
    assert "got 100000 kW" in told_of
    assert low < 1e-9
    # What is told to be valid is.
    assert parse_drive(re.sub(r"power_kW: .*", f"power_kW: {0.99 * high:.6g}", text))
    assert "operation.power_kW" in refusal(re.sub(r"power_kW: .*", f"power_kW: {1.02 * high:.6g}", text))
