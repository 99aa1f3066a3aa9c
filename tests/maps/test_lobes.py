import math
import pickle
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from facegear.floquet.labels import Combination
from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.maps.lobes import StableRangeError, UnstableTopError, highest_lobes
from facegear.maps.tracing import Tongue

# --- tips of lobes against a closed form ---------------------------------------------------------------------------

STIFF, SOFT = 1.5, 0.5
HALF = PiecewiseChebyshev(np.array([0.0, 0.5]), np.array([[[1.0]], [[0.0]]]))


@dataclass(frozen=True)
class Meissner:
    """q̈ + 2 d q̇ + (d² + k(t)) q = 0 with k stiff for half the period: growth rate of d = 0, less d, exactly."""

    damping: float

    def system(self, speed: float) -> PeriodicSystem:
        contact = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=STIFF - SOFT, weight=HALF)
        return PeriodicSystem(
            [[1.0]], [[2 * self.damping]], [[SOFT + self.damping**2]], (contact,), 2 * math.pi / speed
        )


def undamped_growth(speed):
    """Growth rate from the trace of two exponentials (Meissner)."""
    first, second, half = math.sqrt(STIFF), math.sqrt(SOFT), math.pi / speed
    a, b = first * half, second * half
    trace = 2 * math.cos(a) * math.cos(b) - (first / second + second / first) * math.sin(a) * math.sin(b)
    return math.acosh(max(abs(trace) / 2, 1.0)) / (2 * half)


def model_at(thickness_ratio):
    return Meissner(damping=10 * thickness_ratio)


def test_tip_of_meissners_principal_lobe():
    best = minimize_scalar(
        lambda speed: -undamped_growth(speed), bounds=(1.6, 2.3), method="bounded", options={"xatol": 1e-9}
    )
    (result,) = highest_lobes(model_at, 1.3, [3.0], (0.005, 0.06), tolerance=1e-6)
    assert result.thickness_ratio == pytest.approx(-best.fun / 10, abs=1e-6)
    assert result.lobe.speed == pytest.approx(best.x, rel=1e-3)
    assert result.lobe.label == "(1+1)/1"


@pytest.mark.parametrize("speeds", [(2.05, 3.0), pytest.param((1.4, 1.8), marks=pytest.mark.slow)])
def test_lobe_cut_off_by_the_end_of_the_speed_range(speeds):
    end = min(speeds, key=lambda speed: abs(speed - 1.95))
    (result,) = highest_lobes(model_at, speeds[0], speeds[1:], (0.005, 0.06), tolerance=1e-6)
    assert result.thickness_ratio == pytest.approx(undamped_growth(end) / 10, abs=1e-6)
    assert result.lobe.speed == end


@pytest.mark.slow
def test_secondary_lobe_decides_where_the_principal_is_out_of_range():
    best = minimize_scalar(
        lambda speed: -undamped_growth(speed), bounds=(0.9, 1.1), method="bounded", options={"xatol": 1e-9}
    )
    (result,) = highest_lobes(model_at, 0.7, [1.2], (5e-4, 0.06), tolerance=1e-6)
    assert result.thickness_ratio == pytest.approx(-best.fun / 10, abs=1e-6)


def test_unstable_top_and_stable_range_are_refused():
    with pytest.raises(ValueError, match="thickness_range must end above all lobes"):
        highest_lobes(model_at, 1.3, [3.0], (0.001, 0.005))
    with pytest.raises(ValueError, match="thickness_range must reach down to an unstable lobe"):
        highest_lobes(model_at, 1.3, [3.0], (0.05, 0.06))


@pytest.mark.slow
def test_nested_ranges_of_speed_equal_each_alone():
    """The secondary lobe decides the narrow range, the principal one both wide ones, cut off by the first of them."""
    highest = [1.2, 3.0, 1.8]
    together = highest_lobes(model_at, 0.9, highest, (5e-4, 0.06), tolerance=1e-6)
    for end, result in zip(highest, together, strict=True):
        (alone,) = highest_lobes(model_at, 0.9, [end], (5e-4, 0.06), tolerance=1e-6)
        assert result.thickness_ratio == pytest.approx(alone.thickness_ratio, abs=1e-6)
        assert result.lobe.speed == pytest.approx(alone.lobe.speed, rel=2e-3)
    assert together[2].lobe.speed == 1.8


def test_speeds_must_be_named():
    with pytest.raises(ValueError, match="highest_speeds"):
        highest_lobes(model_at, 0.7, [], (5e-4, 0.06))
    with pytest.raises(ValueError, match="speeds must ascend"):
        highest_lobes(model_at, 0.7, [0.7], (5e-4, 0.06))


@pytest.mark.parametrize(
    "error",
    [
        StableRangeError(0.03, (10.0, 20.0)),
        UnstableTopError(Tongue(2.0, 3.0, 2.5, 0.1, Combination(1, 1, "sum", 1)), 0.06),
    ],
)
def test_what_is_refused_in_another_process_arrives_here(error):
    arrived = pickle.loads(pickle.dumps(error))
    assert type(arrived) is type(error)
    assert str(arrived) == str(error)
    assert arrived.thickness_ratio == error.thickness_ratio
