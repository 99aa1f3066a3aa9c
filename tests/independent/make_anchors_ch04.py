"""Compute the anchors of chapter 4 and write them to data/anchors: `python -m tests.independent.make_anchors_ch04`.

Takes some minutes. Multipliers come from :mod:`tests.independent.complex_galerkin`; of the package it uses the
radial mode functions and the contact centroid, which chapter 3's anchors and the tests of the plate hold. Radial
modes come from mpmath. Nothing is assembled by the package.
"""

import sys
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import yaml
from scipy.optimize import brentq
from tqdm import tqdm

from facegear import ContactPath, replace_parameter, tongues
from facegear.mechanics.cases import CASE_1, CASE_2, FIGURES
from tests.independent import meshing_mpmath
from tests.independent.complex_galerkin import Pinion, first_order_growth, multipliers, total_rate_multipliers
from tests.mechanics.test_transverse import complex_disk

FOLDER = Path(__file__).resolve().parents[2] / "data" / "anchors"
ROUTE = (
    "tests/independent/complex_galerkin.py: (4-8) to (4-13) in complex exponentials, one smooth piece of the period "
    "after the other by DOP853 at 1e-12; tolerance 1e-8 of the spectral radius"
)
PLATE_ROUTE = (
    "tests/independent/make_anchors_ch04.py: boundary determinant of Bessel functions by mpmath, 30 digits"
)
MESH_ROUTE = (
    "tests/independent/meshing_mpmath.py: contact centroid from a shaper moved numerically, 30 digits"
)
TOTAL_ROUTE = (
    "tests/independent/complex_galerkin.py: momentum form of the total rate in complex exponentials, without kicks, by "
    "DOP853 at 1e-12; tolerance 1e-8 of the spectral radius"
)
MEAN_ROUTE = (
    "tests/independent/complex_galerkin.py: complex form with its periodic matrices averaged over a mesh period; "
    "borders from the pair alone, averaged to first order with Fourier coefficients by quadrature"
)
RADIUS_TOLERANCE = 1e-8
CELLS, HIGHEST_RPM = 200, 1000.0

# Rows and columns (from 1) of the 200 x 200 maps: inside tongues, on either side of borders, at low speed, in safety.
PLACES = {
    "4.4a": [(1, 106), (82, 110), (82, 111), (110, 113), (42, 54), (17, 179), (60, 8), (190, 150)],
    "4.4b": [(1, 108), (19, 104), (19, 105), (76, 170), (6, 57), (55, 178), (100, 8), (190, 108)],
    "4.4c": [(200, 105), (117, 48), (78, 165), (78, 166), (117, 67), (197, 185), (3, 42), (150, 8)],
    "4.5a": [(1, 116), (100, 155), (100, 156), (33, 157), (16, 117), (28, 200), (50, 8), (180, 60)],
    "4.5b": [(1, 117), (110, 116), (110, 117), (9, 125), (24, 118), (42, 199), (100, 8), (190, 154)],
    "4.5c": [(200, 115), (128, 51), (63, 117), (63, 118), (122, 145), (178, 155), (60, 8), (20, 100)],
}
# With the geometric contact ratio: the strongest growth, and cells that Tregold's makes unstable.
GEOMETRIC_PLACES = {
    "4.4a": [(1, 106), (1, 107), (42, 108), (17, 179)],
    "4.5a": [(1, 116), (16, 117), (28, 200)],
}


def rpm(value):
    return value * np.pi / 30


@cache
def reference_stiffness(body):
    middle = (body.drive.inner_radius + body.drive.outer_radius) / 2
    return float(
        np.mean([complex_disk(body).stiffness_at(middle, v) for v in np.linspace(0, rpm(1000.0), 101)])
    )


def nominal_mass(body):
    return body.material.density * np.pi * body.drive.pitch_radius**2 * body.drive.face_width


@cache
def pinion(body, contact_ratio, sense):
    path = ContactPath(body.drive, body.drive.contact_ratio if contact_ratio is None else contact_ratio)

    def position(x):
        state = path.centroid(np.asarray(x))
        return state.radius, sense * state.angle

    return Pinion(position, path.breakpoints)


