"""Arrays and figures of the chapter on play between teeth."""

import numpy as np
import pytest
import xarray as xr
from scipy.stats import binomtest

from compendium.datasets import backlash as arrays
from compendium.plotting import backlash as draw
from facegear.floquet.arc_length import Following
from facegear.floquet.continuation import followed
from facegear.floquet.orbits import periodic_orbit
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.parameters import rad_per_s
from tests.figures import texts

PLAY = Backlash(FIGURES["7.12a"].model(), torque=800.0, gap=1e-4)
SPEEDS = [740.0, 750.0]


@pytest.fixture(scope="module")
def branch():
    low, high = (float(rad_per_s(x)) for x in (730.0, 760.0))
    start = periodic_orbit(PLAY.system(high))
    return followed(PLAY.system, high, start, low, high, direction=-1.0, following=Following(largest=30.0))


@pytest.fixture(scope="module")
def curves(branch):
    return arrays.response(PLAY, {"from above": branch}, SPEEDS, 1e-3)


def test_statistics_are_those_of_the_motion(branch):
    orbit = branch.orbits[0]
    sampled = PLAY.deformation(orbit, np.linspace(0.0, 1.0, 4001))
    mean, rms, lowest, highest, contact, entering = arrays.statistics(PLAY, orbit)
    assert mean == pytest.approx(np.trapezoid(sampled, dx=1.0 / 4000), rel=1e-6)
    assert rms == pytest.approx(np.sqrt(np.trapezoid((sampled - mean) ** 2, dx=1.0 / 4000)), rel=1e-5)
    assert (lowest, highest) == pytest.approx((sampled.min(), sampled.max()), rel=1e-6)
    assert (contact, entering) == (0.0, pytest.approx(sampled[0], rel=1e-12))


def test_response_has_the_motions_of_each_speed(curves):
    orbit = periodic_orbit(PLAY.system(float(rad_per_s(750.0))))
    row = curves.sel(speed=750.0, sheet=0)
    assert float(row.highest) == pytest.approx(arrays.statistics(PLAY, orbit)[3], rel=1e-8)
    assert (float(row.contact), float(row.stable), curves.family.values.tolist()) == (
        0.0,
        1.0,
        ["from above"],
    )


def test_special_points_are_listed_by_family(branch):
    assert arrays.special({"quiet": branch}) == []


def test_shares_are_counts_with_wilson_s_interval():
    data = xr.Dataset({"highest": ("state", [1e-5] * 7 + [2e-4] * 2 + [np.inf])})
    rows = arrays.shares(data, [1e-4, 1e-3])
    assert [count for count, *_ in rows] == [7, 2, 1]
    interval = binomtest(7, 10).proportion_ci(0.95, method="wilson")
    assert rows[0][1:] == pytest.approx((interval.low, interval.high), abs=1e-4)


def test_runs_of_growth():
    data = xr.Dataset({"growth": ("speed", [-0.1, 0.2, 0.1, -0.3, 0.4])}, {"speed": np.arange(5) * 10.0})
    assert arrays.large_runs(data, 0.05) == [(10.0, 20.0), (40.0, 40.0)]
    assert arrays.large_runs(data, 0.15) == [(10.0, 10.0), (40.0, 40.0)]


def test_large_motions_grow_where_the_text_says():
    found = arrays.large_motions(PLAY, [500.0, 640.0], 40)
    assert float(found.growth[0]) < 0.0 < float(found.growth[1])


def test_figures_name_what_they_show(curves):
    shown = texts(draw.response(curves, PLAY.gap))
    assert all(words in shown for words in ("flanks stay pressed", "highest [µm]", "back flanks are struck"))
    curve = xr.Dataset({"growth": ("speed", [0.1, -0.1])}, {"speed": [300.0, 400.0]})
    assert "derived" in texts(draw.growth({"derived": curve}))


def test_torque_is_followed_down_from_the_largest():
    torques = np.array([1900.0, 1950.0, 2000.0])
    followed_down, data = arrays.torque_response(PLAY, 740.0, torques, 1e-3)
    assert data.entering.dims == ("sheet", "torque")
    orbit = periodic_orbit(Backlash(PLAY.torsional, 1950.0, PLAY.gap).system(float(rad_per_s(740.0))))
    assert float(data.highest[0, 1]) == pytest.approx(arrays.statistics(PLAY, orbit)[3], rel=1e-8)
    assert followed_down.ended.startswith("at 1900")
    assert "torque of the load [N m]" in texts(draw.response(data, PLAY.gap))
