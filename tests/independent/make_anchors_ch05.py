"""Compute the anchors of chapter 5 and write them to data/anchors: `python -m tests.independent.make_anchors_ch05`.

Takes some minutes. Multipliers come from :mod:`tests.independent.complex_galerkin`, one contact for each pinion; of the
package it uses the radial mode functions and the contact centroid of a single pinion, which chapter 3's anchors and the
tests of the plate hold. Phases are exact fractions, sums over pinions are taken with 30 digits.
"""

import sys
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise

import mpmath
import numpy as np
from scipy.optimize import brentq
from tqdm import tqdm

from facegear import ContactPath
from facegear.mechanics.cases import EXAMPLE_A, EXAMPLE_B
from tests.independent.complex_galerkin import Pinion, multipliers
from tests.independent.make_anchors_ch04 import (
    FOLDER,
    ROUTE,
    anchor,
    growth,
    nominal_mass,
    reference_stiffness,
    rpm,
    write,
)
from tests.mechanics.test_transverse import complex_disk

BORDER_ROUTE = ROUTE + "; borders by root finding on the spectral radius, to 1e-3 rpm"
SUM_ROUTE = "tests/independent/make_anchors_ch05.py: closed form with 30 digits by mpmath"
PHASE_ROUTE = "tests/independent/make_anchors_ch05.py: exact fractions of a tooth"
MEAN_ROUTE = (
    "tests/independent/make_anchors_ch05.py: complex form of (5-7), its mean and first harmonic by Gauss quadrature, "
    "modes of the mean by scipy's left and right eigenvectors"
)
# Growth in a mesh period from which the package's search calls a speed unstable.
THRESHOLD = 1e-8
BORDER_TOLERANCE = 1e-3

B, LOAD_B = EXAMPLE_B.body, EXAMPLE_B.load
TEETH_B = B.drive.gear_teeth


@cache
def pinion(body, angle_in_turns):
    """Contact of a pinion at an angle that is a fraction of a turn."""
    path = ContactPath(body.drive)
    phase = float(angle_in_turns * body.drive.gear_teeth % 1)
    angle = 2 * np.pi * float(angle_in_turns)

    def position(x):
        state = path.centroid(np.asarray(x) + phase)
        return state.radius, state.angle + angle

    return Pinion(position, sorted((instant - phase) % 1 for instant in path.breakpoints))


def spectral_radius(body, load, turns, speed_rpm):
    k_b = load.stiffness * reference_stiffness(body)
    period = 2 * np.pi / (body.drive.gear_teeth * rpm(speed_rpm))
    found = multipliers(
        complex_disk(body),
        [pinion(body, turn) for turn in turns],
        rpm(speed_rpm),
        period,
        m_p=load.mass * nominal_mass(body),
        c_b=load.damping * k_b,
        k_b=k_b,
    )
    return float(np.abs(found).max()), period


def two(body, teeth):
    """Angles of two pinions, in turns, so many face-gear teeth apart."""
    return (Fraction(0), Fraction(teeth) / body.drive.gear_teeth)


def cell(body, load, turns, speed, **at):
    radius, period = spectral_radius(body, load, turns, speed)
    return growth(radius, period, speed_rpm=speed, **at)


def total_angles(example, places):
    for teeth, speed in places:
        turns = two(example.body, teeth)
        yield cell(example.body, example.load, turns, speed, total_angle=360 * turns[1])


def phases(teeth, places):
    for phase, speed in places:
        yield cell(B, LOAD_B, two(B, teeth + phase), speed, phase=phase)


def loads(name, places, **other):
    for value, speed in places:
        load = replace(LOAD_B, **{**other, name: value})
        yield cell(B, load, (Fraction(0), Fraction(1, 3)), speed, **{name: value})


def four(places):
    half = Fraction(1, 2)
    for teeth, speed in places:
        turn = Fraction(teeth) / TEETH_B
        turns = (Fraction(0), half, turn, turn + half)
        yield cell(B, LOAD_B, turns, speed, total_angle=360 * turn)


