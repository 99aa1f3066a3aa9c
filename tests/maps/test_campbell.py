"""Natural motions over speed: followed through crossings, met by the mesh where closed forms say."""

from dataclasses import dataclass

import numpy as np
import pytest

import facegear as fg
from facegear.floquet.models import Coordinate
from facegear.mechanics.gearboxes import FIGURES
from facegear.plotting import campbell as draw
from tests.figures import texts


@dataclass(frozen=True)
class Crossing:
    """Two oscillators: one keeps 10 rad/s, the other turns from 4 + 2v; a spring couples them."""

    coupling: float = 0.0
    damping_ratio: float = 0.02
    teeth: int = 3

    @property
    def coordinates(self):
        return Coordinate("steady", "m"), Coordinate("rising", "m")

    def system(self, speed):
        frequencies = np.array([10.0, 4.0 + 2.0 * speed])
        stiffness = np.diag(frequencies**2) + self.coupling * np.array([[1.0, -1.0], [-1.0, 1.0]])
        damping = np.diag(2.0 * self.damping_ratio * frequencies)
        return fg.PeriodicSystem(np.eye(2), damping, stiffness, (), 2.0 * np.pi / (self.teeth * speed))


SPEEDS = np.linspace(1.0, 6.0, 8)
DAMPED = np.sqrt(1.0 - 0.02**2)


def test_motions_keep_their_numbers_where_they_cross():
    found = fg.campbell(Crossing(), SPEEDS)
    assert found.mode_name.values.tolist() == ["rising", "steady"]
    rising, steady = found.natural_frequency.values * 2.0 * np.pi
    np.testing.assert_allclose(rising, (4.0 + 2.0 * SPEEDS) * DAMPED, rtol=1e-12)
    np.testing.assert_allclose(steady, 10.0 * DAMPED, rtol=1e-12)
    np.testing.assert_allclose(found.damping_ratio, 0.02, rtol=1e-9)
    np.testing.assert_allclose(found.log_decrement, 2.0 * np.pi * 0.02 / DAMPED, rtol=1e-9)


def test_the_mesh_meets_them_where_closed_forms_say():
    found = fg.campbell(Crossing(), SPEEDS, harmonics=2)
    # s·3v = 10 d, and s·3v = (4 + 2v) d.
    expected = [(10.0 * DAMPED / (3.0 * s), "steady", s) for s in (1, 2)]
    expected += [(4.0 * DAMPED / (3.0 * s - 2.0 * DAMPED), "rising", s) for s in (1, 2)]
    inside = sorted(row for row in expected if SPEEDS[0] < row[0] < SPEEDS[-1])
    names = found.mode_name.values[found.crossing_mode.values - 1].tolist()
    assert (names, found.crossing_harmonic.values.tolist()) == (
        [row[1] for row in inside],
        [row[2] for row in inside],
    )
    np.testing.assert_allclose(found.crossing_speed, [row[0] for row in inside], rtol=1e-10)


def test_coupled_motions_veer():
    """The lower stays the lower, whatever it is called at first."""
    found = fg.campbell(Crossing(coupling=4.0), np.linspace(1.0, 6.0, 60))
    lower, upper = found.natural_frequency.values
    assert (lower < upper).all()
    steady = np.linalg.eigvalsh(np.array([[104.0, -4.0], [-4.0, 16.0**2 + 4.0]]))[0]
    assert lower[-1] * 2.0 * np.pi == pytest.approx(np.sqrt(steady), rel=1e-3)


def test_a_motion_that_is_overdamped_has_no_frequency():
    @dataclass(frozen=True)
    class Damped(Crossing):
        def system(self, speed):
            damping = np.diag([0.4, 30.0 if speed > 3.0 else 0.3])
            stiffness = np.diag([100.0, 64.0])
            return fg.PeriodicSystem(np.eye(2), damping, stiffness, (), 2.0 * np.pi / speed)

    found = fg.campbell(Damped(), [1.0, 2.0, 4.0, 5.0])
    frequency = found.natural_frequency.values
    assert np.isnan(frequency[0]).tolist() == [False, False, True, True]
    assert not np.isnan(frequency[1]).any()


def test_waves_of_a_disk_run_with_its_rotation_and_against_it():
    body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    speeds = fg.rad_per_s(np.array([5.0, 600.0, 2400.0]))
    found = fg.campbell(fg.Transverse(body, fg.MeshLoad(0.0, 0.0, 0.0)), speeds)
    for diameters in (1, 2, 3):
        named = found.mode_name.values == f"face gear (0, {diameters})"
        low, high = np.sort(found.natural_frequency.values[named], axis=0)
        np.testing.assert_allclose(high - low, 2 * diameters * speeds / (2.0 * np.pi), rtol=1e-7)


