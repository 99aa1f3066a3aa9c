"""Compute the anchors of chapter 7 and write them to data/anchors: `python -m tests.independent.make_anchors_ch07`.

Takes some minutes. Multipliers come from :mod:`tests.independent.torsional_switching`, Hsu's borders from (7-16) to
(7-18) and the growth rate that follows from (2-26) to (2-28), with the same typed matrices and quadrature. Of the
package only the drive's radii and contact ratio are used, which chapter 3's anchors hold, and the captions.
"""

import math
import sys
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import yaml
from scipy.optimize import brentq
from tqdm import tqdm

from facegear.floquet.models import replace_parameter
from facegear.mechanics.gearboxes import DRIVE, FIGURES
from tests.independent.torsional_switching import matrices, numbers_of, skew_line, spectral_radius

FOLDER = Path(__file__).resolve().parents[2] / "data" / "anchors"
ROUTE = (
    "tests/independent/torsional_switching.py: (7-10) to (7-13) typed from the text, integrated by DOP853 at 1e-13 "
    "from one switch of a tooth pair to the next; tolerance 1e-10 of the spectral radius, 1e-4 rpm of borders"
)
HSU_ROUTE = (
    "tests/independent/torsional_switching.py and make_anchors_ch07.py: borders of tongues by DOP853 and root finding, "
    "Hsu's borders from (7-16) to (7-18) by quadrature and the growth rate (2-26) to (2-28)"
)
MEAN_ROUTE = (
    "tests/independent/make_anchors_ch07.py: eigenvalues of the typed matrices averaged by quadrature, "
    "face gear at rest"
)
ARM_ROUTE = "tests/independent/make_anchors_ch07.py: (3-22) and the equation of meshing by hand"
RADIUS_TOLERANCE = 1e-10
BORDER_TOLERANCE = 1e-4
COLUMNS, ROWS, NATURAL = 400, 32, 201

# Rows and columns (from 0) of the maps: strongest growth, just inside and just outside of borders, in safety.
PLACES = {
    "7.9a": [(28, 298), (24, 120), (20, 331), (26, 230), (31, 296)],
    "7.9b": [(28, 364), (24, 13), (20, 336), (26, 230), (31, 147)],
    "7.11a": [(4, 263), (8, 23), (12, 242), (26, 230), (31, 305)],
    "7.11b": [(4, 264), (8, 99), (12, 248), (26, 230), (31, 328)],
    "7.12a": [(4, 238), (8, 94), (12, 218), (26, 230), (31, 299)],
    "7.12b": [(4, 101), (8, 85), (12, 301), (26, 230), (31, 111)],
    "7.13a": [(4, 243), (8, 93), (12, 229), (26, 258), (31, 350)],
    "7.13b": [(4, 101), (8, 85), (12, 300), (26, 230), (31, 111)],
}
# At a damping of 1 µs, by place in the table: border by Floquet (0 lower, 1 upper) and where to look for it [rpm].
FLOQUET_BORDERS = {
    "7.12a": [(0, 0, 156.4), (0, 1, 160.6), (2, 1, 324.3), (3, 0, 592.4)],
    "7.12b": [(7, 0, 274.5), (12, 1, 802.6)],
    "7.13a": [(0, 0, 154.8), (3, 0, 559.8), (3, 1, 582.8), (4, 1, 680.0)],
    "7.13b": [(5, 1, 321.5), (9, 0, 766.9)],
}
# The same by Hsu's method: place, modes k and j, order, border and where to look.
HSU_BORDERS = {
    "7.12a": [(1, 1, 1, 3, 0, 212.4), (2, 1, 1, 2, 1, 325.2), (3, 1, 1, 1, 0, 602.3)],
    "7.12b": [(7, 1, 1, 1, 1, 323.1), (12, 1, 3, 2, 0, 773.7)],
    "7.13a": [(1, 1, 1, 3, 1, 216.9), (4, 1, 1, 1, 0, 602.5), (4, 1, 1, 1, 1, 681.7)],
    "7.13b": [(5, 1, 1, 1, 0, 278.2), (8, 1, 3, 3, 1, 542.5)],
}


