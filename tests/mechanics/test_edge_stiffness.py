"""K_f: the text's entries in complex exponentials, the strong form, what makes it unsymmetric, power of the model."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from facegear.floquet.models import replace_parameter
from facegear.mechanics.cases import CASE_1, CASE_2, FIGURES
from facegear.mechanics.contact import Contact
from facegear.mechanics.disk import disk_matrices, shape_vector, unit_shape
from facegear.mechanics.edge_stiffness import (
    DrivingForce,
    complete_harmonics,
    edge_load_stiffness,
    strong_form_stiffness,
    unit_stiffness,
)
from facegear.mechanics.inplane import EdgeLoadStress
from tests.independent.edge_load import LoadedDisk
from tests.mechanics.test_transverse import complex_disk, unitary


@cache
def text_stiffness(body, speed, harmonics):
    plain = complex_disk(body)
    names = ("radial", "M", "N", "a", "b", "h", "E", "rho", "nu", "xi")
    disk = LoadedDisk(**{name: getattr(plain, name) for name in names}, force=1.0, harmonics=harmonics)
    U = unitary(body)
    return U.conj().T @ disk.load_stiffness(speed) @ U


@pytest.mark.parametrize(("body", "speed", "harmonics"), [(CASE_1, 0.0, 5), (CASE_2, 104.7, 6)])
def test_entries_are_those_of_the_text(body, speed, harmonics):
    expected = text_stiffness(body, speed, harmonics)
    found = edge_load_stiffness(EdgeLoadStress(body, 1.0, speed, harmonics))
    np.testing.assert_allclose(found, expected, atol=1e-11 * np.abs(found).max())


@pytest.mark.parametrize("direction", ["tangential", "radial"])
def test_strong_form_gives_the_same_matrix(direction):
    stress = EdgeLoadStress(CASE_1, 1e4, harmonics=6, direction=direction, angle=0.4)
    weak = edge_load_stiffness(stress)
    np.testing.assert_allclose(strong_form_stiffness(stress), weak, atol=1e-12 * np.abs(weak).max())
    with pytest.raises(ValueError, match="at rest"):
        strong_form_stiffness(replace(stress, speed=1.0))


def test_only_the_rim_term_of_a_follower_force_is_unsymmetric():
    stress = EdgeLoadStress(CASE_1, 1.0, 50.0, 6)
    dead = edge_load_stiffness(stress, "dead")
    np.testing.assert_allclose(dead, dead.T, atol=1e-13 * np.abs(dead).max())
    # The rim term by itself: the concentrated force pushes sideways by F w_θ/a on the deflection under it, with the
    # harmonics that the sum leaves out left out here too, so that only a basis without them can be compared.
    body = replace(CASE_1, nodal_diameters=2)
    stress = EdgeLoadStress(body, 1.0, 0.0, 4)
    rim = edge_load_stiffness(stress) - edge_load_stiffness(stress, "dead")
    a = body.outer_radius
    value = shape_vector(body, a, 0.0)
    slope = unit_shape(body.modes, 1.0, 0.0, by_angle=1) / a**2
    expected = -np.outer(value, slope) / (2 * np.pi * body.material.density * body.thickness)
    np.testing.assert_allclose(rim, expected, atol=1e-11 * np.abs(expected).max())


def test_harmonics_beyond_twice_the_diameters_do_nothing():
    complete = edge_load_stiffness(EdgeLoadStress(CASE_1, 1.0, 10.0, complete_harmonics(CASE_1)))
    more = edge_load_stiffness(EdgeLoadStress(CASE_1, 1.0, 10.0, 11))
    np.testing.assert_allclose(more, complete, rtol=0.0, atol=1e-12 * np.abs(complete).max())
    printed = edge_load_stiffness(EdgeLoadStress(CASE_1, 1.0, 10.0, 5))
    # k = 6 couples n = 3 with n = -3 only: the last four coordinates.
    changed = np.abs(complete - printed) > 1e-9 * np.abs(complete).max()
    assert changed[-4:, -4:].any()
    assert not changed[:-4].any()
    assert not changed[:, :-4].any()


@pytest.mark.parametrize("speed", [0.0, 3.0, 104.7, 127.0, 129.0, 900.0])
def test_series_in_speed_equals_the_matrix_itself(speed):
    series = unit_stiffness(CASE_1, speed, 5, "follower", (0.3,))
    direct = edge_load_stiffness(EdgeLoadStress(CASE_1, 1.0, speed, 5, angle=0.3))
    np.testing.assert_allclose(series, direct, atol=1e-12 * np.abs(direct).max())


def test_forces_add_up():
    both = unit_stiffness(CASE_1, 60.0, 5, "follower", (0.0, 2.0))
    parts = [unit_stiffness(CASE_1, 60.0, 5, "follower", (angle,)) for angle in (0.0, 2.0)]
    np.testing.assert_allclose(both, sum(parts), atol=1e-12 * np.abs(both).max())


def test_driving_force_of_the_text():
    power, speed = 1e5, 500.0
    force = DrivingForce(power, speed).newtons(CASE_1.drive)
    assert force == pytest.approx(power / speed / (26 * 3.175e-3 / 2), rel=1e-12)


class TestPowerOfTheModel:
    MODEL = FIGURES["4.4a"].model(force=DrivingForce(2e5, 500.0))
    NEWTONS = 2e5 / 500.0 / (26 * 3.175e-3 / 2)

    def test_only_the_stiffness_changes_and_in_proportion(self):
        plain, loaded = FIGURES["4.4a"].model().system(70.0), self.MODEL.system(70.0)
        double = replace_parameter(self.MODEL, "power", 4e5).system(70.0)
        np.testing.assert_allclose(loaded.damping, plain.damping, rtol=1e-12, atol=0.0)
        np.testing.assert_allclose(
            double.stiffness - plain.stiffness, 2 * (loaded.stiffness - plain.stiffness), atol=1e-6
        )
        expected = self.NEWTONS * unit_stiffness(CASE_1, 70.0, 5, "follower", (0.0,))
        np.testing.assert_allclose(loaded.stiffness - plain.stiffness, expected, atol=1e-6)

    def test_no_power_is_no_force(self):
        plain = FIGURES["4.4a"].model()
        expected = disk_matrices(CASE_1, 50.0)[1]
        none = replace_parameter(self.MODEL, "power", 0.0)
        for model in (plain, none):
            stiffness = model.system(50.0).stiffness
            np.testing.assert_allclose(stiffness, expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())

    def test_each_pinion_brings_its_force_and_travel_mirrors_the_place(self):
        angles = (0.0, 1.2)
        printed = replace(self.MODEL, pinion_angles=angles)
        mirrored = replace(printed, contact=Contact(travel="with_disk"))
        for model, places in ((printed, angles), (mirrored, (0.0, -1.2))):
            added = model.system(60.0).stiffness - disk_matrices(CASE_1, 60.0)[1]
            expected = self.NEWTONS * unit_stiffness(CASE_1, 60.0, 5, "follower", places)
            np.testing.assert_allclose(added, expected, atol=1e-6)

    @pytest.mark.parametrize(
        ("change", "error", "message"),
        [
            ({"power": None}, TypeError, "power must be a real number"),
            ({"power": -1.0}, ValueError, "power must be 0 or greater"),
            ({"pinion_speed": 0.0}, ValueError, "pinion_speed must be greater than 0"),
            ({"power": "much"}, TypeError, "power must be a real number"),
            ({"following": "tangent"}, ValueError, "following must be"),
            ({"harmonics": 5.0}, TypeError, "harmonics must be an integer"),
        ],
    )
    def test_bad_input_is_named(self, change, error, message):
        with pytest.raises(error, match=message):
            DrivingForce(**({"power": 1.0, "pinion_speed": 1.0} | change))


def test_bad_stress_is_named():
    with pytest.raises(TypeError, match="stress must be an EdgeLoadStress"):
        edge_load_stiffness(3)
    with pytest.raises(ValueError, match="following must be"):
        edge_load_stiffness(EdgeLoadStress(CASE_1, 1.0), "free")
    with pytest.raises(ValueError, match="speed must lie"):
        unit_stiffness(CASE_1, 1e5, 5, "follower", (0.0,))


def test_a_power_that_no_body_bears_is_refused_with_one_that_is_not():
    """What breaks any steel goes, and the largest power of a drive file at a usual speed; a slip of units does not."""
    model = FIGURES["4.4a"].model()
    with pytest.raises(
        ValueError, match=r"power must be at most (\S+) W at pinion_speed=1\.0 rad/s .* got 1000000000000.0 W"
    ) as told:
        replace(model, force=DrivingForce(1e12, 1.0))
    most = float(str(told.value).split()[5])
    replace(model, force=DrivingForce(0.99 * most, 1.0))
    with pytest.raises(ValueError, match="power must be at most"):
        replace(model, force=DrivingForce(1.01 * most, 1.0))
    replace(model, force=DrivingForce(1e8, 500.0))
