"""Compute the anchors of the report on Case I: `python -m tests.independent.make_anchors_drive`.

Takes some minutes. Borders of tongues are found as roots of spectral radii by the independent route of chapter 6, K_f
of the text in complex exponentials and DOP853, in brackets of a few rpm. The basis is the one that the report ends
with, the bearing that of the printed basis in N/m.
"""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from facegear.mechanics.cases import CASE_1
from tests.independent.complex_galerkin import multipliers
from tests.independent.make_anchors_ch04 import (
    RADIUS_TOLERANCE,
    anchor,
    nominal_mass,
    pinion,
    reference_stiffness,
    rpm,
    write,
)
from tests.independent.make_anchors_ch06 import LoadedDisk, loaded

ROUTE = (
    "tests/independent/edge_load.py and complex_galerkin.py: (6-25) in complex exponentials with K_f by (6-27), all "
    "harmonics, one smooth piece of the period after the other by DOP853 at 1e-12"
)
BODY = replace(CASE_1, nodal_circles=1, nodal_diameters=7)
POWER, POWER_SPEED = 447.42e3, rpm(5000.0)
BEARING = reference_stiffness(CASE_1)  # μ = 1
DAMPING = 3e-6 * BEARING
# Growth in a period from which `facegear.tongues` calls a speed unstable.
THRESHOLD = 1e-8
# Number of a tongue, which border, and a bracket of it [rpm].
BRACKETS = (
    (0, "lower", (113.4, 114.0)),
    (0, "upper", (118.0, 118.6)),
    (1, "lower", (122.7, 123.3)),
    (1, "upper", (124.7, 125.3)),
    (2, "lower", (127.0, 127.6)),
    (2, "upper", (422.2, 423.0)),
    (3, "lower", (432.2, 433.0)),
)


@cache
def unit_stiffness(speed):
    return loaded(BODY, 1.0, 2 * BODY.nodal_diameters).load_stiffness(speed)


class Disk(LoadedDisk):
    """The loaded disk with K_f made once for each speed."""

    def load_stiffness(self, speed):
        return self.force * unit_stiffness(speed)


@cache
def disk():
    plain = loaded(BODY, POWER / (POWER_SPEED * BODY.drive.pitch_radius), 2 * BODY.nodal_diameters)
    return Disk(**{name: getattr(plain, name) for name in plain.__dataclass_fields__})


def excess(speed_rpm):
    period = 2 * np.pi / (BODY.drive.gear_teeth * rpm(speed_rpm))
    found = multipliers(
        disk(),
        [pinion(BODY, None, 1)],
        rpm(speed_rpm),
        period,
        m_p=nominal_mass(BODY),
        c_b=DAMPING,
        k_b=BEARING,
    )
    return float(np.abs(found).max()) - 1.0 - THRESHOLD


def borders():
    for tongue, name, (low, high) in BRACKETS:
        place = brentq(excess, low, high, xtol=1e-6)
        slope = (excess(place + 0.01) - excess(place - 0.01)) / 0.02
        # The tolerance of the spectral radius on both routes, carried over to the border, and of the search.
        yield anchor(name, place, 2 * RADIUS_TOLERANCE / abs(slope) + 2e-6, tongue=tongue)


if __name__ == "__main__":
    write("drive_tongues", ROUTE, borders())