def axis(figure, count):
    if figure.scale == "log":
        return np.geomspace(figure.lowest, figure.highest, count)
    return np.linspace(figure.lowest, figure.highest, count)


def numbers(figure, value):
    return numbers_of(replace_parameter(figure.model(), figure.parameter, float(value)))


def growth_anchor(name, row, column):
    figure = FIGURES[name]
    value = float(axis(figure, ROWS)[row])
    speed = float(np.linspace(figure.lowest_rpm, 1000.0, COLUMNS)[column])
    radius = spectral_radius(numbers(figure, value), speed)
    per_period = DRIVE.gear_teeth * speed / 60.0
    return {
        "variable": "growth_rate",
        "at": {figure.parameter: value, "speed_rpm": speed},
        "value": math.log(radius) * per_period,
        "atol": RADIUS_TOLERANCE / radius * per_period,
    }


def floquet_border(n, guess):
    return brentq(lambda speed: spectral_radius(n, speed) - 1.0, guess - 0.25, guess + 0.25, xtol=1e-7)


@cache
def coefficients(n, speed, order):
    """Mean and harmonic s of C and K (7-16), Gauss quadrature between the switches."""
    T0 = 60.0 / (n.N2 * speed)
    radius = skew_line(n)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    total = np.zeros((2, 3, 3, 3))
    for start, stop in pairwise((0.0, n.cr - 1.0, 1.0)):
        middle = (start + stop) / 2
        meshing = [pair for pair in range(2) if middle + pair < n.cr]
        for node, weight in zip(nodes, weights, strict=True):
            x = middle + node * (stop - start) / 2
            both = np.array(matrices(n, x, T0, meshing, radius, middle))
            angle = 2 * np.pi * order * x
            for i, kernel in enumerate((1.0, 2 * np.cos(angle), 2 * np.sin(angle))):
                total[:, i] += weight * (stop - start) / 2 * kernel * both
    return T0, total


def hsu_growth(n, speed, k, j, order):
    """σ of a sum of frequencies k and j, (7-17), (7-18) and (2-26) to (2-28)."""
    T0, ((F0, F, G), (U0, D, E)) = coefficients(n, speed, order)
    M = np.diag([n.J1, n.J2, n.Jo])
    squares, right = np.linalg.eig(np.linalg.solve(M, U0))
    right = right[:, np.argsort(squares)]
    w_k, w_j = np.sqrt(np.sort(squares))[[k - 1, j - 1]]
    left = np.linalg.inv(right)
    f0, f, g, d, e = (left @ np.linalg.solve(M, part) @ right for part in (F0, F, G, D, E))

    a, b = k - 1, j - 1
    A_kj, A_jk = d[a, b] - w_j * g[a, b], d[b, a] - w_k * g[b, a]
    B_kj, B_jk = e[a, b] + w_j * f[a, b], e[b, a] + w_k * f[b, a]
    detuning = order * 2 * np.pi / T0 - (w_k + w_j)
    f_k, f_j = f0[a, a], f0[b, b]
    xi = (f_k - f_j) ** 2 - 4 * detuning**2 + (A_kj * A_jk + B_kj * B_jk) / (w_k * w_j)
    eta = 4 * detuning * (f_j - f_k) + (B_kj * A_jk - A_kj * B_jk) / (w_k * w_j)
    return (math.sqrt((math.hypot(xi, eta) + xi) / 2) - (f_k + f_j)) / 4


def hsu_border(n, k, j, order, guess):
    return brentq(lambda v: hsu_growth(n, v, k, j, order), guess - 0.5, guess + 0.5, xtol=1e-8)


