import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm

from compendium.datasets import modulation as modulation_arrays
from compendium.datasets import torsional_design as torsional_design_arrays
from compendium.datasets.modulation import ScaledModulation, undamped
from facegear.floquet.hsu import resonance_bands
from facegear.floquet.labels import Combination
from facegear.floquet.models import replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.geometry.drive import Drive
from facegear.maps.sensitivity import border_derivatives
from facegear.maps.tracing import tongues
from facegear.mechanics.gearboxes import DRIVE, FIGURES
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.transverse import Transverse
from facegear.support.labelled import label_rows
from facegear.support.parameters import rad_per_s, rpm
from tests.independent.torsional_switching import numbers_of, spectral_radius

LIGHT = replace_parameter(FIGURES["7.12a"].model(), "input_damping", 1e-6)


class TestScaledModulation:
    def test_full_depth_is_the_model_itself(self):
        speed = 40.0
        scaled, real = ScaledModulation(LIGHT, 1.0).system(speed), LIGHT.system(speed)
        x = np.linspace(0.0, 1.0, 23, endpoint=False)
        for name in ("damping_matrix", "stiffness_matrix"):
            np.testing.assert_allclose(getattr(scaled, name)(x), getattr(real, name)(x), rtol=1e-12)

    def test_no_depth_is_the_mean_whose_growth_is_an_eigenvalue(self):
        speed = 40.0
        system = ScaledModulation(LIGHT, 0.0).system(speed)
        real = LIGHT.system(speed)

        def mean(name, i, j):
            edges = (*real.breakpoints, 1.0)
            parts = (quad(lambda x: float(getattr(real, name)(x)[i, j]), a, b)[0] for a, b in pairwise(edges))
            return sum(parts)

        C, K = (
            np.array([[mean(n, i, j) for j in range(3)] for i in range(3)])
            for n in ("damping_matrix", "stiffness_matrix")
        )
        np.testing.assert_allclose(system.stiffness_matrix(0.3), K, rtol=1e-10)
        inverse = np.linalg.inv(real.mass)
        state = np.block([[np.zeros((3, 3)), np.eye(3)], [-inverse @ K, -inverse @ C]])
        radius = np.abs(np.linalg.eigvals(expm(state * real.period))).max()
        assert growth_rate(system) == pytest.approx(math.log(radius) / real.period, rel=1e-8)

    def test_variation_is_in_proportion_to_depth(self):
        x = np.array([0.2, 0.9])
        change = [
            np.diff(ScaledModulation(LIGHT, d).system(40.0).stiffness_matrix(x), axis=0) for d in (1.0, 0.25)
        ]
        np.testing.assert_allclose(0.25 * change[0], change[1], rtol=1e-9)

    def test_model_with_a_moving_mass_is_refused(self):
        body = Body(Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=1)
        with pytest.raises(ValueError, match="model must have a constant mass"):
            ScaledModulation(Transverse(body, MeshLoad(1.0, 3e-6, 1.0)), 0.5).system(40.0)

    def test_negative_depth_is_refused(self):
        with pytest.raises(ValueError, match="depth must be"):
            ScaledModulation(LIGHT, -0.1).system(40.0)


def test_hsu_errs_by_the_square_of_the_modulation():
    data = modulation_arrays.hsu_errors([(LIGHT, Combination(1, 1, "sum", 1))], [0.02, 0.05])
    assert modulation_arrays.fitted_orders(data, "border_error", 0.1)[0] == pytest.approx(2.0, abs=0.05)
    assert modulation_arrays.fitted_orders(data, "width", 0.1)[0] == pytest.approx(1.0, abs=0.05)
    (band,) = [
        b
        for b in resonance_bands(ScaledModulation(undamped(LIGHT), 0.05).system(50.0), order=1)
        if b.label == "(1+1)/1"
    ]
    assert float(data.hsu_upper.sel(depth=0.05)[0]) == pytest.approx(
        rpm(band.upper) / DRIVE.gear_teeth, rel=1e-9
    )


def test_resonance_that_hsu_does_not_know_is_refused():
    with pytest.raises(ValueError, match="resonances must have one band"):
        modulation_arrays.hsu_errors([(LIGHT, Combination(1, 7, "sum", 1))], [0.02])


def test_opening_depth_is_where_independent_growth_changes_sign():
    data = modulation_arrays.openings(LIGHT, {Combination(1, 1, "sum", 1): (620, 670)}, [0.15, 0.2, 0.25])
    opening, n = float(data.opening[0]), numbers_of(LIGHT)
    assert 0.2 < opening < 0.21
    assert float(data.hsu_opening[0]) == pytest.approx(opening, rel=0.01)
    # At full depth the tongue is wide open, by the independent route too.
    assert spectral_radius(n, 640.0) > 1.1


def test_conjugate_arm_leaves_every_tongue_and_the_geometric_ratio_only_one():
    models = torsional_design_arrays.variants(LIGHT)
    chosen = {name: models[name] for name in ("as printed", "conjugate arm", "geometric contact ratio")}
    data = torsional_design_arrays.variant_tongues(chosen, (290.0, 900.0))
    assert label_rows(data["label"]) == [["(1+1)/2", "(1+1)/1"], ["(1+1)/2", "(1+1)/1"], ["(1+1)/1"]]
    shift = data.lower.values[1] / data.lower.values[0] - 1.0
    assert ((shift < -0.01) & (shift > -0.02)).all()
    assert data.modulation.values[2, 0] < 0.4 * data.modulation.values[0, 0]