def test_shapes_of_a_gearbox_are_those_of_its_matrices():
    model = FIGURES["7.12a"].model()
    found = fg.mode_shapes(model, fg.rad_per_s(500.0))
    assert found.coordinate.values.tolist() == ["pinion", "face gear", "load"]
    values, vectors = np.linalg.eig(np.linalg.solve(model.gearbox.in_si.mass_matrix, model.mean_stiffness))
    order = np.argsort(values)
    np.testing.assert_allclose(found.natural_frequency.values * 2 * np.pi, np.sqrt(values[order]), rtol=0.02)
    np.testing.assert_allclose(found.energy_share.sum("coordinate"), 1.0, rtol=1e-12)
    for number, column in enumerate(vectors[:, order].T):
        expected = np.abs(column) / np.abs(column).max()
        # Damping bends the shapes a little.
        np.testing.assert_allclose(found.amplitude.values[number], expected, atol=0.05)


def test_a_meeting_at_a_speed_that_is_given_is_one():
    """It stood there twice, once for the step on either side."""

    @dataclass(frozen=True)
    class Steady:
        def system(self, speed):
            return fg.PeriodicSystem(
                np.eye(2), np.zeros((2, 2)), np.diag([1.0, 4.0]), (), 2.0 * np.pi / speed
            )

    found = fg.campbell(Steady(), [0.5, 1.0, 1.5, 2.0], harmonics=2)
    rows = list(
        zip(
            found.crossing_speed.values.tolist(),
            found.crossing_mode.values.tolist(),
            found.crossing_harmonic.values.tolist(),
            strict=True,
        )
    )
    assert rows == [(0.5, 1, 2), (1.0, 1, 1), (1.0, 2, 2), (2.0, 2, 1)]
    # Coordinates without names have numbers.
    assert found.mode_name.values.tolist() == ["coordinate 1", "coordinate 2"]
    assert fg.mode_shapes(Steady(), 1.0).coordinate.values.tolist() == ["coordinate 1", "coordinate 2"]


def test_parts_of_the_energy_are_never_negative():
    """A pinion's mass couples the modes of the disk."""
    body = fg.Body(fg.Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=2)
    found = fg.mode_shapes(fg.Transverse(body, fg.MeshLoad(1.0, 3e-6, 1.0)), fg.rad_per_s(457.0))
    assert float(found.energy_share.min()) >= 0.0
    np.testing.assert_allclose(found.energy_share.sum("coordinate"), 1.0, rtol=1e-12)


def test_lines_of_the_mesh_are_drawn_over_few_speeds():
    body = fg.Body(fg.Drive(26, 130, 3.175e-3), 0.03, nodal_circles=0, nodal_diameters=2)
    model = fg.Transverse(body, fg.MeshLoad(1.0, 3e-6, 1.0))
    figure = draw.campbell(fg.campbell(model, fg.rad_per_s(np.linspace(50.0, 1000.0, 8)), harmonics=1))
    (line,) = [line for line in figure.axes[0].lines if line.get_linestyle() == "--"]
    assert np.isfinite(line.get_xydata()).all()
    assert np.ptp(line.get_xdata()) > 50.0


def test_nothing_that_oscillates_is_nothing_to_draw():
    @dataclass(frozen=True)
    class Stiff:
        coordinates = (Coordinate("x", "m"), Coordinate("y", "m"))

        def system(self, speed):
            return fg.PeriodicSystem(np.eye(2), 9.0 * np.eye(2), np.diag([1.0, 4.0]), (), 2.0 * np.pi / speed)

    for data, picture in (
        (fg.campbell(Stiff(), [1.0, 2.0]), draw.campbell),
        (fg.mode_shapes(Stiff(), 1.0), draw.mode_shapes),
    ):
        assert data.sizes["mode"] == 0
        with pytest.raises(ValueError, match="data must have at least one motion that oscillates"):
            picture(data)


def test_figures_have_the_axes_that_users_of_rotors_know():
    figure = draw.campbell(fg.campbell(Crossing(), SPEEDS))
    shown = texts(figure)
    for words in ("speed of the face gear [rpm]", "frequency [Hz]", "logarithmic decrement", "1 × mesh"):
        assert words in shown
    shapes = draw.mode_shapes(fg.mode_shapes(FIGURES["7.12a"].model(), 52.0))
    assert "part of the kinetic energy" in texts(shapes)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: fg.campbell(3, [1.0, 2.0]), TypeError, "model must have a method"),
        (lambda: fg.campbell(Crossing(), [2.0, 1.0]), ValueError, "speeds"),
        (lambda: fg.campbell(Crossing(), [1.0, 2.0], harmonics=0), ValueError, "harmonics"),
        (lambda: fg.mode_shapes(Crossing(), -1.0), ValueError, "speed must be greater than 0"),
    ],
)
def test_bad_input_names_the_parameter(call, error, message):
    with pytest.raises(error, match=message):
        call()
