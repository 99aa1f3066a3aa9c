"""The torsional model against its printed numbers, an independent integrator and the physics it stands for."""

import math
from dataclasses import fields, replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import Chebyshev

from facegear.floquet.error_estimates import error_estimate
from facegear.floquet.fourier import fourier_series
from facegear.floquet.methods import AdaptiveMagnus
from facegear.floquet.multipliers import growth_rate, multipliers, transition_matrix
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import CentroidPath, ContactPath
from facegear.maps.stability_map import stability_map
from facegear.mechanics.contact import SKEW_LINE
from facegear.mechanics.gearboxes import DRIVE, FIGURES, GEAR_INERTIA, PINION_INERTIA
from facegear.mechanics.tooth_stiffness import mesh_stiffness
from facegear.mechanics.torsional import Gearbox, Torsional, cylinder_inertia, natural_speed
from facegear.support.parameters import rad_per_s, rpm
from tests.independent.torsional_switching import monodromy, numbers_of, spectral_radius

BOX = FIGURES["7.12a"].gearbox.in_si
EACH = {
    "skew_line": SKEW_LINE,
    "contact_path": replace(SKEW_LINE, path=ContactPath),
    "centroid": replace(SKEW_LINE, path=CentroidPath),
}


def radius_of(model, speed_rpm):
    return float(np.abs(multipliers(model.system(rad_per_s(speed_rpm)))[0]))


def test_printed_inertias():
    assert pytest.approx(1.6e-3, abs=0.05e-3) == PINION_INERTIA
    assert pytest.approx(91.97, abs=0.005) == GEAR_INERTIA / PINION_INERTIA
    # The text's pitch radius does not give the printed J1.
    assert cylinder_inertia(DRIVE.pitch_radius, DRIVE.face_width) == pytest.approx(2.43e-3, abs=0.005e-3)


def test_mean_stiffness_is_the_closed_form():
    # ∫ over cr periods of φφᵀ with r falling linearly from R2 to R1
    r1, r2, rb, cr = DRIVE.inner_radius, DRIVE.outer_radius, DRIVE.base_radius, DRIVE.contact_ratio
    cosine = math.cos(DRIVE.pressure_angle)
    first, second = (r1 + r2) / 2, (r1**2 + r1 * r2 + r2**2) / 3
    mesh = np.array(
        [[rb**2, -rb * cosine * first, 0], [-rb * cosine * first, cosine**2 * second, 0], [0, 0, 0]]
    )
    expected = BOX.stiffness_matrix + BOX.mesh_stiffness * cr * mesh
    assert Torsional(BOX).mean_stiffness == pytest.approx(expected, rel=1e-12)


def test_lowest_natural_frequency_of_a_soft_input_shaft():
    # A soft input shaft moves everything as one body with the inertia seen from the pinion.
    box = replace(BOX, input_stiffness=1.0, output_stiffness=1e7, load_inertia=1.0)
    model = Torsional(box, arm="conjugate")
    ratio = DRIVE.speed_ratio
    inertia = box.pinion_inertia + ratio**2 * (box.gear_inertia + box.load_inertia)
    assert model.natural_frequencies()[0] == pytest.approx(math.sqrt(1.0 / inertia), rel=1e-5)
    assert model.natural_speeds() == pytest.approx(model.natural_frequencies() / DRIVE.gear_teeth)


def test_natural_speed_is_where_the_mesh_period_is_the_natural_one():
    # (7-20) with rpm on both sides
    assert rpm(natural_speed(DRIVE, 1000.0)) == pytest.approx(60 * 1000.0 / (2 * math.pi * 107))


@pytest.mark.parametrize(
    ("name", "speed_rpm"),
    [("7.9a", 900.0), ("7.11b", 650.0), ("7.12a", 158.5), ("7.12b", 147.0), ("7.13a", 571.0)],
)
def test_multipliers_against_switch_split_dop853(name, speed_rpm):
    model = FIGURES[name].model()
    truth = spectral_radius(numbers_of(model), speed_rpm)
    assert radius_of(model, speed_rpm) == pytest.approx(truth, abs=1e-10)
    system = model.system(rad_per_s(speed_rpm))
    assert error_estimate(system, AdaptiveMagnus()) < 1e-8


