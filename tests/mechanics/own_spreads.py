"""Spreads of one's own, and what tests of spreads start from."""

from dataclasses import dataclass

import numpy as np

import facegear as fg
from facegear.mechanics.cases import CASE_1
from facegear.mechanics.pressed_points import PressedPoints, Spread

DRIVE = CASE_1.drive
SHARED = fg.Contact(path=fg.shared_load("length_share"), sharing="each")


class Moved(Spread):
    """Points of one's own: shares of the moment at radii and angles."""

    def __init__(self, radius, angle=0.0, share=1.0):
        columns = np.broadcast_arrays(*map(np.atleast_1d, (radius, angle, share)))
        self.given = PressedPoints(*(np.asarray(column, dtype=float) for column in columns))

    def points(self, drive):
        return self.given


def assert_same(found, expected, relative=1e-12):
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=relative * np.abs(expected).max())


@dataclass(frozen=True)
class Own(Spread):
    """As somebody would write it from the documentation."""

    radius: object = (1.0,)
    angle: object = (0.0,)
    share: object = (1.0,)

    def points(self, drive):
        return PressedPoints(self.radius, self.angle, self.share)
