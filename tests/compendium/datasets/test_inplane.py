"""Arrays of chapter 6's figures, and the drawings made of them."""

from dataclasses import replace

import numpy as np
import pytest

from compendium.datasets import inplane as arrays
from compendium.datasets import power as power_arrays
from compendium.plotting import inplane as draw
from facegear.design.envelope import critical_power
from facegear.floquet.modal import modal_expansion
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.mechanics.cases import CASE_1, CASE_2, FIGURES
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.inplane import EdgeLoadStress
from facegear.support.parameters import rad_per_s, watt
from tests.figures import check_round_trip, texts

PINION_SPEED = float(rad_per_s(5000.0))
MODEL = FIGURES["4.4a"].model(force=DrivingForce(0.0, PINION_SPEED))


def test_harmonics_are_those_of_the_field(tmp_path):
    stress = EdgeLoadStress(CASE_2, 1e4, speed=100.0, harmonics=2)
    data = arrays.harmonic_stresses(stress, samples=11)
    check_round_trip(data, tmp_path)
    np.testing.assert_allclose(
        data["hoop"].sel(harmonic=2), stress.hoop(2, data["radius"].values), rtol=1e-12
    )
    summed = arrays.summed_stress([stress], radii=11, angles=5)
    angle = summed["angle"].values
    waves = np.sin(np.outer(data["harmonic"].values, angle))
    np.testing.assert_allclose(summed["radial"].values, data["radial"].values.T @ waves, atol=1e-6)
    assert "k$ = 2, up to" in texts(draw.harmonics_on_disk(data, "shear"))
    drawing = draw.summed_on_disk({"one": summed}, {"one": [(0.0, 0.4)]}, 1e6)
    assert "stress [MPa]" in texts(drawing)
    with pytest.raises(ValueError, match="all on one body"):
        arrays.summed_stress([stress, replace(stress, body=CASE_1)])
    with pytest.raises(ValueError, match="at least one"):
        arrays.summed_stress([])


@pytest.mark.parametrize("speed", [0.0, 104.7, 2000.0])
def test_equilibrium(speed):
    assert max(arrays.equilibrium(CASE_1, speed)) < 1e-12


def test_half_plane_is_approached_with_the_distance(tmp_path):
    data = arrays.near_load(CASE_2, [10, 60], [0.15, 0.3], np.pi / 4)
    check_round_trip(data, tmp_path)
    error = np.abs(data["ratio"].sel(harmonics=60).values - 1)
    # First order in the distance
    assert np.log2(error[1] / error[0]) == pytest.approx(1.0, abs=0.3)
    assert "10 harmonics" in texts(draw.near_load(data))


def test_closed_forms_lose_digits_and_collocation_does_not(tmp_path):
    data = arrays.closed_forms(CASE_2, [2], [1.0, 100.0])
    check_round_trip(data, tmp_path)
    lost = data["potentials"].sel(harmonic=2)
    # Two decades of speed are four of digits.
    assert 1e3 < float(lost[0] / lost[1]) < 1e5
    assert float(data["collocation"].max()) < 1e-11
    assert float(data["michell"].max()) < 1e-11
    assert "collocation, same colours" in texts(draw.digits_lost(data))


def test_disk_alone(tmp_path):
    data = power_arrays.disk_alone(CASE_1, PINION_SPEED, watt([50.0, 200.0]), [10.0, 1000.0])
    check_round_trip(data, tmp_path)
    assert np.all(data["growth_rate"].sel(power=watt(50.0)) < 0)
    assert np.all(data["growth_rate"].sel(power=watt(200.0)) > 0)
    assert np.all(data["dead"] < 0)
    expected = critical_power(CASE_1, PINION_SPEED, float(rad_per_s(1000.0)))
    assert float(data["critical"].sel(speed_rpm=1000.0)) == pytest.approx(expected, rel=1e-12)
    assert "$P_c$ = 113 hp" in texts(draw.disk_alone({"I": data}, {"I": (100.0,)}))


def test_stiffness_table(tmp_path):
    data = power_arrays.stiffness_table(CASE_1, 50.0, 5)
    check_round_trip(data, tmp_path)
    assert data["row_name"].values.tolist()[:3] == ["(0,0,cos)", "(1,0,cos)", "(0,1,cos)"]
    np.testing.assert_allclose(data["dead"], data["dead"].T, atol=1e-12 * float(np.abs(data["dead"]).max()))


def test_maps_hold_growth_rates_of_single_cells(tmp_path):
    powers = [0.0, float(watt(300.0))]
    speeds, heights = [300.0, 700.0, 900.0], [0.5, 1.0, 1.5]
    data = power_arrays.power_maps(MODEL, powers, speeds, heights, jobs=1)
    check_round_trip(data, tmp_path)
    for power in powers:
        one = replace_parameter(replace_parameter(MODEL, "power", power), "stiffness", 1.5)
        cell = float(data["growth_rate"].sel(power=power, stiffness=1.5, speed_rpm=700.0))
        assert cell == pytest.approx(growth_rate(one.system(float(rad_per_s(700.0)))), abs=1e-4)
    loaded = replace_parameter(MODEL, "power", powers[1])
    mean = power_arrays.mean_growth_map(loaded, speeds, heights)
    check_round_trip(mean, tmp_path)
    one = replace_parameter(loaded, "stiffness", 0.5).system(float(rad_per_s(900.0)))
    expected = modal_expansion(one, 1).mean_growth_rate
    assert float(mean["growth_rate"].sel(stiffness=0.5, speed_rpm=900.0)) == pytest.approx(expected, abs=1e-5)
    assert "(b) 300 hp" in texts(draw.power_maps(data, dict.fromkeys(powers, mean)))
    assert "Case I, 0 hp" in texts(draw.compared_clocks({"Case I": data}))
    with pytest.raises(ValueError, match="rate 'frozen'"):
        power_arrays.mean_growth_map(replace(loaded, contact=Contact(rate="total")), speeds, heights)


def test_envelope_of_two_variants(tmp_path):
    slow = replace(MODEL, contact=Contact(contact_ratio=CASE_1.drive.geometric_contact_ratio))
    data = power_arrays.power_envelope(
        {"Tregold": MODEL, "true sweep": slow}, "stiffness", [1.0], (830.0, 900.0)
    )
    check_round_trip(data, tmp_path)
    assert float(data["power"][0, 0]) == 0.0
    assert 0.0 < float(data["power"][1, 0]) < watt(300.0)
    assert data["label"].shape == data["power"].shape
    drawing = draw.envelope({"Case I": data}, {"Case I": float(watt(113.0))}, "stiffness")
    assert "disk alone" in texts(drawing)
    unlimited = data.copy(deep=True)
    unlimited["power"][1, 0] = np.inf
    drawing = draw.envelope({"Case I": unlimited}, {"Case I": float(watt(113.0))}, "stiffness")
    assert any(line.get_marker() == "^" and line.get_xdata().size for line in drawing.axes[0].lines)


def test_force_of_a_caption():
    """800 hp at 5000 rpm of the pinion of Case II."""
    expected = 800 * 745.69987 / (5000 * np.pi / 30) / (31 * 3.175e-3 / 2)
    assert DrivingForce(float(watt(800.0)), PINION_SPEED).newtons(CASE_2.drive) == pytest.approx(
        expected, rel=1e-9
    )
