"""Compute the anchors of the design figures: `python -m tests.independent.make_anchors_ch04_design`.

Takes some minutes. Growth rates come from :mod:`tests.independent.complex_galerkin` at speeds near which they are
largest, found by the package: there an error of the speed does not show. The tip of a lobe is where the growth rates
of two thicknesses below it lead on a straight line.
"""

import sys

import mpmath
import numpy as np
import yaml
from mpmath import mpf
from tqdm import tqdm

import facegear as fg
from facegear.design.teeth import constant_diametral_pitch, constant_pitch_radius
from facegear.maps.tracing import tongues
from tests.independent import meshing_mpmath
from tests.independent.make_anchors_ch04 import FOLDER, ROUTE, anchor, rpm, spectral_radius

LOAD = fg.MeshLoad(stiffness=0.8, damping=1e-5, mass=1.0)
PARAMETERS = {"stiffness": 0.8, "damping": 1e-5, "mass": 1.0}
TEETH_ROUTE = (
    "tests/independent/make_anchors_ch04_design.py: limits of the tooth from tests/independent/meshing_mpmath.py, "
    "tooth thickness from the involute function in mpmath"
)
# Two points on a slightly curved line, and the tolerance of the traced tip.
TIP = 2e-5


def growth(body, speed_rpm, contact_ratio=None):
    radius, period = spectral_radius(body, speed_rpm, contact_ratio=contact_ratio, **PARAMETERS)
    return np.log(radius) / period, 1e-8 / (radius * period)


def strongest(body, low_rpm, high_rpm, contact_ratio=None):
    """Speed of the strongest tongue between two speeds [rpm]."""
    found = tongues(
        fg.Transverse(body, LOAD, contact=fg.Contact(contact_ratio=contact_ratio)),
        (rpm(low_rpm), rpm(high_rpm)),
    )
    return float(fg.rpm(max(found, key=lambda tongue: tongue.growth_rate).peak))


def tip(drive, near, low_rpm, high_rpm, contact_ratio=None):
    """Thickness ratio at which the growth rate of a lobe between two speeds vanishes."""
    ratios = near - np.array([1e-4, 2e-4])
    values = []
    for ratio in ratios:
        body = fg.Body(drive, float(ratio))
        speed = strongest(body, low_rpm, high_rpm, contact_ratio)
        values.append(growth(body, speed, contact_ratio)[0])
    return ratios[0] - values[0] * (ratios[1] - ratios[0]) / (values[1] - values[0])


def cells(drive, places):
    """Growth rates in the cells of a map that lie nearest to thickness ratio and speed [rpm]."""
    for ratio, speed in places:
        column = 50.0 + 4.75 * round((speed - 50.0) / 4.75)
        value, tolerance = growth(fg.Body(drive, ratio), column)
        yield anchor("growth_rate", value, tolerance, thickness_ratio=ratio, speed_rpm=column)


def map_of_25():
    places = (
        (0.0252, 120.0),
        (0.03, 600.0),
        (0.03, 640.0),
        (0.0325, 690.0),
        (0.035, 740.0),
        (0.035, 860.0),
        (0.0375, 180.0),
        (0.0375, 760.0),
        (0.0375, 790.0),
        (0.039, 830.0),
        (0.0395, 840.0),
        (0.04, 500.0),
        (0.045, 950.0),
        (0.036, 60.0),
    )
    yield from cells(constant_diametral_pitch(25), places)


def chart(drive, places, ratio=0.033):
    """Cells of a map, and the largest growth of the two strongest tongues of one section."""
    yield from cells(drive, places)
    body = fg.Body(drive, ratio)
    found = tongues(fg.Transverse(body, LOAD), (rpm(100.0), rpm(1000.0)))
    strong = sorted(range(len(found)), key=lambda number: -found[number].growth_rate)[:2]
    for number in strong:
        value, tolerance = growth(body, float(fg.rpm(found[number].peak)))
        yield anchor("largest_growth", value, 10 * tolerance, section=ratio, tongue=number)


# On the lobe C of each map, on its border, between two lobes, and in the safe zone.
PLACES = {
    "4_09b": ((0.03, 650.0), (0.035, 880.0), (0.03, 560.0), (0.044, 300.0)),
    "4_09c": ((0.029, 545.0), (0.029, 575.0), (0.029, 450.0), (0.0445, 300.0)),
    "4_13a": ((0.03, 700.0), (0.03, 740.0), (0.03, 600.0), (0.044, 300.0)),
    "4_13b": ((0.03, 640.0), (0.03, 670.0), (0.03, 560.0), (0.044, 300.0)),
    "4_13c": ((0.03, 570.0), (0.03, 610.0), (0.03, 500.0), (0.0445, 300.0)),
}


def bodies(family):
    tips = {
        constant_diametral_pitch: ((0.03761, 300.0, 150.0, 210.0), (0.03945, 1000.0, 800.0, 860.0)),
        constant_pitch_radius: ((0.03798, 300.0, 110.0, 150.0), (0.04162, 1000.0, 580.0, 630.0)),
    }
    for near, highest, low, high in tips[family]:
        value = tip(family(25), near, low, high)
        yield anchor("critical_ratio", value, TIP, highest_rpm=highest, pinion_teeth=25)


