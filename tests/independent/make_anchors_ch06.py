"""Compute the anchors of chapter 6 and write them to data/anchors: `python -m tests.independent.make_anchors_ch06`.

Takes some minutes. Stresses, K_f and multipliers come from :mod:`tests.independent.edge_load` and
:mod:`tests.independent.complex_galerkin`; of the package they use the radial mode functions, the contact centroid,
and, for the envelope, the speed at which it looks.
"""

import sys
from dataclasses import fields, replace
from functools import cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq
from tqdm import tqdm

from facegear.design.envelope import largest_power
from facegear.floquet.models import replace_parameter
from facegear.mechanics.cases import CASE_1, CASE_2, FIGURES, POWER_SPEED_RPM, POWERS_HP
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from tests.independent.complex_galerkin import ComplexDisk, multipliers
from tests.independent.edge_load import LoadedDisk, at_rest, shot
from tests.independent.make_anchors_ch04 import (
    anchor,
    growth,
    nominal_mass,
    pinion,
    reference_stiffness,
    rpm,
    write,
)
from tests.mechanics.test_transverse import complex_disk, unitary

HORSEPOWER = 745.69987
SHOT_ROUTE = "tests/independent/edge_load.py: plane displacements of (6-2), (6-3) shot from the bore by DOP853 at 1e-13"
SUM_ROUTE = (
    "tests/independent/edge_load.py: harmonics 0 and 1 shot from the bore, all others as sums of powers of r with "
    "60 digits and more"
)
STIFFNESS_ROUTE = "tests/independent/edge_load.py: (6-27) entry by entry with stresses shot from the bore"
ALONE_ROUTE = "tests/independent/edge_load.py: eigenvalues of (6-25) without a pinion in complex exponentials"
MAP_ROUTE = (
    "tests/independent/edge_load.py and complex_galerkin.py: (6-25) in complex exponentials with K_f by (6-27), one "
    "smooth piece of the period after the other by DOP853 at 1e-12; tolerance 1e-8 of the spectral radius"
)
MEAN_ROUTE = "tests/independent/edge_load.py: (6-25) with its periodic matrices averaged over a mesh period"
LIMIT_ROUTE = (
    "tests/independent/edge_load.py: root in the power of the growth rate by DOP853, at the speed at which the package "
    "finds stability lost; tolerance that of the search, 3e-3"
)

CASES = {1: (CASE_1, FIGURES["4.4a"], POWERS_HP["6.6"]), 2: (CASE_2, FIGURES["4.5a"], POWERS_HP["6.7"])}
# Power [hp], row and column (from 1) of the 200 x 200 maps.
PLACES = {
    1: [
        *((100, 82, 110), (100, 60, 170), (300, 100, 20), (300, 175, 10), (300, 50, 100), (300, 150, 180)),
        *((600, 20, 30), (600, 100, 150), (600, 190, 60)),
    ],
    2: [
        *((600, 100, 118), (600, 30, 150), (800, 60, 150), (800, 140, 118)),
        *((1000, 195, 10), (1000, 100, 190), (1000, 50, 60), (1000, 190, 190)),
    ],
}
# The same for the 60 x 60 maps.
COARSE = {
    "power_case_1": (1, None, [(0, 10, 32), (200, 30, 50), (400, 52, 4), (500, 12, 40)]),
    "power_case_2": (2, None, [(0, 12, 35), (600, 30, 36), (600, 50, 58)]),
    "geometric_6_06": (1, "true", [(100, 20, 52), (300, 52, 4), (600, 36, 58)]),
    "geometric_6_07": (2, "true", [(600, 30, 60), (800, 30, 58), (1000, 40, 50)]),
}
MEAN_PLACES = [(3, 4), (10, 16), (16, 10)]


def force_of(body, power_hp):
    return power_hp * HORSEPOWER / (rpm(POWER_SPEED_RPM) * body.drive.pitch_radius)


@cache
def loaded(body, force, harmonics=5):
    plain = complex_disk(body)
    return LoadedDisk(
        **{field.name: getattr(plain, field.name) for field in fields(ComplexDisk)},
        force=force,
        harmonics=harmonics,
    )


@cache
def unit_stiffness(body, speed):
    return loaded(body, 1.0).load_stiffness(speed)


