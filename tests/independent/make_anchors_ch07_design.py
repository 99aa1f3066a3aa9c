"""Compute the anchors of chapter 7's design study: `python -m tests.independent.make_anchors_ch07_design`.

Takes some minutes. Matrices are those of :mod:`tests.independent.torsional_switching`, typed from the text and
integrated by DOP853 between the instants where tooth pairs switch. Where a border, a peak or a root is looked for, the
package says only where to look: borders and roots are interpolated between independent values on both sides, and at
the peak of a growth rate an error of the speed does not show.
"""

import math
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import yaml
from scipy.integrate import solve_ivp

import facegear as fg
from compendium.datasets.modulation import ScaledModulation, undamped
from facegear.floquet.models import replace_parameter
from facegear.maps.closing import growth_peaks, largest_growth
from facegear.maps.tracing import tongues
from facegear.mechanics.contact import SKEW_LINE
from facegear.mechanics.gearboxes import DRIVE, FIGURES
from tests.independent import meshing_mpmath, torsional_switching
from tests.independent.torsional_switching import numbers_of

FOLDER = Path(__file__).resolve().parents[2] / "data" / "anchors"
ROUTE = (
    "tests/independent/make_anchors_ch07_design.py: matrices typed from (7-3) and (7-11) to (7-13), DOP853 between the "
    "instants where tooth pairs switch, rtol 1e-13"
)
GEOMETRY_ROUTE = (
    "tests/independent/make_anchors_ch07_design.py: limits of the tooth and contact ratios from "
    "tests/independent/meshing_mpmath.py"
)
RTOL = 1e-13
LIGHT = 1e-6
CASES = {
    "7.12a": replace_parameter(FIGURES["7.12a"].model(), "input_damping", LIGHT),
    "7.13a": replace_parameter(FIGURES["7.13a"].model(), "output_damping", LIGHT),
    "7.12b": FIGURES["7.12b"].model(),
}


def anchor(variable, value, atol, **at):
    return {
        "variable": variable,
        "at": {key: float(number) for key, number in at.items()},
        "value": float(value),
        "atol": float(atol),
    }


# --- matrices ---------------------------------------------------------------------------------------------------


def smooth_pieces(n):
    edges = sorted({0.0, n.cr - math.floor(n.cr), 1.0})
    for start, stop in pairwise(edges):
        middle = (start + stop) / 2
        yield start, stop, [pair for pair in range(math.ceil(n.cr)) if middle + pair < n.cr], middle


def matrices_at(n, x, T0, meshing, middle):
    return torsional_switching.matrices(n, x, T0, meshing, torsional_switching.skew_line(n), middle)