def variants():
    for near, highest, low, high in ((0.03761, 300.0, 150.0, 210.0), (0.03945, 1000.0, 800.0, 860.0)):
        value = tip(constant_diametral_pitch(25), near, low, high)
        yield anchor("critical_ratio", value, TIP, variant=0, highest_rpm=highest)


# Basis of the row, near its tips and their speeds [rpm], which the package finds: at a peak they do not show.
BASES = {
    0: ((1, 3), (0.03761, 180.0), (0.03945, 837.8)),
    4: ((3, 8), (0.03872, 184.6), (0.03869, 828.0)),
}


def bases():
    """Tips with the printed and with the finest basis."""
    for row, ((circles, diameters), *near) in BASES.items():
        for window, (ratio, speed) in enumerate(near):
            ratios = ratio - np.array([1e-4, 2e-4])
            values = []
            for each in ratios:
                body = fg.Body(
                    constant_diametral_pitch(25),
                    float(each),
                    nodal_circles=circles,
                    nodal_diameters=diameters,
                )
                expected = speed * each / ratio
                at_peak = strongest(body, 0.985 * expected, 1.015 * expected)
                values.append(growth(body, at_peak)[0])
            tip_ratio = ratios[0] - values[0] * (ratios[1] - ratios[0]) / (values[1] - values[0])
            yield anchor("tip_ratio", tip_ratio, TIP, variant=row, window=window)


def teeth(family):
    power, speed = mpf("600") * mpf("745.69987"), 5000 * mpmath.pi / 30
    for count in (22, 25, 28, 32, 35):
        drive = meshing_mpmath.Drive(count, 5 * count, mpmath.nstr(mpf(family(count).module), 17))
        width = meshing_mpmath.outer_limit(drive) - meshing_mpmath.inner_limit(drive)
        yield anchor("face_width", width, 1e-11, pinion_teeth=count)
        module = mpf(family(count).module)
        alpha = mpmath.radians(25)
        pitch = count * module / 2
        base, root = pitch * mpmath.cos(alpha), pitch - mpf("1.25") * module
        local = mpmath.acos(min(base / root, 1))
        half = mpmath.pi / (2 * count) + (mpmath.tan(alpha) - alpha) - (mpmath.tan(local) - local)
        chord = 2 * root * mpmath.sin(half)
        stress = 6 * power / (speed * pitch) * mpf("1.25") * module / (width * chord**2)
        yield anchor("root_stress", stress, 1e-9 * float(stress), root=0, pinion_teeth=count)


def lobe():
    body = fg.Body(constant_diametral_pitch(25), 0.0376134 * (1 - 0.02))
    value, _ = growth(body, strongest(body, 150.0, 210.0))
    yield anchor("largest_growth", value, 0.02, depth=0.02)


def geometric():
    drive = constant_diametral_pitch(25)
    contact_ratio = drive.geometric_contact_ratio
    for ratio in (0.02, 0.0215):
        body = fg.Body(drive, ratio)
        speed = strongest(body, 380.0, 480.0, contact_ratio)
        found = tongues(
            fg.Transverse(body, LOAD, contact=fg.Contact(contact_ratio=contact_ratio)),
            (rpm(100.0), rpm(1000.0)),
        )
        number = int(np.argmin([abs(fg.rpm(tongue.peak) - speed) for tongue in found]))
        value, tolerance = growth(body, speed, contact_ratio)
        yield anchor("largest_growth", value, 10 * tolerance, section=ratio, tongue=number)


FIGURES = {
    "ch04_figure_4_07": (TEETH_ROUTE, lambda: teeth(constant_diametral_pitch)),
    "ch04_figure_4_11": (TEETH_ROUTE, lambda: teeth(constant_pitch_radius)),
    "ch04_figure_4_09a": (ROUTE, map_of_25),
    "ch04_figure_4_09b": (ROUTE, lambda: chart(constant_diametral_pitch(28), PLACES["4_09b"])),
    "ch04_figure_4_09c": (ROUTE, lambda: chart(constant_diametral_pitch(32), PLACES["4_09c"])),
    "ch04_figure_4_13a": (ROUTE, lambda: chart(constant_pitch_radius(25), PLACES["4_13a"])),
    "ch04_figure_4_13b": (ROUTE, lambda: chart(constant_pitch_radius(28), PLACES["4_13b"])),
    "ch04_figure_4_13c": (ROUTE, lambda: chart(constant_pitch_radius(32), PLACES["4_13c"])),
    "ch04_figure_4_10": (ROUTE, lambda: bodies(constant_diametral_pitch)),
    "ch04_figure_4_14": (ROUTE, lambda: bodies(constant_pitch_radius)),
    "ch04_design_variants": (ROUTE, variants),
    "ch04_design_bases": (ROUTE, bases),
    "ch04_design_lobe": (ROUTE, lobe),
    "ch04_design_geometric": (ROUTE, geometric),
}


def main(names):
    for name, (route, values) in FIGURES.items():
        if names and name not in names:
            continue
        anchors = list(tqdm(values(), desc=name, disable=None))
        text = yaml.safe_dump(
            {"figure": name, "route": route, "anchors": anchors},
            sort_keys=False,
            allow_unicode=True,
            width=110,
        )
        (FOLDER / f"{name}.yaml").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