@cache
def with_force(body, force):
    """Return the loaded disk with K_f made once for each speed."""

    class Kept(LoadedDisk):
        def load_stiffness(self, speed):
            return self.force * unit_stiffness(body, speed)

    disk = loaded(body, force)
    return Kept(**{field.name: getattr(disk, field.name) for field in fields(LoadedDisk)})


def radius_at(number, power_hp, speed_rpm, stiffness, contact_ratio=None, damping=None):
    body, figure, _ = CASES[number]
    k_b = stiffness * reference_stiffness(body)
    period = 2 * np.pi / (body.drive.gear_teeth * rpm(speed_rpm))
    found = multipliers(
        with_force(body, force_of(body, power_hp)),
        [pinion(body, contact_ratio, 1)],
        rpm(speed_rpm),
        period,
        m_p=figure.load.mass * nominal_mass(body),
        c_b=(figure.load.damping if damping is None else damping) * k_b,
        k_b=k_b,
    )
    return float(np.abs(found).max()), period


def cells(number, places, count, contact_ratio=None):
    body, figure, _ = CASES[number]
    ratio = body.drive.geometric_contact_ratio if contact_ratio else None
    for power_hp, row, column in places:
        stiffness, speed = figure.highest * row / count, 1000.0 * column / count
        radius, period = radius_at(number, power_hp, speed, stiffness, ratio)
        yield growth(radius, period, power=power_hp * HORSEPOWER, stiffness=stiffness, speed_rpm=speed)


