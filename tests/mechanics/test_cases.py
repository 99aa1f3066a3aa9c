"""The dissertation's drives and captions: the parameters that tables and captions print."""

import pytest

from facegear.floquet.models import replace_parameter
from facegear.mechanics.cases import CASE_1, CASE_2, FIGURES, HIGHEST_SPEED_RPM, MODULE
from facegear.mechanics.contact import Contact


@pytest.mark.parametrize(
    ("body", "teeth", "outer_radius_mm", "thickness_ratio", "contact_ratio"),
    [(CASE_1, (26, 130), 231.94, 0.03, 1.5532), (CASE_2, (31, 155), 274.54, 0.05, 1.5668)],
)
def test_cases_have_what_captions_print(body, teeth, outer_radius_mm, thickness_ratio, contact_ratio):
    assert (body.drive.pinion_teeth, body.drive.gear_teeth) == teeth
    assert body.outer_radius * 1e3 == pytest.approx(outer_radius_mm, abs=0.005)
    assert body.drive.contact_ratio == pytest.approx(contact_ratio, abs=5e-5)
    assert body.thickness_ratio == thickness_ratio
    assert (body.bore_radius, body.nodal_circles, body.nodal_diameters) == (0.05, 1, 3)


def test_table_4_1_and_4_2():
    assert pytest.approx(3.175e-3) == MODULE
    # 5000 rpm of the pinion at a gear ratio of 5
    assert HIGHEST_SPEED_RPM * CASE_1.drive.gear_teeth / CASE_1.drive.pinion_teeth == pytest.approx(5000.0)


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_can_be_swept(name):
    figure = FIGURES[name]
    model = replace_parameter(figure.model(), figure.parameter, figure.highest)
    assert getattr(model.load, figure.parameter) == figure.highest
    held = {"stiffness", "damping", "mass"} - {figure.parameter}
    assert all(getattr(model.load, part) == getattr(figure.load, part) for part in held)
    assert model.system(50.0).size == 14


def test_options_reach_the_model():
    assert FIGURES["4.4a"].model(contact=Contact(rate="total")).contact.rate == "total"