def spectral_radius(
    body, speed_rpm, *, stiffness, damping, mass, contact_ratio=None, reference=None, sense=1
):
    k_b = stiffness * reference_stiffness(body if reference is None else reference)
    period = 2 * np.pi / (body.drive.gear_teeth * rpm(speed_rpm))
    found = multipliers(
        complex_disk(body),
        [pinion(body, contact_ratio, sense)],
        rpm(speed_rpm),
        period,
        m_p=mass * nominal_mass(body),
        c_b=damping * k_b,
        k_b=k_b,
    )
    return float(np.abs(found).max()), period


def anchor(variable, value, atol, **at):
    return {
        "variable": variable,
        "at": {k: float(v) for k, v in at.items()},
        "value": float(value),
        "atol": float(atol),
    }


def load_of(figure, value):
    parameters = {name: getattr(figure.load, name) for name in ("stiffness", "damping", "mass")}
    return parameters | {figure.parameter: value}


def cells(number, contact_ratio=None, places=None):
    figure = FIGURES[number]
    for row, column in PLACES[number] if places is None else places:
        value, speed = figure.highest * row / CELLS, HIGHEST_RPM * column / CELLS
        radius, period = spectral_radius(
            figure.body, speed, contact_ratio=contact_ratio, **load_of(figure, value)
        )
        yield growth(radius, period, **{figure.parameter: value, "speed_rpm": speed})


def growth(radius, period, **at):
    """Anchor of a growth rate, with the tolerance of the spectral radius."""
    return anchor("growth_rate", np.log(radius) / period, RADIUS_TOLERANCE / (radius * period), **at)


def convergence():
    """Follow the line of Fig. 4.4(c) at τ = 1, bearing held, with the coarsest and the finest basis."""
    load = {"stiffness": 0.6, "damping": 3e-6, "mass": 1.0}
    for basis, (circles, diameters), speeds in ((0, (1, 3), (500, 540)), (2, (3, 8), (495, 540, 660))):
        body = replace(CASE_1, nodal_circles=circles, nodal_diameters=diameters)
        for speed in speeds:
            radius, period = spectral_radius(body, speed, reference=CASE_1, **load)
            yield growth(radius, period, basis=basis, speed_rpm=speed)


def with_disk():
    for value, speed in ((0.02, 530.0), (0.5, 660.0), (0.8, 850.0), (1.6, 300.0)):
        radius, period = spectral_radius(CASE_1, speed, sense=-1, **load_of(FIGURES["4.4a"], value))
        yield growth(radius, period, stiffness=value, speed_rpm=speed)


def total(contact_ratio, places):
    for value, speed in places:
        k_b = value * reference_stiffness(CASE_1)
        period = 2 * np.pi / (CASE_1.drive.gear_teeth * rpm(speed))
        found = total_rate_multipliers(
            complex_disk(CASE_1),
            pinion(CASE_1, contact_ratio, 1),
            rpm(speed),
            period,
            m_p=nominal_mass(CASE_1),
            c_b=3e-6 * k_b,
            k_b=k_b,
        )
        yield growth(np.abs(found).max(), period, stiffness=value, speed_rpm=speed)


def skew_line(places):
    """Load at the mean radius of the pairs in contact, each running down (3-22): r = R2 - (R2 - R1) t/(cr T0)."""
    drive, ratio = CASE_1.drive, CASE_1.drive.contact_ratio

    def position(x):
        times = np.asarray(x, dtype=float)[..., None] + np.arange(int(np.ceil(ratio)))
        radii = drive.outer_radius - (drive.outer_radius - drive.inner_radius) * times / ratio
        touching = times < ratio
        return (radii * touching).sum(axis=-1) / touching.sum(axis=-1), np.zeros(np.shape(x))

    for value, speed in places:
        k_b = value * reference_stiffness(CASE_1)
        period = 2 * np.pi / (drive.gear_teeth * rpm(speed))
        found = multipliers(
            complex_disk(CASE_1),
            [Pinion(position, (0.0, ratio % 1.0))],
            rpm(speed),
            period,
            m_p=nominal_mass(CASE_1),
            c_b=3e-6 * k_b,
            k_b=k_b,
        )
        yield growth(np.abs(found).max(), period, stiffness=value, speed_rpm=speed)