def natural_anchors(name):
    figure = FIGURES[name]
    anchors = []
    values = axis(figure, NATURAL)
    for place in (0, 40, NATURAL - 1):
        n = numbers(figure, values[place])
        still = type(n)(**{**vars(n), "cm": 0.0})
        _, (_, (U0, _, _)) = coefficients(still, 100.0, 1)
        squares = np.linalg.eigvals(np.linalg.solve(np.diag([n.J1, n.J2, n.Jo]), U0))
        for mode, square in enumerate(np.sort(squares), start=1):
            frequency = math.sqrt(square) / (2 * math.pi)
            at = {"mode": mode, figure.parameter: float(values[place])}
            anchors.append({"variable": "frequency", "at": at, "value": frequency, "atol": 1e-8 * frequency})
            speed = 60.0 * frequency / n.N2
            anchors.append({"variable": "natural_speed", "at": at, "value": speed, "atol": 1e-8 * speed})
    return anchors


def arm_anchors():
    n = numbers_of(FIGURES["7.12a"].model())
    cosine = math.cos(n.alpha_c)
    time = 2.0 * (np.arange(402) + 0.5) / 402
    anchors = [{"variable": "conjugate", "at": {}, "value": n.rb1 * 107 / 31, "atol": 1e-12}]
    for index, pair in ((0, 0), (60, 0), (200, 0), (30, 1), (300, 0), (280, 1)):
        age = time[index] % 1.0 + pair
        value = (n.R2 - (n.R2 - n.R1) * age / n.cr) * cosine
        at = {"pair": pair, "time": float(time[index])}
        anchors.append({"variable": "printed", "at": at, "value": value, "atol": 1e-12})
    for index, count in ((0, 2), (100, 2), (150, 1), (250, 2), (390, 1)):
        anchors.append(
            {"variable": "pairs", "at": {"time": float(time[index])}, "value": count, "atol": 1e-12}
        )
    return anchors


def write(name, route, anchors):
    text = yaml.safe_dump(
        {"figure": name, "route": route, "anchors": anchors}, sort_keys=False, allow_unicode=True, width=110
    )
    (FOLDER / f"{name}.yaml").write_text(text, encoding="utf-8")


def plain(anchors):
    """Plain numbers, which YAML can write."""
    return [
        {
            "variable": anchor["variable"],
            "at": {key: float(value) for key, value in anchor["at"].items()},
            "value": float(anchor["value"]),
            "atol": float(anchor["atol"]),
        }
        for anchor in anchors
    ]


def figure_name(name):
    chapter, rest = name.split(".")
    return f"ch07_figure_{chapter}_{rest[:-1].zfill(2)}{rest[-1]}"


def main():
    write("ch07_moment_arms", ARM_ROUTE, plain(arm_anchors()))
    for name in ("7.8a", "7.8b", "7.10a", "7.10b"):
        write(figure_name(name), MEAN_ROUTE, plain(natural_anchors(name)))
    for name, cells in PLACES.items():
        progress = tqdm(cells, desc=name, file=sys.stdout, disable=not sys.stdout.isatty())
        write(figure_name(name), ROUTE, plain([growth_anchor(name, *cell) for cell in progress]))
    for name, borders in FLOQUET_BORDERS.items():
        n = numbers(FIGURES[name], 1e-6)
        anchors = [
            {
                "variable": "floquet",
                "at": {"resonance": place, "border": side},
                "value": floquet_border(n, guess),
                "atol": BORDER_TOLERANCE,
            }
            for place, side, guess in borders
        ]
        for place, k, j, order, side, guess in HSU_BORDERS[name]:
            at = {"resonance": place, "border": side}
            value = hsu_border(n, k, j, order, guess)
            anchors.append({"variable": "hsu", "at": at, "value": value, "atol": BORDER_TOLERANCE})
        write(f"ch07_resonances_{name.replace('.', '_')}", HSU_ROUTE, plain(anchors))


if __name__ == "__main__":
    main()
