"""Arrays of chapter 5's figures, and the drawings made of them."""

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

from compendium.datasets import cancellation
from compendium.datasets import pinions as arrays
from compendium.plotting import cancellation as charts
from compendium.plotting import pinions as draw
from facegear.design.cancellation import Wave, WavePair
from facegear.floquet.multipliers import growth_rate
from facegear.mechanics.cases import EXAMPLE_A, EXAMPLE_B
from facegear.mechanics.contact import Contact
from facegear.support import labelled
from facegear.support.parameters import rad_per_s
from tests.figures import check_round_trip, texts

PITCH = float(np.degrees(EXAMPLE_B.body.drive.angular_pitch))
SPEEDS = [820.0, 868.0, 880.0]


@pytest.fixture(scope="module")
def tongues():
    models = {angle: arrays.with_pinions(EXAMPLE_B, 0.0, angle) for angle in (51 * PITCH, 51.5 * PITCH)}
    return arrays.traced(models, (750.0, 950.0), jobs=1)


@pytest.fixture(scope="module")
def chart(tongues):
    return arrays.with_tongues(
        arrays.angle_map(EXAMPLE_B, SPEEDS, arrays.pitches(51, 52, 4), jobs=1), tongues
    )


def test_maps_hold_growth_rates_of_single_cells(chart, tmp_path):
    check_round_trip(chart, tmp_path)
    np.testing.assert_allclose(chart["total_angle"], (51 + np.arange(5) / 4) * PITCH)
    for row in (0, 3):
        model = arrays.with_pinions(EXAMPLE_B, 0.0, float(chart["total_angle"][row]))
        expected = growth_rate(model.system(float(rad_per_s(868.0))))
        assert float(chart["growth_rate"][row, 1]) == pytest.approx(expected, abs=1e-4)


def test_groups_of_pinions_move_together():
    chart = arrays.angle_map(EXAMPLE_B, [868.0], [40.0], fixed=(0.0, 180.0), moving=(0.0, 180.0), jobs=1)
    model = arrays.with_pinions(EXAMPLE_B, 0.0, 180.0, 40 * PITCH, 40 * PITCH + 180.0)
    expected = growth_rate(model.system(float(rad_per_s(868.0))))
    assert float(chart["growth_rate"][0, 0]) == pytest.approx(expected, abs=1e-4)


def test_phase_maps_are_rows_of_the_angle_map(chart, tmp_path):
    (phases,) = arrays.phase_maps(EXAMPLE_B, SPEEDS, [51], np.linspace(0, 1, 5), jobs=1)
    check_round_trip(phases, tmp_path)
    np.testing.assert_allclose(phases["growth_rate"], chart["growth_rate"], atol=1e-6)


def test_another_tooth_count_has_its_own_contact_ratio():
    model = arrays.with_teeth(EXAMPLE_B, 33)
    assert model.body.drive.gear_teeth == 165
    assert model.contact_ratio == model.body.drive.contact_ratio != EXAMPLE_B.contact_ratio
    chosen = arrays.with_teeth(replace(EXAMPLE_B, contact=Contact(contact_ratio=2.0)), 33)
    assert chosen.contact_ratio == 2.0
    odd = replace(EXAMPLE_A.body.drive, gear_teeth=131)
    uneven = replace(EXAMPLE_A, body=replace(EXAMPLE_A.body, drive=odd))
    with pytest.raises(ValueError, match="pinion_teeth"):
        arrays.with_teeth(uneven, 25)


def test_tooth_counts_find_the_tongues_of_each(tmp_path):
    table = arrays.tooth_counts(EXAMPLE_B, 180.0, [24, 31], (800.0, 950.0), jobs=1)
    check_round_trip(table, tmp_path)
    assert labelled.label_rows(table["label"]) == [[], ["(2+9)/1"]]
    assert np.isnan(table["lower"].values[0]).all()
    # A printed statement: stable there, whatever the traced borders are of the other.
    assert "(c) 180" in texts(draw.tooth_counts({"(c) 180": table}))


def test_small_arrays_survive_their_files_and_are_drawn(chart, tongues, tmp_path):
    before = dict(mpl.rcParams)
    relation = arrays.phase_relation(EXAMPLE_B.body.drive, 10.0, 11)
    two = cancellation.two_pinion_chart(155, [-1, 0, 1], np.linspace(90, 95, 7))
    several = cancellation.array_chart([155, 156], {"2 equal": [0, 180], "X": [0, 70, 180, 250]}, [-1, 0, 1])
    pair = {"a pair": WavePair(Wave(0, 2), Wave(1, 0))}
    weak = cancellation.weak_tongues(EXAMPLE_B, pair, [(0.0, 97.8)], (0.01,), jobs=1)
    curves = cancellation.interference_curves(EXAMPLE_B, [51], [0.0, 0.5], {(1, 1): 190.0, (1, 2): 197.0})
    for dataset in (relation, two, several, weak, curves):
        check_round_trip(dataset, tmp_path)
    assert two["remaining"].sel(wave_number=0, total_angle=90.0) == pytest.approx(
        abs(np.cos(np.radians(155 * 45)))
    )
    assert weak["growth"].item() == pytest.approx(weak["phasing_sum"].item(), rel=0.05)
    zones = (300.0, 700.0)
    assert "phase" in texts(draw.phase_relation(relation))
    shown = texts(draw.angle_maps({"(b) B": chart}, {"(b) B": (850.0, 870.0)}, 1.0))
    assert tongues["label"].values[0, 0] in shown
    assert "close-up" in shown
    assert "III" in texts(draw.positions(chart, (850.0, 870.0)))
    over_phase = chart.rename(total_angle="phase")
    assert "growth rate" in texts(draw.phase_maps({"(b)": over_phase}, zones))
    assert "total angle" in texts(draw.one_map(chart))
    assert "first" in texts(draw.speed_lines({"first": chart["growth_rate"].isel(total_angle=0)}))
    assert "0.25" in texts(draw.growth_at_angle(chart, 1, 0.25, 0.27, 0.05))
    assert "X" in texts(charts.array_chart(several))
    assert "39" in texts(charts.two_pinion_chart(two, PITCH))
    assert "a pair" in texts(charts.weak_tongues(weak))
    assert "(1+2)/1" in texts(charts.interference(curves, ["118.5"], [tongues]))
    assert dict(mpl.rcParams) == before