def mean(number, power_hp):
    """Largest real part of the eigenvalues of the averaged system."""
    body, figure, _ = CASES[number]
    disk, contact = with_force(body, force_of(body, power_hp)), pinion(body, None, 1)
    n = np.repeat(disk.waves, disk.M + 1)
    points, weights = np.polynomial.legendre.leggauss(40)
    average = np.zeros((len(n), len(n)), dtype=complex)
    for start, end in pairwise(np.append(contact.instants, 1.0)):
        for point, weight in zip(points, weights, strict=True):
            r, theta = contact.position((start + end) / 2 + (end - start) / 2 * point)
            R = np.array([disk.radial(m, abs(k), r) for k in disk.waves for m in range(disk.M + 1)])
            wave = np.exp(1j * theta * (n[None, :] - n[:, None]))
            average += (end - start) / 2 * weight * wave * np.outer(R, R) / (2 * np.pi * disk.rho * disk.h)
    for row, column in MEAN_PLACES:
        stiffness, speed = figure.highest * row / 20, 1000.0 * column / 20
        M, C, K = disk.constant_matrices(rpm(speed))
        k_b = stiffness * reference_stiffness(body)
        M = M + average * nominal_mass(body) * figure.load.mass
        C, K = C + average * figure.load.damping * k_b, K + average * k_b
        zero, one = np.zeros_like(M), np.eye(len(M))
        A = np.block([[zero, one], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
        value = np.linalg.eigvals(A).real.max()
        yield anchor("growth_rate", value, 1e-6, stiffness=stiffness, speed_rpm=speed)


def harmonics(name):
    body = CASE_2
    force = force_of(body, 800.0)
    spin = rpm(1000.0) * body.outer_radius * np.sqrt(body.material.density / body.material.youngs_modulus)
    radii = np.linspace(body.bore_radius, body.outer_radius, 61)
    chosen = [20, 45, 60]
    part = ("radial", "shear", "hoop").index(name)
    for k in (0, 1, 3, 5):
        x = np.minimum(radii[chosen] / body.outer_radius, 1.0)
        values = shot(k, spin, body.material.poissons_ratio, body.bore_ratio, x)[part]
        scale = force / (2 * np.pi * body.outer_radius * body.thickness) * (2 if k else 1)
        for place, value in zip(chosen, values, strict=True):
            yield anchor(name, value * scale, 1e-9 * scale, harmonic=k, radius=radii[place])


def speed_effect():
    body = CASE_2
    nu, c = body.material.poissons_ratio, body.bore_ratio
    x = np.linspace(c, 1.0, 6)
    for k in (0, 1, 3):
        spin = rpm(1000.0) * body.outer_radius * np.sqrt(body.material.density / body.material.youngs_modulus)
        change = np.abs(shot(k, spin, nu, c, x) - shot(k, 0.0, nu, c, x)).max()
        yield anchor("speed_effect", change, 1e-9, harmonic=k, speed_rpm=1000.0)


def point_stress(body, x, theta, count, load=(0, 1)):
    """σ_rr, σ_rθ, σ_θθ of a force of 1 N at θ = 0, summed to `count` harmonics."""
    nu, c = body.material.poissons_ratio, body.bore_ratio
    total = np.zeros(3)
    for k in range(count + 1):
        field = shot(k, 0.0, nu, c, np.array([x]), load)[:, 0] if k < 2 else at_rest(k, nu, c, x, load)
        sine, cosine = np.sin(k * theta), np.cos(k * theta)
        waves = [sine, cosine, sine] if load == (0, 1) else [cosine, -sine, cosine]
        scale = (2 if k else 1) / (2 * np.pi * body.outer_radius * body.thickness)
        total += scale * field * waves
    return total


def near_load():
    body = CASE_2
    distances = np.geomspace(0.0125, 0.4, 11)
    for count, place in ((25, 9), (50, 7), (100, 6)):
        d = distances[place]
        x, y = 1 - d / np.sqrt(2), d / np.sqrt(2)
        theta = np.arctan2(y, x)
        radial, shear, hoop = point_stress(body, np.hypot(x, y), theta, count)
        # Rotate the tensor to Cartesian axes and take the component along (-1, 1)/√2.
        turn = np.array([[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]])
        tensor = turn @ np.array([[radial, shear], [shear, hoop]]) @ turn.T
        line = np.array([-1.0, 1.0]) / np.sqrt(2)
        flamant = -2 / np.sqrt(2) / (np.pi * body.thickness * body.outer_radius * d)
        yield anchor("ratio", line @ tensor @ line / flamant, 1e-8, harmonics=count, distance=d)


def fields_at(loads):
    """Two points of a sum of fields; loads are (force, angle, (S, T) at the rim)."""
    body = CASE_2
    radii, angles = np.linspace(body.bore_radius, body.outer_radius, 41), np.linspace(0, 2 * np.pi, 181)
    for i, j in ((30, 12), (15, 100)):
        total = sum(
            force * point_stress(body, radii[i] / body.outer_radius, angles[j] - angle, 40, load)
            for force, angle, load in loads
        )
        for name, value in zip(("radial", "shear", "hoop"), total, strict=True):
            yield anchor(name, value, 1e-3, radius=radii[i], angle=angles[j])


def stiffness(body):
    U = unitary(body)
    K = (U.conj().T @ loaded(body, 1.0).load_stiffness(rpm(1000.0)) @ U).real
    for i, j in ((2, 4), (4, 2), (6, 12), (12, 4), (3, 8), (0, 5)):
        yield anchor("follower", K[i, j], 1e-10 * np.abs(K).max(), row=i, column=j)


def alone(number):
    body, _, powers = CASES[number]
    levels = np.linspace(0.0, 1.15 * max(powers) * HORSEPOWER, 24)

    def rate(power, speed):
        return with_force(body, force_of(body, power / HORSEPOWER)).growth_alone(rpm(speed))

    for speed in (1.0, 500.0, 1000.0):
        found = brentq(rate, 0.5 * first_order(body), 1.5 * first_order(body), args=(speed,), rtol=1e-12)
        yield anchor("critical", found, 1e-6 * found, speed_rpm=speed)
        for place in (5, 20):
            value = rate(levels[place], speed)
            yield anchor("growth_rate", value, 1e-6, speed_rpm=speed, power=levels[place])
    value = first_order(body)
    yield anchor("mode_critical", value, 1e-8 * value, circles=0, diameters=1)


def first_order(body):
    """ξω³/ε of the mode (0, 1), ω from the strain energy."""
    disk = complex_disk(body)
    omega = np.sqrt(disk.elastic(1)[0, 0])
    force_per_watt = force_of(body, 1 / HORSEPOWER)
    growth_per_watt = (
        force_per_watt * disk.radial(0, 1, np.asarray(disk.a)) ** 2 / (2 * np.pi * disk.rho * disk.a * disk.h)
    )
    return float(disk.xi * omega**3 / growth_per_watt)


def limit(number, variant, parameter, value, stiffness=None):
    """Power at which growth vanishes, at the speed that the package names."""
    body, figure, _ = CASES[number]
    ratio = body.drive.geometric_contact_ratio if variant else None
    model = figure.model(force=DrivingForce(0.0, rpm(POWER_SPEED_RPM)), contact=Contact(contact_ratio=ratio))
    if stiffness is not None:
        model = replace_parameter(model, "stiffness", stiffness)
    model = replace_parameter(model, parameter, value)
    place = largest_power(model, (rpm(200.0), rpm(1000.0)))
    load = replace(model.load)

    def log_radius(power):
        radius, _ = radius_at(
            number, power / HORSEPOWER, place.speed * 30 / np.pi, load.stiffness, ratio, load.damping
        )
        return np.log(radius)

    # Nearly a straight line: a secant in a narrow interval.
    low, high = 0.995 * place.power, 1.005 * place.power
    a, b = log_radius(low), log_radius(high)
    root = low - a * (high - low) / (b - a)
    assert abs(log_radius(root)) < 0.02 * max(abs(a), abs(b)), "the growth is no straight line near the limit"
    yield anchor("power", root, 3e-3 * root, variant=variant, **{parameter: value})


def inclined():
    angle = np.radians(25.0)
    return [(1e4 * np.cos(angle), 0.0, (0, 1)), (-1e4 * np.sin(angle), 0.0, (1, 0))]


FILES = {
    "ch06_figure_6_03": (SHOT_ROUTE, lambda: harmonics("radial")),
    "ch06_figure_6_04": (SHOT_ROUTE, lambda: harmonics("shear")),
    "ch06_figure_6_05": (SHOT_ROUTE, lambda: harmonics("hoop")),
    "ch06_closed_forms": (SHOT_ROUTE, speed_effect),
    "ch06_near_load": (SUM_ROUTE, near_load),
    "ch06_field_one": (SUM_ROUTE, lambda: fields_at([(1e4, 0.0, (0, 1))])),
    "ch06_field_inclined": (SUM_ROUTE, lambda: fields_at(inclined())),
    "ch06_field_three": (
        SUM_ROUTE,
        lambda: fields_at([(1e4, np.radians(angle), (0, 1)) for angle in (0.0, 100.0, 215.0)]),
    ),
    "ch06_stiffness_case_1": (STIFFNESS_ROUTE, lambda: stiffness(CASE_1)),
    "ch06_stiffness_case_2": (STIFFNESS_ROUTE, lambda: stiffness(CASE_2)),
    "ch06_disk_alone_case_1": (ALONE_ROUTE, lambda: alone(1)),
    "ch06_disk_alone_case_2": (ALONE_ROUTE, lambda: alone(2)),
    "ch06_figure_6_06": (MAP_ROUTE, lambda: cells(1, PLACES[1], 200)),
    "ch06_figure_6_07": (MAP_ROUTE, lambda: cells(2, PLACES[2], 200)),
    **{
        f"ch06_{name}": (MAP_ROUTE, lambda given=given: cells(given[0], given[2], 60, given[1]))
        for name, given in COARSE.items()
    },
    **{
        f"ch06_mean_6_0{5 + number}_{power:.0f}hp": (
            MEAN_ROUTE,
            lambda number=number, power=power: mean(number, power),
        )
        for number, (_, _, powers) in CASES.items()
        for power in powers
    },
    "ch06_envelope_stiffness_1": (LIMIT_ROUTE, lambda: limit(1, 1, "stiffness", 1.4)),
    "ch06_envelope_stiffness_2": (LIMIT_ROUTE, lambda: limit(2, 0, "stiffness", 0.95)),
    "ch06_envelope_damping_1": (LIMIT_ROUTE, lambda: limit(1, 1, "damping", 1e-5, 1.2)),
    "ch06_envelope_damping_2": (LIMIT_ROUTE, lambda: limit(2, 1, "damping", 1e-5, 0.8)),
}


def main():
    """Make the anchors of the files named on the command line, of all when none is."""
    for name in tqdm(sys.argv[1:] or list(FILES)):
        route, make = FILES[name]
        write(name, route, make())


if __name__ == "__main__":
    main()
