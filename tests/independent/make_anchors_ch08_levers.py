"""Compute the anchors of the levers: `python -m tests.independent.make_anchors_ch08_levers`.

Takes some minutes. Multipliers come from :mod:`tests.independent.complex_galerkin` with the driving force of
:mod:`tests.independent.edge_load`, and from :mod:`tests.independent.torsional_switching`; slopes are differences of
these, extrapolated. The package says only where its tongues are.
"""

import math
import sys
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq
from tqdm import tqdm

import facegear as fg
from compendium.datasets.levers import of_the_teeth
from facegear.design.changes import possible_changes
from facegear.floquet.models import replace_at
from facegear.maps.tracing import tongues
from facegear.mechanics.cases import CASE_1, CASE_2
from facegear.mechanics.gearboxes import FIGURES
from tests.independent import make_anchors_ch07_design as torsion
from tests.independent.complex_galerkin import multipliers
from tests.independent.make_anchors_ch04 import anchor, nominal_mass, pinion, reference_stiffness, rpm, write
from tests.independent.make_anchors_ch06 import HORSEPOWER, force_of, with_force
from tests.independent.torsional_switching import numbers_of

ROUTE = (
    "tests/independent/make_anchors_ch08_levers.py: differences of multipliers of (6-25) in complex exponentials with "
    "K_f by (6-27), DOP853 at 1e-12 from one smooth piece of the period to the next, extrapolated once"
)
BOX_ROUTE = (
    "tests/independent/make_anchors_ch08_levers.py: differences of multipliers of matrices typed from (7-3) and (7-11) "
    "to (7-13), DOP853 between the instants where tooth pairs switch, rtol 1e-13, extrapolated once"
)
CLOSED_ROUTE = (
    "tests/independent/make_anchors_ch08_levers.py: similarity of disks, and (4-20) differentiated by hand"
)
PINION_SPEED = float(rpm(5000.0))
LOWEST, HIGHEST = 100.0, 1000.0
STEP, BOX_STEP = 1e-5, 2e-6
CASE_I = fg.Transverse(
    CASE_1, fg.MeshLoad(0.6, 3e-6, 1.0), force=fg.DrivingForce(50.0 * HORSEPOWER, PINION_SPEED)
)
CASE_II = fg.Transverse(
    CASE_2, fg.MeshLoad(0.25, 1e-6, 1.0), force=fg.DrivingForce(600.0 * HORSEPOWER, PINION_SPEED)
)
BOXES = {
    name: fg.Torsional(FIGURES[name].gearbox.in_si) for name in ("7.9a", "7.11a", "7.12a", "7.13a", "7.12b")
}
# Fields of the numbers of `torsional_switching`, in the order in which a gearbox names its variables.
FIELDS = ("J1", "J2", "Jo", "km", "cm", "k1", "c1", "k2", "c2")


def growth(model, speed_rpm):
    """Growth rate [1/s] of a model with one pinion."""
    body, load = model.body, model.load
    k_b = load.stiffness * reference_stiffness(body)
    period = 2 * np.pi / (body.drive.gear_teeth * rpm(speed_rpm))
    found = multipliers(
        with_force(body, force_of(body, model.force.power / HORSEPOWER)),
        [pinion(body, model.contact.contact_ratio, 1)],
        rpm(speed_rpm),
        period,
        m_p=load.mass * nominal_mass(body),
        c_b=load.damping * k_b,
        k_b=k_b,
    )
    return math.log(np.abs(found).max()) / period


def border(model, near_rpm):
    return brentq(lambda speed: growth(model, speed), near_rpm * (1 - 2e-5), near_rpm * (1 + 2e-5), xtol=1e-8)


def peak_of(rate, near_rpm, width_rpm):
    """Speed [rpm] of the largest growth: the package's is too coarse for slopes of what moves along with the speed."""
    step = 1e-3 * width_rpm
    for _ in range(2):
        below, here, above = (rate(near_rpm + k * step) for k in (-1.0, 0.0, 1.0))
        near_rpm += 0.5 * step * (below - above) / (below - 2.0 * here + above)
        step /= 3.0
    return near_rpm


