"""Arrays on the accuracy of transition matrices: consistent with independent routes and with each other."""

import numpy as np
import pytest

from compendium import reference
from compendium.datasets import accuracy as accuracy_arrays
from facegear.floquet.methods import AlignedStepwise, Magnus, Stepwise
from facegear.mechanics import classical_pairs
from facegear.support import labelled
from tests.independent import classical as independent

GEARS = classical_pairs.GearPair(1.563, droop=0.4, shaft_damping=0.02).system(1.1)


@pytest.mark.parametrize(
    "compute",
    [
        lambda: accuracy_arrays.convergence(GEARS, [8, 16], "gears"),
        lambda: accuracy_arrays.doubling(GEARS, 16, 2, "gears"),
        lambda: accuracy_arrays.estimates(GEARS, [("magnus", Magnus(16))], "gears"),
    ],
    ids=["convergence", "doubling", "estimates"],
)
def test_every_figure_survives_the_round_trip_through_its_file(compute, tmp_path):
    dataset = compute()
    stored = labelled.load(labelled.save(dataset, tmp_path / "figure.nc"))
    assert all(row.largest_absolute == 0.0 for row in reference.compare(dataset, stored))


def test_integration_agrees_with_the_independent_one():
    right = independent.transition_matrix(independent.gear_pair(1.1, 1.563, 0.4, 0.02))
    np.testing.assert_allclose(accuracy_arrays.integrated_transition_matrix(GEARS), right, atol=1e-11)


def test_errors_of_the_stepwise_rule_are_those_of_single_exponentials():
    written_out = independent.gear_pair(1.1, 1.563, 0.4, 0.02)
    right = independent.transition_matrix(written_out)
    expected = [
        independent.relative_error(independent.held(written_out, independent.equal_edges(q)), right)
        for q in (16, 24)
    ]
    data = accuracy_arrays.convergence(GEARS, [16, 24], "gears")
    np.testing.assert_allclose(data.uniform.values, expected, atol=1e-11)
    assert float(data.collocation) < 1e-11


def test_doubling_repeats_the_trap_at_nine_sixteenths():
    data = accuracy_arrays.doubling(GEARS, 64, 3, "gears")
    assert (data.change.values[1:] < 0.3 * np.append(np.inf, data.change.values[1:-1])).all()
    assert data.error.values[-1] > 100 * data.change.values[-1]
    # 0.563 and 9/16 are the same to these sub-intervals.
    other = classical_pairs.GearPair(1.5625, droop=0.4, shaft_damping=0.02).system(1.1)
    assert (
        accuracy_arrays.doubling(other, 64, 3, "gears").error.values[-1] < 10 * data.aligned_error.values[-1]
    )


def test_estimates_are_not_below_the_true_errors():
    methods = [("aligned", AlignedStepwise(32)), ("uniform", Stepwise(512))]
    data = accuracy_arrays.estimates(GEARS, methods, "gears")
    assert (data.estimate.values >= data.error.values).all()
    assert data["method"].values.tolist() == ["aligned", "uniform"]