def border(variable, body, turns, between, section, tongue):
    """Speed between two speeds where the spectral radius passes the threshold of the package's search."""

    def excess(speed):
        return spectral_radius(body, LOAD_B, turns, speed)[0] - 1 - THRESHOLD

    found = brentq(excess, *between, xtol=BORDER_TOLERANCE / 10)
    return anchor(variable, found, BORDER_TOLERANCE, section=section, tongue=tongue)


def resized(pinion_teeth):
    drive = replace(B.drive, pinion_teeth=pinion_teeth, gear_teeth=5 * pinion_teeth)
    return replace(B, drive=drive)


def phase_relation():
    for tenths in (31, 69, 100, 223):
        teeth = Fraction(tenths, 10) * 52 / 360
        yield anchor("phase", teeth % 1, 1e-9, total_angle=tenths / 10)
        yield anchor("teeth", teeth // 1, 0.1, total_angle=tenths / 10)


def remaining(gear_teeth, angles, number):
    with mpmath.workdps(30):
        turns = [mpmath.mpf(str(angle)) * (gear_teeth + number) / 180 for angle in angles]
        return abs(mpmath.fsum(mpmath.expjpi(turn) for turn in turns))


def chart_two():
    for number, angle in ((0, "92.5"), (-6, "101.2"), (3, "90.75"), (5, "103.0")):
        value = remaining(155, [0, angle], number) / 2
        yield anchor("remaining", value, 1e-9, wave_number=number, total_angle=float(angle))


def chart_arrays():
    for teeth, layout, angles, number in (
        (155, 1, (0, 120, 240), -2),
        (156, 3, (0, 72, 144, 216, 288), 1),
        (157, 6, (0, 100, 200), 4),
        (155, 7, (0, 70, 180, 250), 0),
        (156, 9, (0, 40, 120, 160, 240, 280), -5),
    ):
        value = remaining(teeth, angles, number) / len(angles)
        yield anchor("remaining", value, 1e-9, gear_teeth=teeth, layout=layout, wave_number=number)


def weak():
    for pair, number in ((0, -2), (1, 2), (2, -2)):
        for layout, angles in ((1, ("0", "97.8")), (3, ("0", "80.0", "178.1", "260.5"))):
            yield anchor("phasing_sum", remaining(155, angles, number), 1e-9, pair=pair, layout=layout)


def modulation(contact, harmonic):
    """Coefficient of e^{isωt} of H_nq e^{i(-n+q)θc}/(2πρh)."""
    plate = complex_disk(B)
    n = np.repeat(plate.waves, plate.M + 1)
    points, weights = np.polynomial.legendre.leggauss(60)
    total = np.zeros((n.size, n.size), dtype=complex)
    for start, end in pairwise([*contact.instants, contact.instants[0] + 1]):
        for point, weight in zip(points, weights, strict=True):
            x = (start + end) / 2 + (end - start) / 2 * point
            r, theta = contact.position(x)
            R = np.array([plate.radial(m, abs(k), r) for k in plate.waves for m in range(plate.M + 1)])
            wave = np.exp(1j * theta * (n[None, :] - n[:, None]) - 2j * np.pi * harmonic * x)
            total += (end - start) / 2 * weight * wave * np.outer(R, R) / (2 * np.pi * plate.rho * plate.h)
    return total


def interference():
    """Couplings of modes 1 and 1, and 1 and 2, by each of two pinions."""
    import scipy.linalg

    k_b = LOAD_B.stiffness * reference_stiffness(B)
    m_p, c_b = LOAD_B.mass * nominal_mass(B), LOAD_B.damping * k_b
    for teeth, modes, (k, j), speed, phase in (
        (39, 0, (1, 1), 190.0, Fraction(1, 4)),
        (51, 1, (1, 2), 197.0, Fraction(1, 8)),
        (78, 2, (2, 2), 205.0, Fraction(3, 4)),
    ):
        contacts = [pinion(B, turn) for turn in two(B, teeth + phase)]
        M, C, K = complex_disk(B).constant_matrices(rpm(speed))
        mean = sum(modulation(contact, 0) for contact in contacts)
        M, C, K = M + m_p * mean, C + c_b * mean, K + k_b * mean
        one, zero = np.eye(len(M)), np.zeros_like(M)
        A = np.block([[zero, one], [-K, -C]])
        values, left, right = scipy.linalg.eig(A, np.block([[one, zero], [zero, M]]), left=True)
        up = np.flatnonzero(values.imag > 0)
        up = up[np.argsort(values.imag[up])]
        down = np.flatnonzero(values.imag < 0)
        down = down[np.argsort(-values.imag[down])]
        a, b = up[j - 1], down[k - 1]
        strength = k_b + c_b * values[b] + m_p * values[b] ** 2
        parts = [
            left[len(M) :, a].conj() @ modulation(contact, 1) @ right[: len(M), b] * strength
            for contact in contacts
        ]
        value = abs(sum(parts)) / sum(map(abs, parts))
        yield anchor("interference", value, 1e-6, teeth=teeth, modes=modes, phase=phase)


half, third, quarter = Fraction(1, 2), Fraction(1, 3), Fraction(1, 4)
FILES = {
    "ch05_figure_5_03": (PHASE_ROUTE, phase_relation),
    "ch05_figure_5_05a": (
        ROUTE,
        lambda: total_angles(
            EXAMPLE_A,
            (
                (33 + Fraction(5, 12), 700.0),
                (60 + half, 664.0),
                (64 + Fraction(1, 12), 880.0),
                (50 + quarter, 196.0),
            ),
        ),
    ),
    "ch05_figure_5_05b": (
        ROUTE,
        lambda: total_angles(
            EXAMPLE_B,
            ((51 + quarter, 868.0), (78 + half, 880.0), (45 + Fraction(1, 6), 820.0), (60 + third, 196.0)),
        ),
    ),
    "ch05_figure_5_06": (
        BORDER_ROUTE,
        lambda: (
            *total_angles(EXAMPLE_B, ((78, 870.0), (39, 195.0))),
            border("lower", B, two(B, 78), (838.0, 839.0), 360 * 78 / TEETH_B, 2),
        ),
    ),
    "ch05_figure_5_07a": (ROUTE, lambda: phases(39, ((quarter, 880.0), (Fraction(3, 4), 868.0)))),
    "ch05_figure_5_07b": (ROUTE, lambda: phases(51, ((half, 820.0), (quarter, 868.0)))),
    "ch05_figure_5_07c": (ROUTE, lambda: phases(78, ((half, 880.0), (quarter, 868.0)))),
    "ch05_figure_5_08": (ROUTE, lambda: loads("mass", ((1.5, 850.0), (1.9, 800.0)))),
    "ch05_figure_5_09a": (ROUTE, lambda: loads("stiffness", ((0.1, 850.0), (0.25, 860.0)))),
    "ch05_figure_5_09b": (ROUTE, lambda: loads("stiffness", ((0.1, 850.0),), mass=0.4)),
    "ch05_figure_5_10": (ROUTE, lambda: loads("damping", ((5e-6, 860.0), (2e-5, 860.0)))),
    "ch05_figure_5_11a": (
        BORDER_ROUTE,
        lambda: [border("lower", B, (Fraction(0), quarter), (861.0, 862.5), 31, 2)],
    ),
    "ch05_figure_5_11b": (
        BORDER_ROUTE,
        lambda: [border("upper", resized(32), (Fraction(0), third), (826.5, 828.0), 32, 2)],
    ),
    "ch05_figure_5_11c": (
        BORDER_ROUTE,
        lambda: [border("lower", resized(33), (Fraction(0), half), (727.5, 729.0), 33, 3)],
    ),
    "ch05_weak": (SUM_ROUTE, weak),
    "ch05_interference": (MEAN_ROUTE, interference),
    "ch05_chart_two": (SUM_ROUTE, chart_two),
    "ch05_chart_arrays": (SUM_ROUTE, chart_arrays),
    "ch05_equal_pinions": (
        BORDER_ROUTE,
        lambda: [border("lower", B, (Fraction(0), third, 2 * third), (804.8, 805.8), 3, 3)],
    ),
    "ch05_four_pinions": (ROUTE, lambda: four(((40, 868.0), (38 + half, 892.0)))),
}


def main():
    """Make the anchors of the files named on the command line, of all when none is."""
    chosen = sys.argv[1:] or list(FILES)
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name in tqdm(chosen):
        route, make = FILES[name]
        write(name, route, make())


if __name__ == "__main__":
    main()