def whole(model, low=LOWEST):
    """Tongues as the chapter lists them."""
    ends = [float(fg.rad_per_s(limit)) for limit in (low, HIGHEST)]
    return [
        each
        for each in tongues(model, ends)
        if ends[0] < each.lower and each.upper < ends[1] and each.width > 1e-3 * each.upper
    ]


def changes_of(model):
    found = (*possible_changes(model), *of_the_teeth(("body", "drive")))
    return {change.name: (place, change) for place, change in enumerate(found)}


def slopes(model, tongue, place, name, first=0):
    """Anchors of one tongue and one variable."""
    column, change = changes_of(model)[name]
    lower, upper, peak = (float(fg.rpm(each)) for each in (tongue.lower, tongue.upper, tongue.peak))

    def by_change(speed):
        return torsion.richardson(lambda f: growth(change.apply(model, f - 1.0), speed), STEP)

    def by_speed(speed):
        return torsion.richardson(lambda f: growth(model, speed * f), STEP) / speed

    ends = [-by_change(speed) / by_speed(speed) for speed in (lower, upper)]
    at = {"tongue": first + place, "change": column}
    yield anchor("centre_change", sum(ends) / (lower + upper), 2e-5, **at)
    yield anchor("width_change", (ends[1] - ends[0]) / (upper - lower), 5e-4, **at)
    peak = peak_of(lambda speed: growth(model, speed), peak, upper - lower)
    yield anchor("growth_change", by_change(peak) / growth(model, peak), 1e-4, **at)


def disk():
    found = whole(CASE_I)
    for label, name in (
        ("(1+8)/1", "bearing stiffness"),
        ("(1+8)/1", "thickness of the body"),
        ("(1+11)/1", "power of each pinion"),
        ("(1+13)/1", "contact ratio alone"),
        ("(1+4)/1", "pinion mass"),
    ):
        (place,) = [i for i, each in enumerate(found) if each.label == label]
        yield from slopes(CASE_I, found[place], place, name)
    others = whole(CASE_II)
    (place,) = [i for i, each in enumerate(others) if each.label == "(1+8)/1"]
    yield from slopes(CASE_II, others[place], place, "bore radius", len(found))


def wide():
    model = replace_at(CASE_I, ("body", "nodal_diameters"), 5)
    found = whole(model)
    (place,) = [i for i, each in enumerate(found) if each.label == "(1+8)/1"]
    yield from slopes(model, found[place], place, "bearing damping")
    yield from slopes(model, found[place], place, "pressure angle")


def earnest():
    """Ten percent more, and the borders where DOP853 has them."""
    for label, name in (("(1+8)/1", "thickness of the body"), ("(1+11)/1", "pinion mass")):
        column, change = changes_of(CASE_I)[name]
        changed = change.apply(CASE_I, 0.1)
        before, after = moved(CASE_I, changed, label)
        place = [each.label for each in whole(CASE_I)].index(label)
        at = {"tongue": place, "change": column}
        yield anchor("centre_change", (sum(after) / sum(before) - 1.0) / 0.1, 1e-5, **at)
        yield anchor("width_change", (np.diff(after)[0] / np.diff(before)[0] - 1.0) / 0.1, 1e-4, **at)


def moved(model, changed, label):
    """Both borders of a tongue before and after [rpm]."""
    for each in (model, changed):
        (tongue,) = [found for found in whole(each) if found.label == label]
        yield [border(each, float(fg.rpm(speed))) for speed in (tongue.lower, tongue.upper)]


def teeth():
    """One tooth more, at the same diametral pitch and at the same pitch radius."""
    drive = CASE_1.drive
    for family, module in enumerate((drive.module, drive.module * 26 / 27)):
        more = replace(drive, pinion_teeth=27, gear_teeth=135, module=module)
        before, after = moved(CASE_I, replace_at(CASE_I, ("body", "drive"), more), "(1+8)/1")
        place = [each.label for each in whole(CASE_I)].index("(1+8)/1")
        at = {"tongue": place, "family": family}
        yield anchor("centre_change", 100 * (sum(after) / sum(before) - 1.0), 1e-4, **at)
        yield anchor("width_change", 100 * (np.diff(after)[0] / np.diff(before)[0] - 1.0), 1e-3, **at)


