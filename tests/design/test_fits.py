"""Least squares from many starts: minima of a function with two, bounds, starts that lead nowhere."""

import numpy as np
import pytest

from facegear.design.fits import local_fits, spread_starts


def quartic(values):
    """x² = 1/4, and no residuals beyond 0.7."""
    if abs(values[0]) > 0.7:
        raise ArithmeticError("too far")
    return 10.0 * (values**2 - 0.25), np.diag(20.0 * values)


def test_both_minima_are_found():
    fits = local_fits(quartic, spread_starts(-1.0, 1.0, 1, 12), -1.0, 1.0)
    # The first start is 0, from which nothing leads away.
    assert fits[-1].misfit == pytest.approx(2.5**2)
    np.testing.assert_allclose(sorted({round(fit.values[0], 6) for fit in fits[:-1]}), [-0.5, 0.5])
    assert len(fits) < 12
    left, right = (next(fit for fit in fits if fit.values[0] * sign > 0.0) for sign in (-1.0, 1.0))
    # Linearised, residuals change by 10 over the distance of 1.
    assert left.differs(right, 99.0)
    assert not left.differs(right, 101.0)


def test_the_best_comes_first_and_bounds_hold():
    fits = local_fits(quartic, [np.array([-0.1]), np.array([0.3])], -0.2, 0.8)
    assert fits[0].values[0] == pytest.approx(0.5)
    assert fits[1].values[0] == pytest.approx(-0.2)
    assert fits[1].misfit == pytest.approx(2.1**2)


def test_starts_fill_the_box():
    starts = spread_starts(0.2, 0.6, 3, 16)
    assert ((starts > 0.2) & (starts < 0.6)).all()
    np.testing.assert_allclose(starts, spread_starts(0.2, 0.6, 3, 16), rtol=1e-15)
    np.testing.assert_allclose(starts.mean(axis=0), 0.4, atol=0.05)