def integrals(n, T0, kernel):
    """Integrals over a period of C(x) and K(x) times a function of the fraction x."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    total = np.zeros((2, 3, 3))
    for start, stop, meshing, middle in smooth_pieces(n):
        for node, weight in zip(nodes, weights, strict=True):
            x = middle + node * (stop - start) / 2
            total += (
                weight * (stop - start) / 2 * kernel(x) * np.array(matrices_at(n, x, T0, meshing, middle))
            )
    return total


def log_radius(n, speed_rpm, depth=1.0):
    """Ln max|λ|, with the variation of C and K multiplied by the depth."""
    if depth == 1.0:
        return math.log(torsional_switching.spectral_radius(n, speed_rpm, rtol=RTOL))
    T0 = 60.0 / (n.N2 * speed_rpm)
    mean = integrals(n, T0, lambda x: 1.0)
    J = np.array([n.J1, n.J2, n.Jo])[:, None]
    state = np.eye(6).ravel()
    for start, stop, meshing, middle in smooth_pieces(n):

        def rate(x, flat, meshing=meshing, middle=middle):
            q, v = flat.reshape(2, 3, 6)
            C, K = (1 - depth) * mean + depth * np.array(matrices_at(n, x, T0, meshing, middle))
            return np.concatenate([v, -(T0 * (C @ v) + T0**2 * (K @ q)) / J]).ravel()

        result = solve_ivp(rate, (start, stop), state, method="DOP853", rtol=RTOL, atol=1e-15)
        state = result.y[:, -1]
    return math.log(np.abs(np.linalg.eigvals(state.reshape(6, 6))).max())


def growth(n, speed_rpm, depth=1.0):
    return log_radius(n, speed_rpm, depth) * n.N2 * speed_rpm / 60.0


def border(n, near_rpm, step=0.02):
    """Speed at which a damped ln max|λ| passes zero, on a parabola through three values around it."""
    speeds = near_rpm + step * np.array([-1.0, 0.0, 1.0])
    values = [log_radius(n, speed) for speed in speeds]
    roots = np.roots(np.polyfit(speeds - near_rpm, values, 2))
    return near_rpm + float(roots[np.abs(roots).argmin()].real)


def undamped_border(n, lower_rpm, upper_rpm, depth, side):
    """Border where ln max|λ| starts like a square root: its square is smooth inside the tongue."""
    width = upper_rpm - lower_rpm
    share = np.array([0.01, 0.02, 0.03, 0.04])
    speeds = lower_rpm + share * width if side == "lower" else upper_rpm - share * width
    squares = [log_radius(n, speed, depth) ** 2 for speed in speeds]
    roots = np.roots(np.polyfit(speeds - speeds[0], squares, 3))
    real = roots[np.abs(roots.imag) < 1e-9 * width].real
    return speeds[0] + float(real[np.abs(real).argmin()])


# --- figures ------------------------------------------------------------------------------------------------------


def hsu_errors():
    chosen = [("7.12a", 0, 0, s) for s in (1, 2, 3, 4)] + [("7.13a", 0, 1, s) for s in (1, 2)]
    for row, depth in ((0, 0.1), (1, 0.03), (2, 0.1), (3, 0.1), (4, 0.1), (5, 0.1)):
        name, k, j, s = chosen[row]
        gearbox = undamped(CASES[name])
        n = numbers_of(gearbox)
        # Hsu's borders on paper: the mean, the s-th harmonic of K in modal coordinates, no damping.
        K0 = integrals(n, 1.0, lambda x: 1.0)[1]
        root = np.sqrt(np.array([n.J1, n.J2, n.Jo]))
        squares, vectors = np.linalg.eigh(K0 / np.outer(root, root))
        w = np.sqrt(squares)
        d, e = (
            2
            * vectors.T
            @ (integrals(n, 1.0, lambda x, f=f, s=s: f(2 * math.pi * s * x))[1] / np.outer(root, root))
            @ vectors
            for f in (math.cos, math.sin)
        )
        half = depth * math.sqrt((d[k, j] ** 2 + e[k, j] ** 2) / (w[k] * w[j])) / 2
        for side, sign in (("lower", -1), ("upper", 1)):
            value = (w[k] + w[j] + sign * half) / s * 30 / math.pi / n.N2
            yield anchor(f"hsu_{side}", value, 1e-6, resonance=row, depth=depth)
        middle = (w[k] + w[j]) / s / n.N2
        model = ScaledModulation(gearbox, depth)
        reach = 2 * half / s / n.N2
        label = f"({k + 1}+{j + 1})/{s}"
        found = [t for t in tongues(model, (middle - 2 * reach, middle + 2 * reach)) if t.label == label]
        low, high = float(fg.rpm(found[0].lower)), float(fg.rpm(found[-1].upper))
        for side in ("lower", "upper"):
            value = undamped_border(n, low, high, depth, side)
            yield anchor(side, value, 2e-5 * (high - low) + 1e-5, resonance=row, depth=depth)


def openings():
    places = {"(1+1)/1": (560, 730), "(1+1)/2": (290, 335), "(1+1)/3": (200, 225), "(1+1)/4": (148, 168)}
    gearbox = CASES["7.12a"]
    n = numbers_of(gearbox)
    limits = [tuple(float(fg.rad_per_s(v)) for v in place) for place in places.values()]
    for row, depth in ((0, 0.9), (1, 0.7), (2, 0.9), (3, 0.7), (3, 1.1)):
        speed, _ = largest_growth(ScaledModulation(gearbox, depth), limits[row])
        yield anchor("growth_rate", growth(n, float(fg.rpm(speed)), depth), 1e-3, resonance=row, depth=depth)
    for row, depth in ((0, 0.206), (1, 0.637), (3, 0.7757)):
        model = ScaledModulation(gearbox, 1.0)
        (found,) = growth_peaks(
            model, "depth", [depth - 0.05, depth, depth + 0.05], limits[row]
        ).closing_values
        yield anchor(
            "opening",
            crossing(lambda d, v=found.speed: growth(n, fg.rpm(v), d), found.value),
            1e-5,
            resonance=row,
        )
    for row, (low, high) in enumerate(limits):
        s, T0 = row + 1, 2 * math.pi / (n.N2 * (low + high) / 2)
        root = np.sqrt(np.array([n.J1, n.J2, n.Jo]))
        C0, K0 = integrals(n, T0, lambda x: 1.0)
        # The mean of c ġ is not symmetric: left and right eigenvectors differ.
        values, right = np.linalg.eig(K0 / (root[:, None] ** 2))
        first = int(values.real.argmin())
        left, right = np.linalg.inv(right)[first].real, right[:, first].real
        w = math.sqrt(values[first].real)
        f0 = left @ (C0 / root[:, None] ** 2) @ right
        (g, e), (f, d) = (
            [2 * left @ (part / root[:, None] ** 2) @ right for part in integrals(n, T0, kernel)]
            for kernel in (
                lambda x, s=s: math.sin(2 * math.pi * s * x),
                lambda x, s=s: math.cos(2 * math.pi * s * x),
            )
        )
        # (2-26) of one mode at resonance: 4σ = √((d − ωg)² + (e + ωf)²)/ω − 2f0.
        yield anchor("hsu_opening", 2 * f0 * w / math.hypot(d - w * g, e + w * f), 1e-7, resonance=row)


def crossing(function, near, step=1e-4):
    """Zero of a function on the parabola through three values around a point."""
    points = near * (1 + step * np.array([-1.0, 0.0, 1.0]))
    values = [function(float(point)) for point in points]
    roots = np.roots(np.polyfit((points - near) / near, values, 2))
    return near * (1 + float(roots[np.abs(roots).argmin()].real))


def variants(name):
    gearbox = CASES[name]
    tregold, geometric = DRIVE.contact_ratio, DRIVE.geometric_contact_ratio
    plain = numbers_of(gearbox)
    pairs = numbers_of(replace(gearbox, contact=replace(SKEW_LINE, contact_ratio=geometric)))
    soft = replace(pairs, km=pairs.km * tregold / geometric, cm=pairs.cm * tregold / geometric)
    # An arm r cos α_c = r_b1 N2/N1 that does not move.
    constant = plain.rb1 * DRIVE.gear_teeth / DRIVE.pinion_teeth / math.cos(plain.alpha_c)
    still = replace(plain, R1=constant, R2=constant)
    still_pairs = replace(pairs, R1=constant, R2=constant)
    chosen = {0: (plain, None), 1: (still, None), 4: (pairs, None), 5: (soft, None), 6: (still_pairs, None)}
    from compendium.datasets.torsional_design import variants as of_package

    models = list(of_package(gearbox).values())
    low, high = (float(fg.rad_per_s(limit)) for limit in (140.0, 1500.0))
    for row, (n, _) in chosen.items():
        found = tongues(models[row], (low, high))
        for number in sorted({0, len(found) - 1}):
            for side in ("lower", "upper"):
                near = float(fg.rpm(getattr(found[number], side)))
                yield anchor(side, border(n, near), 1e-4, variant=row, tongue=number)
            peak = float(fg.rpm(found[number].peak))
            yield anchor("largest_growth", growth(n, peak), 1e-3, variant=row, tongue=number)


def arms():
    drive = meshing_mpmath.Drive(31, 107, "3.175e-3")
    inner, outer = meshing_mpmath.inner_limit(drive), meshing_mpmath.outer_limit(drive)
    cosine = drive.base_radius / drive.pitch_radius
    yield anchor("printed", outer * cosine, 1e-12, fraction=0.0)
    yield anchor("printed", (inner + outer) / 2 * cosine, 1e-12, fraction=0.5)
    yield anchor("printed", inner * cosine, 1e-12, fraction=1.0)
    first, last = meshing_mpmath.sweep(drive)
    line = meshing_mpmath.ContactLine(drive, (first + last) / 2)
    yield anchor("contact_point", line.midpoint[0] * cosine, 1e-10, fraction=0.5)
    # Moment of a unit force along the normal at points of this line, the normal from numerical derivatives.
    for share in (0.1, 0.9):
        roll = line.start + (line.end - line.start) * share
        yield anchor("conjugate", moment(drive, line.rotation, roll), 1e-10, fraction=0.5)


def moment(drive, rotation, roll):
    """Moment about the face-gear axis (−y of the space-fixed frame) of a unit force along the normal."""
    u = drive.u_of_contact(roll, rotation)
    point = drive.to_space(rotation, drive.shaper_point(roll, u))
    along = meshing_mpmath.derivative(lambda v: drive.to_space(rotation, drive.shaper_point(v, u)), roll)
    axial = meshing_mpmath.derivative(lambda v: drive.to_space(rotation, drive.shaper_point(roll, v)), u)
    normal = meshing_mpmath.cross(along, axial)
    normal /= meshing_mpmath.sqrt(meshing_mpmath.dot(normal, normal))
    return abs(meshing_mpmath.cross(point, normal)[1])


def pairs():
    drive = meshing_mpmath.Drive(31, 107, "3.175e-3")
    ratios = meshing_mpmath.tregold_contact_ratio(drive), meshing_mpmath.geometric_contact_ratio(drive)
    for row, ratio in enumerate(map(float, ratios)):
        yield anchor("contact_ratio", ratio, 1e-11, ratio=row)
        # The first harmonic of a count of pairs that is one higher up to the fraction of cr.
        whole, rest = divmod(ratio, 1.0)
        x = (np.arange(200_000) + 0.5) / 200_000
        count = whole + (x < rest)
        harmonic = 2 * abs(np.mean(count * np.exp(2j * np.pi * x))) / count.mean()
        yield anchor("harmonic", harmonic, 1e-5, ratio=row)
        yield anchor("pairs", (whole + 1) / ratio, 1e-10, ratio=row, fraction=0.0)
        yield anchor("pairs", whole / ratio, 1e-10, ratio=row, fraction=1.0 - 0.005)


FIELDS = ("J1", "J2", "Jo", "km", "k1", "k2", "cm", "c1", "c2")


def levers():
    """Borders at parameters a little smaller and larger, extrapolated to no difference."""
    number = 0
    for name, gearbox in CASES.items():
        n = numbers_of(gearbox)
        low, high = (float(fg.rad_per_s(limit)) for limit in (140.0, 1460.0))
        for tongue in tongues(gearbox.torsional, (low, high)):
            if tongue.lower <= low or tongue.upper >= high:
                continue
            wanted = {("7.12a", "(1+1)/1"): ("J2", "km", "c1"), ("7.12b", "(1+3)/2"): ("k2", "cm")}
            for field in wanted.get((name, tongue.label), ()):
                changes = []
                for near in (tongue.lower, tongue.upper):
                    speed = border(n, float(fg.rpm(near)))
                    slope = by_speed(n, speed)
                    changes.append(-by_parameter(n, field, speed) / slope)
                lower, upper = float(fg.rpm(tongue.lower)), float(fg.rpm(tongue.upper))
                at = {"tongue": number, "parameter": FIELDS.index(field)}
                yield anchor("width_change", (changes[1] - changes[0]) / (upper - lower), 2e-4, **at)
                yield anchor("centre_change", (changes[1] + changes[0]) / (upper + lower), 1e-5, **at)
            number += 1


def richardson(function, step):
    """Central difference by the logarithm of an argument, extrapolated once."""
    one, two = ((function(1 + h) - function(1 - h)) / (2 * h) for h in (step, step / 2))
    return two + (two - one) / 3


def by_parameter(n, field, speed):
    return richardson(lambda f: log_radius(replace(n, **{field: getattr(n, field) * f}), speed), 2e-4)


def by_speed(n, speed):
    """Differentiate by speed itself, not its logarithm."""
    return richardson(lambda f: log_radius(n, speed * f), 1e-5) / speed


def closing(name, parameter, chosen):
    """Damping at which the growth at the speed of the peak passes zero."""
    gearbox = FIGURES[name].model()
    n = numbers_of(gearbox)
    field, stiffness = ("c1", n.k1) if parameter == "input_damping" else ("c2", n.k2)
    for row, limits, roots in chosen:
        low, high = (float(fg.rad_per_s(limit)) for limit in limits)
        for column, near in enumerate(roots):
            around = near * np.array([0.8, 1.0, 1.25])
            (found,) = growth_peaks(gearbox, parameter, around, (low, high)).closing_values
            speed = float(fg.rpm(found.speed))
            value = crossing(lambda c, v=speed: growth(replace(n, **{field: c * stiffness}), v), found.value)
            yield anchor("closing_damping", value, 2e-6 * value, tongue=row, root=column)
            yield anchor("closes", 1.0 if column == 0 else -1.0, 0.5, tongue=row, root=column)


FIGURE_ANCHORS = {
    "ch07_design_hsu_errors": (ROUTE, hsu_errors),
    "ch07_design_openings": (ROUTE, openings),
    "ch07_design_variants_12": (ROUTE, lambda: variants("7.12a")),
    "ch07_design_variants_13": (ROUTE, lambda: variants("7.13a")),
    "ch07_design_arms": (GEOMETRY_ROUTE, arms),
    "ch07_design_pairs": (GEOMETRY_ROUTE, pairs),
    "ch07_design_levers": (ROUTE, levers),
    "ch07_design_closing_712a": (
        ROUTE,
        lambda: closing(
            "7.12a",
            "input_damping",
            (
                (0, (148, 192), (1.27e-5, 1.047e-2)),
                (1, (295, 390), (3.145e-5, 2.175e-3)),
                (2, (560, 820), (1.980e-4, 3.535e-4)),
            ),
        ),
    ),
    "ch07_design_closing_713a": (
        ROUTE,
        lambda: closing(
            "7.13a",
            "output_damping",
            (
                (1, (295, 405), (1.916e-5, 1.891e-3)),
                (2, (545, 600), (5.832e-6,)),
                (3, (600, 860), (7.756e-5, 4.729e-4)),
                (4, (1050, 1250), (2.196e-5,)),
            ),
        ),
    ),
    "ch07_design_closing_712b": (
        ROUTE,
        lambda: closing(
            "7.12b",
            "input_damping",
            (
                (1, (500, 550), (6.274e-6,)),
                (2, (750, 815), (6.095e-6,)),
                (3, (1090, 1220), (5.816e-6, 2.615e-3)),
            ),
        ),
    ),
    "ch07_design_closing_713b": (
        ROUTE,
        lambda: closing("7.13b", "output_damping", ((1, (1100, 1170), (4.318e-6,)),)),
    ),
}


def main(names):
    for name, (route, values) in FIGURE_ANCHORS.items():
        if names and name not in names:
            continue
        text = yaml.safe_dump(
            {"figure": name, "route": route, "anchors": list(values())},
            sort_keys=False,
            allow_unicode=True,
            width=110,
        )
        (FOLDER / f"{name}.yaml").write_text(text, encoding="utf-8")
        print(name, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