def test_softer_pairs_keep_shafts_and_mean_mesh_stiffness():
    models = torsional_design_arrays.variants(LIGHT)
    hard, easy = models["as printed"], models["the same, softer pairs"]
    plain, soft = hard.gearbox.in_si, easy.gearbox.in_si
    assert soft.input_stiffness == pytest.approx(plain.input_stiffness, rel=1e-14)
    assert soft.output_stiffness == pytest.approx(plain.output_stiffness, rel=1e-14)
    assert soft.mesh_stiffness * easy.contact_ratio == pytest.approx(
        plain.mesh_stiffness * hard.contact_ratio, rel=1e-14
    )


def test_arms_start_and_end_at_the_radii_of_the_tooth():
    data = torsional_design_arrays.arms(3)
    cosine = math.cos(math.radians(25))
    np.testing.assert_allclose(
        data.printed, cosine * np.linspace(DRIVE.outer_radius, DRIVE.inner_radius, 3), rtol=1e-14
    )
    np.testing.assert_allclose(data["conjugate"], 107 * 25.4e-3 / 8 / 2 * cosine, rtol=1e-14)


def test_pairs_in_mesh_have_their_mean_and_harmonic():
    data = torsional_design_arrays.pairs_in_mesh(20_001)
    one = data.isel(fraction=slice(0, 10_000))
    np.testing.assert_allclose(one.pairs.mean("fraction"), 1.0, atol=2e-4)
    wave = np.exp(2j * np.pi * one.fraction.values)
    np.testing.assert_allclose(2 * np.abs((one.pairs.values * wave).mean(axis=1)), data.harmonic, atol=2e-4)


def test_levers_agree_with_independent_borders():
    """A percent more of J2 moves both borders as DOP853 says."""
    model = replace(LIGHT, gearbox=LIGHT.gearbox.in_si)
    (tongue,) = tongues(model, (float(rad_per_s(560.0)), float(rad_per_s(720.0))))
    n = numbers_of(model)
    for border in (tongue.lower, tongue.upper):
        speed = float(rpm(border))
        # Steps far below a revolution per minute: that is how far inside the border two multipliers meet.
        fast, slow = (spectral_radius(n, speed * (1 + s)) for s in (1e-5, -1e-5))
        by_speed = (fast - slow) / (2e-5 * speed)
        up, down = (spectral_radius(replace(n, J2=n.J2 * (1 + s)), speed) for s in (1e-4, -1e-4))
        expected = -(up - down) / 2e-4 / by_speed
        found = (
            float(rpm(border_derivatives(model, border, ("gear_inertia",))[0])) * model.gearbox.gear_inertia
        )
        assert found == pytest.approx(expected, rel=5e-4)


@pytest.mark.slow
def test_closing_and_opening_dampings_separate_stable_from_unstable():
    """DOP853 on both sides of each root of the principal tongue of Fig. 7.12(a)."""
    model = FIGURES["7.12a"].model()
    data = torsional_design_arrays.closing(
        model, "input_damping", np.geomspace(1e-5, 1e-2, 7), {"(1+1)/1": (560, 820)}
    )
    assert data.closes.values[0].tolist() == [1.0, -1.0]
    for value, speed, sign in zip(
        data.closing_damping.values[0], data.closing_speed.values[0], (1.0, -1.0), strict=True
    ):
        inside, outside = (
            numbers_of(replace_parameter(model, "input_damping", value * (1 - sign * s)))
            for s in (1e-4, -1e-4)
        )
        assert spectral_radius(inside, speed) > 1.0
        assert max(spectral_radius(outside, speed + d) for d in (-2.0, -0.5, 0.0, 0.5, 2.0)) < 1.0


@pytest.mark.slow
def test_every_closing_value_is_found_that_a_dense_scan_of_tongues_sees():
    model = FIGURES["7.12a"].model()
    low, high = float(rad_per_s(295.0)), float(rad_per_s(390.0))
    scan = np.geomspace(1e-6, 3e-2, 60)
    found = [bool(tongues(replace_parameter(model, "input_damping", c), (low, high))) for c in scan.tolist()]
    changes = [math.sqrt(scan[i] * scan[i + 1]) for i in range(59) if found[i] != found[i + 1]]
    data = torsional_design_arrays.closing(
        model, "input_damping", np.geomspace(1e-6, 3e-2, 8), {"(1+1)/2": (295, 390)}
    )
    np.testing.assert_allclose(data.closing_damping.values[0], changes, rtol=0.1)


def test_a_tongue_with_another_label_is_refused():
    with pytest.raises(ArithmeticError, match=r"is \(1\+1\)/1, not \(1\+2\)/1"):
        torsional_design_arrays.closing(
            FIGURES["7.12a"].model(), "input_damping", [1.5e-4, 1.9e-4, 2.4e-4], {"(1+2)/1": (640, 680)}
        )
