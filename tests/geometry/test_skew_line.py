"""The skew line of (3-22)."""

import math

import numpy as np
import pytest

from facegear.geometry.drive import Drive
from facegear.geometry.skew_line import SkewLine

CASE_I = Drive(26, 130, 3.175e-3)


def test_skew_line_is_3_22():
    line = SkewLine(CASE_I)
    r1, r2, cr = CASE_I.inner_radius, CASE_I.outer_radius, CASE_I.contact_ratio
    assert line.breakpoints == (0.0, pytest.approx(cr - 1.0, abs=1e-15))
    assert line.slope == pytest.approx((r1 - r2) / cr, rel=1e-14)
    for x in (0.0, 0.2, 0.5, 0.6, 0.99, -0.4, 5.5):
        states = line.pair_states(x)
        start = x - math.floor(x)
        for j, age in enumerate((start, start + 1.0)):
            assert states.in_contact[j] == (age <= cr)
            expected = r2 - (r2 - r1) * age / cr if age <= cr else 0.0
            assert states.radius[j] == pytest.approx(expected, rel=1e-13)
    ends = [line.pair_states_on_piece(i, np.array([-1.0, 1.0])) for i in (0, 1)]
    assert ends[0].radius[0, 0] == pytest.approx(r2, rel=1e-14)
    assert ends[0].radius[1, 1] == pytest.approx(r1, rel=1e-12)
    # The pair that left is gone on the closed next piece, its first instant included.
    assert not ends[1].in_contact[1].any()
