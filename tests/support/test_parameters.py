"""Input checks and unit conversions."""

import math

import numpy as np
import pytest

from facegear.support import parameters


@pytest.mark.parametrize(
    ("check", "value", "error", "message"),
    [
        (parameters.finite, "1", TypeError, "mass must be a real number.*'1'"),
        (parameters.finite, True, TypeError, "mass must be a real number.*True"),
        (parameters.finite, None, TypeError, "mass must be a real number.*None"),
        (parameters.finite, 1j, TypeError, "mass must be a real number"),
        (parameters.finite, np.timedelta64(3, "s"), TypeError, "mass must be a real number"),
        (parameters.finite, np.longdouble("1e400"), ValueError, "mass must be finite"),
        (parameters.positive, np.float32(-2), ValueError, r"mass must be greater than 0 in kg, got -2\.0 kg"),
        (parameters.finite, math.nan, ValueError, "mass must be finite.*nan"),
        (parameters.finite, -math.inf, ValueError, "mass must be finite.*-inf"),
        (parameters.positive, 0.0, ValueError, r"mass must be greater than 0.*0\.0"),
        (parameters.positive, -2, ValueError, "mass must be greater than 0.*-2"),
        (parameters.nonnegative, -1e-9, ValueError, "mass must be 0 or greater.*-1e-09"),
    ],
)
def test_numbers_are_checked(check, value, error, message):
    with pytest.raises(error, match=message):
        check("mass", value, "kg")


def test_valid_numbers_pass_unchanged():
    assert parameters.finite("x", np.float32(0.5)) == 0.5
    assert parameters.positive("x", 3) == 3.0
    assert parameters.nonnegative("x", 0) == 0.0
    assert parameters.within("x", 2.0, 2.0, 3.0) == 2.0
    assert parameters.within("x", 3.0, 2.0, 3.0) == 3.0
    count = parameters.integer_at_least("n", np.int64(7), 7)
    assert (count, type(count)) == (7, int)


def test_interval_message_names_a_factor_of_1000():
    with pytest.raises(
        ValueError, match=r"module must lie in \[0\.0001, 0\.1\] in m, got 3\.175 m.*1000.*0\.003175"
    ):
        parameters.within("module", 3.175, 1e-4, 0.1, "m")
    with pytest.raises(
        ValueError, match=r"youngs_modulus .*200000000000\.0 would|youngs_modulus .*2e\+11 would"
    ):
        parameters.within("youngs_modulus", 200e6, 1e9, 1e12, "Pa")
    # Neither what no factor makes valid nor what has no unit.
    for value, unit in ((7.0, "m"), (1500.0, "")):
        with pytest.raises(ValueError, match="got") as caught:
            parameters.within("x", value, 1.0, 2.0, unit)
        assert "1000?" not in str(caught.value)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 10**400])
def test_of_what_is_not_finite_the_interval_is_told(value):
    with pytest.raises(ValueError, match=r"x must lie in \[1, 2\] in m, got (nan|-?inf|10+)"):
        parameters.within("x", value, 1.0, 2.0, "m")
    with pytest.raises(ValueError, match=r"x must lie between 14\.5° and 30°"):
        parameters.angle_within("x", value, 14.5, 30.0)
    with pytest.raises(ValueError, match="x must be finite"):
        parameters.within("x", value, 1.0, math.inf)


@pytest.mark.parametrize(
    ("value", "error"), [(1, ValueError), (6, ValueError), (2.5, TypeError), (True, TypeError)]
)
def test_of_a_count_both_ends_are_told(value, error):
    with pytest.raises(error, match=r"n must be an integer from 2 to 5, got"):
        parameters.integer_within("n", value, 2, 5)


def test_angle_in_degrees_is_named():
    with pytest.raises(ValueError, match=r"pressure_angle .*14\.5° and 30°.*25\.0.*looks like degrees"):
        parameters.angle_within("pressure_angle", 25.0, 14.5, 30.0)
    with pytest.raises(ValueError, match="pressure_angle") as caught:
        parameters.angle_within("pressure_angle", 0.9, 14.5, 30.0)
    assert "degrees:" not in str(caught.value)
    assert parameters.angle_within("x", math.radians(30.0), 14.5, 30.0) == math.radians(30.0)


@pytest.mark.parametrize(
    ("value", "error"),
    [(26.0, TypeError), ("26", TypeError), (True, TypeError), (4, ValueError), (-3, ValueError)],
)
def test_counts_are_checked(value, error):
    with pytest.raises(error, match=r"teeth must be .*5.*got"):
        parameters.integer_at_least("teeth", value, 5)


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (["a"], TypeError),
        ([1j], TypeError),
        ([True], TypeError),
        ([1.0, True], TypeError),
        ([[1.0], [np.True_]], TypeError),
        ([[1.0], [2.0, 3.0]], TypeError),
        (np.array([3], "timedelta64[s]"), TypeError),
        (np.array([np.longdouble("1e400")]), ValueError),
        ([1.0, math.nan], ValueError),
        ([math.inf], ValueError),
    ],
)
def test_arrays_are_checked(values, error):
    with pytest.raises(error, match="speed must be"):
        parameters.finite_array("speed", values)
    result = parameters.finite_array("speed", [[1, 2]])
    assert result.dtype == np.float64
    assert result.shape == (1, 2)


def test_units_at_the_edges():
    assert parameters.rad_per_s(60.0) == pytest.approx(2.0 * math.pi, rel=1e-15)
    assert parameters.rpm(2.0 * math.pi) == pytest.approx(60.0, rel=1e-15)
    assert parameters.watt(600.0) == pytest.approx(447419.922, rel=1e-15)
    np.testing.assert_allclose(
        parameters.rpm(parameters.rad_per_s(np.array([1.0, 300.0]))), [1.0, 300.0], rtol=1e-15
    )
