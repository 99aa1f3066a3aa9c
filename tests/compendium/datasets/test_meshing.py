"""Arrays of chapter 3's figures: consistent with each other and with the limits of the drive."""

import numpy as np
import pytest

from compendium.datasets import meshing as meshing_arrays
from compendium.datasets import tooth_limits as limit_arrays
from facegear import Drive
from tests.figures import check_round_trip

DRIVE = Drive(26, 130, 3.175e-3)


@pytest.mark.parametrize(
    "dataset",
    [
        meshing_arrays.tooth_and_contact_lines(DRIVE, lines=5, points=9),
        meshing_arrays.contact_point_positions(DRIVE, 1.5, samples=21),
        meshing_arrays.contact_centroid_instants(DRIVE, 1.5, [0.25, 0.75]),
        meshing_arrays.contact_centroid_motion(DRIVE, 1.5, samples=21),
        meshing_arrays.mesh_length(DRIVE, 1.5, samples=21),
        meshing_arrays.skew_lines(DRIVE, 1.5, samples=21),
        limit_arrays.contact_ratios(DRIVE, (25, 26)),
        limit_arrays.limits_against_shaft_angle(DRIVE, (80.0, 90.0)),
        limit_arrays.undercut_condition(DRIVE, (-0.1, 0.1)),
        limit_arrays.top_land(DRIVE, samples=5),
    ],
    ids=lambda dataset: next(iter(dataset.data_vars)),
)
def test_every_figure_survives_the_round_trip_through_its_file(dataset, tmp_path):
    check_round_trip(dataset, tmp_path)


def test_contact_points_lie_on_their_lines_and_lines_on_the_flank():
    tooth = meshing_arrays.tooth_and_contact_lines(DRIVE, lines=7, points=201)
    middle = tooth["midpoint"].values[3]
    distance = np.linalg.norm(tooth["line"].values[3] - middle, axis=1)
    assert distance.min() < 1e-4
    assert np.linalg.norm(tooth["midpoint"].values[:, :2], axis=1) == pytest.approx(
        tooth["contact_radius"].values
    )
    # From first to last contact the line starts and ends as a point.
    assert tooth["length"].values[[0, -1]] == pytest.approx(0.0, abs=1e-12)


def test_pairs_repeat_one_mesh_period_apart():
    paths = meshing_arrays.contact_point_positions(DRIVE, 1.5, pairs=3, samples=int(3.5 * 40) + 1)
    first, second = paths.radius.values[0], paths.radius.values[1]
    np.testing.assert_allclose(second[40:101], first[0:61], rtol=1e-12)
    assert np.isnan(second[:40]).all()


def test_total_length_is_the_sum_over_the_pairs_shown():
    instants = meshing_arrays.contact_centroid_instants(DRIVE, 1.5, [0.25, 0.75])
    length = meshing_arrays.mesh_length(DRIVE, 1.5, samples=5).total_length.values[[1, 3]]
    np.testing.assert_allclose(instants.length.sum("pair").values, length, rtol=1e-12)


def test_skew_line_starts_outside_and_ends_inside():
    lines = meshing_arrays.skew_lines(DRIVE, 1.5, pairs=1, samples=31)
    assert lines.skew_radius.values[0, 0] == pytest.approx(DRIVE.outer_radius, rel=1e-14)
    assert lines.skew_radius.values[0, -1] == pytest.approx(DRIVE.inner_radius, rel=1e-14)


def test_broken_gear_ratio_is_refused():
    with pytest.raises(ValueError, match="131/26"):
        limit_arrays.contact_ratios(Drive(26, 131, 3.175e-3), (25,))