def slow_tongues():
    """Growth at the peaks of the tongues of Fig. 4.4(a) between 25 and 100 rpm, μ = 0.25."""
    load = load_of(FIGURES["4.4a"], 0.25)
    model = replace_parameter(FIGURES["4.4a"].model(), "stiffness", 0.25)
    for number, tongue in enumerate(tongues(model, (rpm(25.0), rpm(100.0)))):
        radius, period = spectral_radius(CASE_1, tongue.peak * 30 / np.pi, **load)
        tolerance = 10 * RADIUS_TOLERANCE / (radius * period)
        yield anchor("largest_growth", np.log(radius) / period, tolerance, section=0.25, tongue=number)


def masses():
    for mass, value, speed in ((0.5, 0.2, 540.0), (0.75, 0.4, 660.0), (1.0, 0.6, 540.0), (1.5, 0.6, 860.0)):
        radius, period = spectral_radius(CASE_1, speed, stiffness=value, damping=3e-6, mass=mass)
        yield growth(radius, period, mass=mass, stiffness=value, speed_rpm=speed)


def mean_frequencies(body, speed, *, stiffness, damping, mass):
    """Natural frequencies of the complex form with M(t), C(t), K(t) replaced by their means over a period."""
    plate, contact = complex_disk(body), pinion(body, None, 1)
    M, C, K = plate.constant_matrices(rpm(speed))
    n = np.repeat(plate.waves, plate.M + 1)
    points, weights = np.polynomial.legendre.leggauss(40)
    edges = np.append(contact.instants, 1.0)
    mean = np.zeros_like(M)
    for start, end in pairwise(edges):
        for point, weight in zip(points, weights, strict=True):
            r, theta = contact.position((start + end) / 2 + (end - start) / 2 * point)
            R = np.array([plate.radial(m, abs(k), r) for k in plate.waves for m in range(plate.M + 1)])
            wave = np.exp(1j * theta * (n[None, :] - n[:, None]))
            mean += (end - start) / 2 * weight * wave * np.outer(R, R) / (2 * np.pi * plate.rho * plate.h)
    k_b = stiffness * reference_stiffness(body)
    M = M + mean * mass * nominal_mass(body)
    C, K = C + mean * damping * k_b, K + mean * k_b
    zero, one = np.zeros_like(M), np.eye(len(M))
    A = np.block([[zero, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    found = np.linalg.eigvals(A).imag
    return np.sort(found[found > 0])


# Below, at, above the window; where the maps of Figs 4.4(a) and 4.5(a) end, and far above.
WIDE_PLACES = {
    "4.4a": ((0.5, 540.0), (1.9, 560.0), (2.5, 400.0), (5.0, 390.0), (5.0, 500.0), (8.0, 370.0)),
    "4.5a": ((0.5, 590.0), (1.0, 590.0), (1.8, 430.0), (2.4, 450.0), (5.0, 280.0), (5.0, 400.0)),
}


def wide(number):
    """Cells of the maps over a wide range of bearing stiffness."""
    figure = FIGURES[number]
    for value, speed in WIDE_PLACES[number]:
        radius, period = spectral_radius(figure.body, speed, **load_of(figure, value))
        yield growth(radius, period, stiffness=value, speed_rpm=speed)


# Bearing stiffnesses and speeds [rpm] within which one tongue of each kind stands.
RULE_PLACES = {
    "4.4a": ((0.5, (500, 553)), (2.5, (380, 416)), (5.0, (220, 230)), (8.0, (320, 410))),
    "4.5a": ((0.3, (560, 610)), (1.8, (420, 450)), (4.0, (250, 270)), (8.0, (340, 425))),
}


def rule(number, stiffnesses):
    """Natural frequencies of the mean system that combine in single tongues, and that of pinion and bearing [Hz].

    The package says where the tongue peaks, and which numbers the frequencies have.
    """
    figure = FIGURES[number]
    row = 0
    for value in stiffnesses:
        model = replace_parameter(figure.model(), "stiffness", value)
        for tongue in tongues(model, (rpm(100.0), rpm(1000.0))):
            peak = tongue.peak * 30 / np.pi
            if any(value == at and low < peak < high for at, (low, high) in RULE_PLACES[number]):
                hertz = mean_frequencies(figure.body, peak, **load_of(figure, value)) / (2 * np.pi)
                pair = hertz[tongue.combination.k - 1], hertz[tongue.combination.j - 1]
                meshing = figure.body.drive.gear_teeth * peak / 60
                off = {1: abs(pair[0] + pair[1] - meshing), -1: abs(pair[1] - pair[0] - meshing)}
                yield anchor("first", pair[0], 0.01, tongue=row)
                yield anchor("second", pair[1], 0.01, tongue=row)
                yield anchor("sign", min(off, key=off.get), 1e-9, tongue=row)
                own = value * reference_stiffness(figure.body) / nominal_mass(figure.body)
                yield anchor("bearing", np.sqrt(own) / (2 * np.pi), 1e-5, tongue=row)
            row += 1


def hsu():
    """Centres and borders of bands in which two frequencies of the mean system add up to meshing, μ = 0.25."""
    load = {"stiffness": 0.25, "damping": 3e-6, "mass": 1.0}
    for band, (k, j), between in (
        (5, (1, 8), (480, 580)),
        (6, (1, 9), (500, 600)),
        (10, (1, 13), (750, 950)),
    ):

        def detuning(speed, k=k, j=j):
            frequencies = mean_frequencies(CASE_1, speed, **load)
            return CASE_1.drive.gear_teeth * rpm(speed) - frequencies[k - 1] - frequencies[j - 1]

        centre = brentq(detuning, *between, xtol=1e-9)
        yield anchor("centre", centre, 1e-5, section=0.25, band=band)

        def rate(speed, k=k, j=j):
            k_b = load["stiffness"] * reference_stiffness(CASE_1)
            return first_order_growth(
                complex_disk(CASE_1),
                pinion(CASE_1, None, 1),
                rpm(speed),
                2 * np.pi / (CASE_1.drive.gear_teeth * rpm(speed)),
                (k, j),
                1,
                m_p=load["mass"] * nominal_mass(CASE_1),
                c_b=load["damping"] * k_b,
                k_b=k_b,
            )

        for side, outside in (("lower", 0.9 * centre), ("upper", 1.1 * centre)):
            yield anchor(side, brentq(rate, centre, outside, xtol=1e-8), 1e-4, section=0.25, band=band)


def determinant(body, n, root):
    """Boundary matrix of (4-4) for J, Y, I, K of λr/a, second derivatives in r."""
    nu, c = mpmath.mpf(body.material.poissons_ratio), mpmath.mpf(body.bore_ratio)
    rows = [[], [], [], []]
    # f_n' = (lower f_(n-1) + upper f_(n+1))/2
    for f, lower, upper in (
        (mpmath.besselj, 1, -1),
        (mpmath.bessely, 1, -1),
        (mpmath.besseli, 1, 1),
        (mpmath.besselk, -1, -1),
    ):

        def derivative(k, x, order, f=f, lower=lower, upper=upper):
            if order == 0:
                return f(k, x)
            return (lower * derivative(k - 1, x, order - 1) + upper * derivative(k + 1, x, order - 1)) / 2

        def w(x, order=0, derivative=derivative):
            return root**order * derivative(n, root * x, order)

        one = mpmath.mpf(1)
        d0, d1, d2, d3 = (w(one, order) for order in range(4))
        rows[0].append(w(c))
        rows[1].append(w(c, 1))
        rows[2].append(d2 + nu * (d1 - n**2 * d0))
        # d/dr (w'' + w'/r - n² w/r²) - (1-ν) n² (w' - w) at r = 1
        rows[3].append(d3 + d2 - d1 - n**2 * (d1 - 2 * d0) - (1 - nu) * n**2 * (d1 - d0))
    return mpmath.det(mpmath.matrix(rows))


def plate():
    mpmath.mp.dps = 30
    body = CASE_1
    rigidity = body.material.youngs_modulus * body.thickness**2 / 12 / (1 - body.material.poissons_ratio**2)
    factor = np.sqrt(rigidity / body.material.density) / body.outer_radius**2 / (2 * np.pi)
    for n in range(4):
        found = sign_changes(lambda x, n=n: determinant(body, n, x), 1.0, 9.0, 2)
        for m, root in enumerate(found):
            frequency = float(root**2) * factor
            yield anchor("frequency", frequency, 1e-9 * frequency, circles=m, diameters=n)


def sign_changes(function, low, high, count):
    """First roots of a function above `low`, by a fine scan and bisection-safe secants."""
    grid = [mpmath.mpf(low) + mpmath.mpf(k) / 5 for k in range(int(5 * (high - low)) + 1)]
    with mpmath.workdps(15):
        values = [function(x) for x in grid]
    roots = []
    for left, right, a, b in zip(grid, grid[1:], values, values[1:], strict=False):
        if a * b < 0:
            roots.append(mpmath.findroot(function, (left, right), solver="anderson"))
    return roots[:count]


def stiffness(body):
    radii = (body.drive.inner_radius, (body.drive.inner_radius + body.drive.outer_radius) / 2)
    for speed in (0.0, 500.0, 1000.0):
        for place, radius in zip((0.0, 0.5), radii, strict=True):
            value = complex_disk(body).stiffness_at(radius, rpm(speed))
            yield anchor("stiffness", value, 1e-8 * value, place=place, speed_rpm=speed)
    yield anchor("reference", reference_stiffness(body), 1e-8 * reference_stiffness(body))


def centroid():
    drive = meshing_mpmath.Drive(26, 130, "3.175e-3")
    for ratio in (meshing_mpmath.tregold_contact_ratio(drive), meshing_mpmath.geometric_contact_ratio(drive)):
        for time in ("0.1", "0.4", "0.75"):
            radius, angle = meshing_mpmath.contact_centroid(drive, time, ratio)
            travel = ratio / meshing_mpmath.geometric_contact_ratio(drive)
            at = {"contact_ratio": ratio, "time": time}
            yield anchor("radius", radius, 1e-11, **at)
            yield anchor("angle", angle * travel, 1e-10, **at)


def write(name, route, anchors):
    content = {"figure": name, "route": route, "anchors": list(anchors)}
    text = yaml.safe_dump(content, sort_keys=False, width=110)
    (FOLDER / f"{name}.yaml").write_text(text, encoding="utf-8")


FILES = {
    **{
        f"ch04_figure_{number.replace('.', '_0')}": (ROUTE, lambda number=number: cells(number))
        for number in FIGURES
    },
    **{
        f"ch04_geometric_{number.replace('.', '_0')}": (
            ROUTE,
            lambda number=number: cells(
                number, FIGURES[number].body.drive.geometric_contact_ratio, GEOMETRIC_PLACES[number]
            ),
        )
        for number in GEOMETRIC_PLACES
    },
    "ch04_plate_modes": (PLATE_ROUTE, plate),
    "ch04_stiffness_case_1": (ROUTE, lambda: stiffness(CASE_1)),
    "ch04_stiffness_case_2": (ROUTE, lambda: stiffness(CASE_2)),
    "ch04_centroid_clocks": (MESH_ROUTE, centroid),
    "ch04_convergence": (ROUTE, convergence),
    "ch04_with_disk_4_04a": (ROUTE, with_disk),
    "ch04_pinion_mass": (ROUTE, masses),
    "ch04_total_4_04a": (TOTAL_ROUTE, lambda: total(None, ((0.02, 530.0), (0.5, 660.0), (1.6, 900.0)))),
    "ch04_total_geometric_4_04a": (
        TOTAL_ROUTE,
        lambda: total(CASE_1.drive.geometric_contact_ratio, ((0.02, 530.0), (0.5, 660.0), (1.6, 900.0))),
    ),
    "ch04_hsu": (MEAN_ROUTE, hsu),
    "ch04_skew_line_4_04a": (
        ROUTE,
        lambda: skew_line(
            ((0.08, 265.0), (0.11, 130.0), (0.35, 535.0), (0.76, 340.0), (0.5, 660.0), (1.6, 300.0))
        ),
    ),
    "ch04_slow_tongues": (ROUTE, slow_tongues),
    "ch04_wide_4_04a": (ROUTE, lambda: wide("4.4a")),
    "ch04_wide_4_05a": (ROUTE, lambda: wide("4.5a")),
    "ch04_rule_4_04a": (MEAN_ROUTE, lambda: rule("4.4a", (0.5, 1.5, 2.5, 5.0, 8.0))),
    "ch04_rule_4_05a": (MEAN_ROUTE, lambda: rule("4.5a", (0.3, 0.6, 1.8, 4.0, 8.0))),
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