def test_contact_path_and_conjugate_arm_against_dop853():
    speed = 320.0
    numbers = numbers_of(Torsional(BOX))
    path = ContactPath(DRIVE)
    # Radius and slope of each pair from a polynomial through contact points, piece by piece.
    pieces = {}
    for start, stop in pairwise((*path.breakpoints, 1.0)):
        for pair in range(path.pairs):
            if (start + stop) / 2 + pair < path.contact_ratio:
                fit = Chebyshev.interpolate(
                    lambda x: path.contact_point(np.minimum(x / path.contact_ratio, 1.0)).radius,
                    30,
                    domain=(start + pair, stop + pair),
                )
                pieces[start + pair, stop + pair] = fit, fit.deriv()

    def on_path(pair, x, T0, inside):
        fit, slope = next(both for (low, high), both in pieces.items() if low < inside < high)
        return fit(x), slope(x) / T0

    exact = spectral_radius(numbers, speed, radius=on_path, switches=path.breakpoints, rtol=1e-12)
    assert radius_of(Torsional(BOX, EACH["contact_path"]), speed) == pytest.approx(exact, abs=1e-9)

    arm = DRIVE.base_radius / DRIVE.speed_ratio / math.cos(DRIVE.pressure_angle)
    exact = spectral_radius(numbers, speed, radius=lambda *_: (arm, 0.0))
    for path_name in ("skew_line", "contact_path", "centroid"):
        model = Torsional(BOX, EACH[path_name], arm="conjugate")
        assert radius_of(model, speed) == pytest.approx(exact, abs=1e-10)


def test_centroid_path_has_one_arm_for_all_pairs():
    model = Torsional(BOX, EACH["centroid"])
    first, second = (shape(0.2) for shape in model.shapes)
    assert first == pytest.approx(second, rel=1e-14)
    centroid = ContactPath(DRIVE).centroid(0.2).radius
    assert first == pytest.approx([DRIVE.base_radius, -centroid * math.cos(DRIVE.pressure_angle), 0.0])


def test_skew_line_starts_outside_and_leaves_inside():
    young, old = Torsional(BOX).shapes
    cosine = math.cos(DRIVE.pressure_angle)
    assert young(0.0)[1] == pytest.approx(-DRIVE.outer_radius * cosine, rel=1e-12)
    leaving = DRIVE.contact_ratio - 1
    assert old(leaving, "left")[1] == pytest.approx(-DRIVE.inner_radius * cosine, rel=1e-12)
    assert not old(leaving + 0.01).any()
    assert young(leaving + 0.01)[0] == pytest.approx(DRIVE.base_radius, rel=1e-12)
    # The pair goes on where it stood at the end of its first period.
    assert old(0.0) == pytest.approx(young(1.0, "left"), rel=1e-12)


def test_four_pairs_with_the_geometric_contact_ratio():
    model = Torsional(BOX, replace(SKEW_LINE, contact_ratio=DRIVE.geometric_contact_ratio))
    assert len(model.shapes) == 4
    truth = spectral_radius(numbers_of(model), 500.0)
    assert radius_of(model, 500.0) == pytest.approx(truth, abs=1e-10)


@pytest.mark.parametrize("path", ["skew_line", "contact_path"])
def test_liouville(path):
    # det Φ = exp(−∫ tr M⁻¹C dt)
    model = Torsional(BOX, EACH[path])
    system = model.system(rad_per_s(400.0))
    damping = system.fourier(1)[1].mean
    expected = math.exp(-system.period * np.trace(np.linalg.solve(system.mass, damping)))
    assert np.linalg.det(transition_matrix(system)) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("path", ["skew_line", "centroid"])
def test_kept_fourier_series_are_those_of_the_assembled_matrices(path):
    system = Torsional(BOX, EACH[path]).system(70.0).shift(0.3).replace_loads(damping=[1e3, 4e3])
    assembled = [
        fourier_series(matrix, system.breakpoints, 5)
        for matrix in (system.mass_matrix, system.damping_matrix, system.stiffness_matrix)
    ]
    for one, other in zip(system.fourier(5), assembled, strict=True):
        scale = np.abs(other.mean).max()
        for name in ("mean", "cosine", "sine"):
            assert getattr(one, name) == pytest.approx(getattr(other, name), abs=1e-12 * scale)


