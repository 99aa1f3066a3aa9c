"""Compute the anchors of the chapter on shafts with mass: `python -m tests.independent.make_anchors_ch08_shafts`.

Takes some minutes. Shafts are cut into quadratic finite elements (:mod:`tests.independent.shafts_by_elements`), whole
or reduced to their lowest modes, and DOP853 goes over the mesh period with the mesh typed from the text.
"""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import yaml
from scipy.integrate import quad
from scipy.linalg import eigh
from scipy.optimize import brentq

import facegear as fg
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.labelled import load
from tests.independent.shafts_by_elements import gearbox, growth_rate, reduced_gearbox
from tests.independent.torsional_switching import matrices, numbers_of, skew_line, spectral_radius

DATA = Path(__file__).resolve().parents[2] / "data"
ELEMENTS = "tests/independent/shafts_by_elements.py: quadratic finite elements"
DOP = f"{ELEMENTS} of the shafts, DOP853 over the mesh period"
E, NU, RHO = 200e9, 0.3, 7840.0
G = E / (2.0 * (1.0 + NU))
ONE = fg.replace_parameter(FIGURES["7.13a"].model(), "output_damping", 2e-6)
TWO = FIGURES["7.12a"].model()


def lengths_of(model, length):
    """Input and output shaft of the two gearboxes of the chapter."""
    return (0.03, length) if model is ONE else (length, length)


def with_mean_mesh(n, stiffness):
    """Add the mean of the mesh's stiffness over the period, without its part from the rate of the arm."""
    points, weights = np.polynomial.legendre.leggauss(8)
    found, radius = stiffness.copy(), skew_line(n)
    ends = (0.0, n.cr - math.floor(n.cr), 1.0)
    for start, stop in pairwise(ends):
        for point, weight in zip(points, weights, strict=True):
            x = start + (stop - start) * (point + 1.0) / 2.0
            meshing = [pair for pair in range(math.ceil(n.cr)) if x + pair < n.cr]
            # An endless period takes out the rate.
            own = matrices(n, x, 1e30, meshing, radius, x)[1] - matrices(n, x, 1e30, [], radius, x)[1]
            found[:3, :3] += weight * (stop - start) / 2.0 * own
    return found


def frequencies(n, constant, count):
    mass, _, stiffness = constant
    return np.sqrt(eigh(with_mean_mesh(n, stiffness), mass, eigvals_only=True)[:count])


def speed_rpm(n, frequency):
    return 60.0 * frequency / (2.0 * np.pi * n.N2)


def speeds(model):
    def anchors(stored):
        n = numbers_of(model)
        for index in (3, stored.sizes["length"] // 2, -1):
            length = float(stored.length[index])
            both = lengths_of(model, length)
            exact = speed_rpm(n, frequencies(n, gearbox(n, *both, G, RHO, (80, 80)), 4))
            reduced = speed_rpm(n, frequencies(n, reduced_gearbox(n, *both, G, RHO, 2, 80), 4))
            for mode in (1, 2, 3, 4):
                for name, found in (("exact", exact), ("reduced", reduced)):
                    value = float(found[mode - 1])
                    at = {"mode": mode, "length": length}
                    yield {"variable": name, "at": at, "value": value, "atol": 1e-7 * value}

    return anchors


def convergence(stored):
    n, both = numbers_of(ONE), (0.03, 0.4)
    exact = frequencies(n, gearbox(n, *both, G, RHO, (80, 80)), 4)
    for modes in (1, 2, 4):
        found = frequencies(n, reduced_gearbox(n, *both, G, RHO, modes, 80), 4)
        for mode in (1, 2, 3):
            value = float(found[mode - 1] / exact[mode - 1] - 1.0)
            yield {
                "variable": "frequency",
                "at": {"mode": mode, "modes": modes},
                "value": value,
                "atol": 1e-7,
            }
    truth = growth_rate(n, gearbox(n, *both, G, RHO, (1, 12)), 508.0)
    for modes in (0, 1, 2):
        own = growth_rate(n, reduced_gearbox(n, *both, G, RHO, modes, 60), 508.0)
        yield {"variable": "growth", "at": {"modes": modes}, "value": own - truth, "atol": 5e-4}


def chart(model, cells):
    def anchors(stored):
        n = numbers_of(model)
        for row, speed in cells:
            length = float(stored.length[row])
            at = float(stored.speed_rpm[int(np.abs(stored.speed_rpm.values - speed).argmin())])
            constant = reduced_gearbox(n, *lengths_of(model, length), G, RHO, 2, 60)
            value = growth_rate(n, constant, at)
            yield {
                "variable": "growth_rate",
                "at": {"length": length, "speed_rpm": at},
                "value": value,
                "atol": 1e-5,
            }
            value = math.log(spectral_radius(n, at)) * n.N2 * at / 60.0
            yield {"variable": "massless", "at": {"speed_rpm": at}, "value": value, "atol": 1e-7}

    return anchors


def points(stored):
    shafts = {"one": (ONE, 0.4, (1, 12)), "two": (TWO, 0.3, (8, 8))}
    for point in stored.point.values.tolist():
        name, at = str(stored.gearbox.values[point]), float(stored.speed_rpm[point])
        model, length, elements = shafts[name]
        n = numbers_of(model)
        constant = gearbox(n, *lengths_of(model, length), G, RHO, elements)
        value = growth_rate(n, constant, at)
        yield {"variable": "heavy", "at": {"point": point}, "value": value, "atol": 0.01}
        value = math.log(spectral_radius(n, at)) * n.N2 * at / 60.0
        yield {"variable": "massless", "at": {"point": point}, "value": value, "atol": 1e-7}


def sizes(stored):
    def stiffness(diameter, length):
        moment = quad(lambda r: 2.0 * np.pi * r**3, 0.0, diameter / 2.0, epsabs=0.0, epsrel=1e-13)[0]
        return G * moment / length

    for figure in stored.figure.values.tolist():
        for shaft in (1, 2):
            row = stored.sel(figure=figure, shaft=shaft)
            k, room = float(row.stiffness), float(row.room)
            own = brentq(lambda d, k=k: stiffness(d, 0.2) / k - 1.0, 1e-3, 2.0, xtol=1e-14)
            longest = stiffness(room, 1.0) / k
            at = {"figure": figure, "shaft": shaft}
            yield {"variable": "diameter", "at": at, "value": own, "atol": 1e-10}
            yield {"variable": "longest", "at": at, "value": longest, "atol": 1e-9 * longest}


def main() -> None:
    """Write the anchors."""
    jobs = {
        "sizes": (sizes, "Polar moment of area by quadrature of r³, diameter by Brent's method"),
        "speeds_13": (speeds(ONE), ELEMENTS),
        "speeds_12": (speeds(TWO), ELEMENTS),
        "convergence": (convergence, DOP),
        "map_13": (chart(ONE, ((4, 625.0), (11, 505.0), (20, 460.0), (27, 700.0), (31, 840.0))), DOP),
        "map_12": (chart(TWO, ((2, 500.0), (7, 570.0), (13, 500.0), (13, 700.0))), DOP),
        "points": (points, DOP),
    }
    for name, (compute, route) in jobs.items():
        figure = f"ch08_shafts_{name}"
        found = list(compute(load(DATA / "reference" / f"{figure}.nc")))
        content = {"figure": figure, "route": route, "anchors": found}
        (DATA / "anchors" / f"{figure}.yaml").write_text(
            yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
        )


if __name__ == "__main__":
    main()
