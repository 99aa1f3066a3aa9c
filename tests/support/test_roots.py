"""The search for many roots at once."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq
from scipy.optimize.elementwise import find_root

from facegear.support.roots import crossing


@given(
    levels=st.lists(st.floats(-0.9, 0.9), min_size=1, max_size=40),
    power=st.sampled_from([1, 3, 5]),
    steepness=st.floats(0.1, 30.0),
)
def test_crossings_are_scipy_s(levels, power, steepness):
    """Steep, flat at the root (odd powers), and everything between."""
    level = np.array(levels)

    def function(x, level):
        return np.tanh(steepness * (x - level)) ** power

    found = crossing(function, -1.0, 1.0, level)
    # Where the function is flat, all of an interval gives zero.
    np.testing.assert_allclose(function(found, level), 0.0, atol=1e-14)
    if power == 1:
        expected = find_root(function, (np.full(level.shape, -1.0), np.ones(level.shape)), args=(level,)).x
        np.testing.assert_allclose(found, expected, rtol=1e-15, atol=1e-15)
        np.testing.assert_allclose(found, level, rtol=1e-15, atol=1e-15)


def test_without_a_change_of_sign_an_end_is_the_answer():
    level = np.array([-3.0, 0.25, 3.0])
    found = crossing(lambda x, level: x - level, -1.0, 1.0, level)
    assert found.tolist() == [-1.0, 0.25, 1.0]


def test_a_jump_is_found_like_a_root():
    found = crossing(lambda x, level: np.where(x < level, -1.0, 1e-3), 0.0, 1.0, np.array([0.3, 0.0]))
    assert found == pytest.approx([0.3, 0.0], rel=1e-15, abs=1e-19)


def test_numbers_have_the_shape_of_numbers():
    found = crossing(lambda x: np.cos(3.0 * x) * -1.0, 0.1, 0.9)
    assert found.shape == ()
    assert float(found) == pytest.approx(brentq(lambda x: np.cos(3.0 * x), 0.1, 0.9, xtol=1e-16), rel=1e-15)


def test_what_is_no_number_does_not_settle():
    with pytest.raises(RuntimeError, match="did not settle"):
        crossing(lambda x: np.where(np.abs(x) < 0.5, np.nan, x), -1.0, 1.0)