@settings(deadline=None, derandomize=True, max_examples=15)
@given(factor=st.floats(0.1, 6.0), speed=st.floats(300.0, 900.0))
def test_multipliers_do_not_depend_on_the_unit_of_time(factor, speed):
    # Stiffness times f², damping and speed times f: the same motion in another unit of time.
    box = replace(
        BOX,
        mesh_stiffness=BOX.mesh_stiffness * factor**2,
        mesh_damping=BOX.mesh_damping * factor,
        input_stiffness=BOX.input_stiffness * factor**2,
        input_damping=BOX.input_damping * factor,
        output_stiffness=BOX.output_stiffness * factor**2,
        output_damping=BOX.output_damping * factor,
    )
    one, other = Torsional(BOX), Torsional(box)
    assert radius_of(other, factor * speed) == pytest.approx(radius_of(one, speed), abs=1e-8)


def test_monodromy_of_the_truth_has_unit_determinant_without_damping():
    numbers = replace(numbers_of(Torsional(BOX)), cm=0.0, c1=0.0, c2=0.0)
    assert np.linalg.det(monodromy(numbers, 700.0)) == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pinion_inertia": 1.6}, "pinion_inertia must lie in"),
        ({"pinion_inertia": math.nan}, "pinion_inertia must lie in .*got nan"),
        ({"gear_inertia": 0.0}, "gear_inertia must be greater than 0"),
        ({"load_inertia": -1.0}, "load_inertia must be greater than 0"),
        ({"mesh_stiffness": 1.58e5}, "wrong by a factor of 1000"),
        ({"mesh_damping": 1.58e8}, "mesh_damping must lie in"),
        ({"input_stiffness": 0.0}, "input_stiffness must be greater than 0"),
        ({"input_damping": -1.0}, "input_damping must be 0 or greater"),
        ({"output_stiffness": math.inf}, "output_stiffness must be finite"),
        ({"output_damping": -1e-3}, "output_damping must be 0 or greater"),
    ],
)
def test_bad_gearbox(change, message):
    with pytest.raises(ValueError, match=message):
        replace(BOX, **change)


def test_map_over_teeth_is_that_of_gearboxes_built_anew():
    teeth, speeds = (29, 31, 33), [33.0, 67.0]
    chart = stability_map(Torsional(BOX), speeds, "pinion_teeth", teeth, jobs=1, progress=False)
    for row, count in zip(chart.values, teeth, strict=True):
        given = {field.name: getattr(BOX, field.name) for field in fields(BOX)}
        anew = Torsional(Gearbox(**given | {"drive": replace(DRIVE, pinion_teeth=count)}))
        assert anew.contact_ratio == anew.drive.contact_ratio
        assert row == pytest.approx([growth_rate(anew.system(speed)) for speed in speeds], abs=1e-6)
    # With the first drive's contact ratio at every count, as it once was, the map is another one.
    kept = Torsional(BOX, replace(SKEW_LINE, contact_ratio=DRIVE.contact_ratio))
    wrong = stability_map(kept, speeds, "pinion_teeth", teeth, jobs=1, progress=False)
    assert np.abs(wrong.values - chart.values).max() > 1e-3


def test_few_teeth_whose_contact_lines_end_on_the_base_circle():
    """The mesh damper follows ṙ, which has no limit on the true contact path; the skew line has none of that."""
    few = replace(BOX, drive=Drive(18, 90, DRIVE.module), pinion_inertia=BOX.pinion_inertia / 4)
    assert Torsional(few).system(50.0).size == 3
    assert Torsional(few, arm="conjugate").system(50.0).size == 3
    for path in ("contact_path", "centroid"):
        with pytest.raises(ValueError, match="pinion_teeth = 18 is too few for rate = 'total'"):
            Torsional(few, EACH[path])


def test_wrong_kinds():
    with pytest.raises(TypeError, match="drive must be a Drive"):
        replace(BOX, drive=(31, 107))
    with pytest.raises(TypeError, match="gearbox must be a Gearbox"):
        Torsional(DRIVE)
    with pytest.raises(ValueError, match="arm must be"):
        Torsional(BOX, arm="constant")
    with pytest.raises(TypeError, match="contact must be a Contact"):
        Torsional(BOX, "circle")
    with pytest.raises(ValueError, match="contact_ratio must lie in"):
        Torsional(BOX, replace(SKEW_LINE, contact_ratio=32.0))
    with pytest.raises(ValueError, match="correction_factor"):
        mesh_stiffness(DRIVE, 0.0)
    with pytest.raises(ValueError, match="speed must be greater than 0"):
        Torsional(BOX).system(0.0)
    with pytest.raises(TypeError, match="pinion_inertia must be"):
        replace(BOX, pinion_inertia="1")
