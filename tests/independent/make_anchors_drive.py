"""Compute the anchors of the report on Case I: `python -m tests.independent.make_anchors_drive`.

Takes a minute. Borders and peaks of tongues are found as roots and maxima of spectral radii by the independent route
of chapter 4, in brackets of whole rpm.
"""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from facegear.cases import CASE_1
from tests.independent.make_anchors_ch04 import RADIUS_TOLERANCE, ROUTE, anchor, spectral_radius, write

LOAD = {"stiffness": 1.0, "damping": 3e-6, "mass": 1.0}
# Growth in a period from which `facegear.tongues` calls a speed unstable.
THRESHOLD = 1e-8
# Number of a tongue and brackets of its borders [rpm], and of one peak.
BORDERS = {
    0: ((127, 128), (128, 129)),
    2: ((288, 288.5), (288.5, 289)),
    3: ((534, 535), (554, 555)),
    5: ((654, 655), (701, 702)),
    6: ((832, 833), (913, 914)),
}
PEAK = (3, (540, 550))


def excess(speed_rpm):
    return spectral_radius(CASE_1, speed_rpm, **LOAD)[0] - 1.0 - THRESHOLD


def growth(speed_rpm):
    radius, period = spectral_radius(CASE_1, speed_rpm, **LOAD)
    return float(np.log(radius) / period)


def borders():
    for tongue, brackets in BORDERS.items():
        for name, (low, high) in zip(("lower", "upper"), brackets, strict=True):
            place = brentq(excess, low, high, xtol=1e-6)
            slope = (excess(place + 0.01) - excess(place - 0.01)) / 0.02
            # The tolerance of the spectral radius on both routes, carried over to the border, and of the search.
            yield anchor(name, place, 2 * RADIUS_TOLERANCE / abs(slope) + 2e-6, tongue=tongue)
    tongue, bounds = PEAK
    found = minimize_scalar(
        lambda speed: -growth(speed), bounds=bounds, method="bounded", options={"xatol": 1e-2}
    )
    yield anchor("largest_growth", -found.fun, 1e-4, tongue=tongue)


if __name__ == "__main__":
    write("drive_tongues", ROUTE, borders())