def arrows():
    """Powers of length and load that similarity and (4-20) leave, a few of them with the bore changed too."""
    columns = {name: place for name, (place, _) in changes_of(CASE_I).items()}
    quantities = (
        "contact ratio", "face width", "outer radius", "stress", "mass", "frequency", "critical power"
    )  # fmt: skip
    exact = {
        ("module", "contact ratio"): 0.0,
        ("module", "face width"): 1.0,
        ("module", "outer radius"): 1.0,
        ("module", "stress"): -3.0,
        ("power of each pinion", "stress"): 1.0,
        ("thickness of the body", "mass"): 1.0,
        ("thickness of the body", "frequency"): 1.0,
        ("loss factor of the material", "critical power"): 1.0,
        ("contact ratio alone", "contact ratio"): 1.0,
    }
    inside = (CASE_1.bore_radius / CASE_1.outer_radius) ** 2
    exact["bore radius", "mass"] = -2.0 * inside / (1.0 - inside)
    exact["module", "mass"] = 3.0 - exact["bore radius", "mass"]
    for (name, quantity), value in exact.items():
        yield anchor("change_of", value, 1e-5, change=columns[name], quantity=quantities.index(quantity))


def gearbox():
    """To 1e-4, which is what the chapter's sums of slopes miss."""
    first = 0
    for name, model in BOXES.items():
        found, numbers = whole(model, 130.0), numbers_of(model)
        wanted = {
            ("7.12b", "(1+1)/1"): ("J2", "k1"),
            ("7.13a", "(1+1)/1"): ("k2",),
            ("7.11a", "(1+1)/2"): ("km",),
        }
        for place, tongue in enumerate(found):
            for field in wanted.get((name, tongue.label), ()):
                # Within a hundred thousandth of a border of the softer gearbox the root has bent.
                def by_change(speed, field=field, numbers=numbers):
                    return torsion.richardson(
                        lambda f: torsion.log_radius(
                            replace(numbers, **{field: getattr(numbers, field) * f}), speed
                        ),
                        BOX_STEP,
                    )

                lower, upper, peak = (
                    float(fg.rpm(each)) for each in (tongue.lower, tongue.upper, tongue.peak)
                )
                ends = []
                for near in (lower, upper):
                    by_speed = torsion.richardson(
                        lambda f, near=near, numbers=numbers: torsion.log_radius(numbers, near * f), BOX_STEP
                    )
                    ends.append(-by_change(near) / by_speed * near)
                at = {"tongue": first + place, "change": FIELDS.index(field)}
                yield anchor("centre_change", sum(ends) / (lower + upper), 1e-4, **at)
                yield anchor("width_change", (ends[1] - ends[0]) / (upper - lower), 5e-4, **at)

                # The growth in a period has its peak elsewhere.
                def rate(speed, numbers=numbers):
                    return torsion.log_radius(numbers, speed) * speed

                peak = peak_of(rate, peak, upper - lower)
                yield anchor("growth_change", by_change(peak) / torsion.log_radius(numbers, peak), 1e-4, **at)
        first += len(found)


FILES = {
    "ch08_levers_disk": (ROUTE, disk),
    "ch08_levers_wide": (ROUTE, wide),
    "ch08_levers_earnest": (ROUTE, earnest),
    "ch08_levers_teeth": (ROUTE, teeth),
    "ch08_levers_arrows": (CLOSED_ROUTE, arrows),
    "ch08_levers_gearbox": (BOX_ROUTE, gearbox),
}


def main():
    """Make the anchors of the files named on the command line, of all when none is."""
    for name in tqdm(sys.argv[1:] or list(FILES)):
        route, make = FILES[name]
        write(name, route, make())


if __name__ == "__main__":
    main()
