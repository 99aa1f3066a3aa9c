"""A damaged tooth: products of mesh periods, equations of a revolution, and what multipliers cannot tell."""

import dataclasses

import mpmath
import numpy as np
import pytest

from facegear.floquet.multipliers import transition_matrices, transition_matrix
from facegear.floquet.response import steady_response
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.mechanics.contact import Contact
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.tooth_damage import DamagedTooth
from facegear.mechanics.torsional import Torsional
from facegear.support.parameters import rad_per_s
from tests.independent.monodromy import integrated

GEARBOX = Torsional(FIGURES["7.12b"].gearbox.in_si)
SPEED = float(rad_per_s(700.0))
# As few teeth as there can be, so that an integrator gets through a revolution.
SMALL = Torsional(dataclasses.replace(GEARBOX.gearbox, drive=Drive(12, 40, 3.175e-3 * 31 / 12)))


def relative(found, truth):
    return np.abs(found - truth).max() / np.abs(truth).max()


@pytest.mark.parametrize("wheel", ["face gear", "pinion"])
@pytest.mark.parametrize("tooth", [0, 7, 30])
def test_product_of_mesh_periods_is_the_revolution(wheel, tooth):
    model = DamagedTooth(GEARBOX, 0.2, tooth, wheel)
    assert relative(model.transition_matrix(SPEED), transition_matrix(model.system(SPEED))) < 1e-8


def test_another_integrator():
    """DOP853 over the revolution of a pinion with twelve teeth, under a torque."""
    model = DamagedTooth(SMALL, 0.3, 5, "pinion", torque=500.0)
    system = model.system(300.0)
    both = integrated(system, forced=True)
    assert relative(model.transition_matrix(300.0), both[:, :-1]) < 1e-8
    start = np.linalg.solve(np.eye(6) - both[:, :-1], both[:, -1])
    assert relative(steady_response(system).state(0.0), start) < 1e-8


def test_small_losses_vanish():
    whole = np.linalg.matrix_power(transition_matrix(GEARBOX.system(SPEED)), 31)
    steps = [
        np.linalg.norm(DamagedTooth(GEARBOX, loss, 3, "pinion").transition_matrix(SPEED) - whole)
        for loss in (1e-3, 1e-4)
    ]
    assert steps[0] / steps[1] == pytest.approx(10.0, rel=0.01)


def test_multipliers_do_not_tell_the_tooth():
    """Traces of powers of a product do not change when its factors are shifted round: here to 50 digits."""
    intact, *damaged = transition_matrices(DamagedTooth(GEARBOX, 0.3).mesh_periods(SPEED))
    with mpmath.workdps(60):
        kinds = [mpmath.matrix(x.tolist()) for x in (intact, *damaged)]
        characteristic = []
        for tooth in (0, 40, 105, 106):
            model = DamagedTooth(GEARBOX, 0.3, tooth)
            order = dict(zip(model.damaged_periods, kinds[1:], strict=True))
            product = mpmath.eye(6)
            for number in range(107):
                product = order.get(number, kinds[0]) * product
            powers = [product]
            for _ in range(5):
                powers.append(powers[-1] * product)
            characteristic.append([sum(p[i, i] for i in range(6)) for p in powers])
        for other in characteristic[1:]:
            for first, second in zip(characteristic[0], other, strict=True):
                assert abs(first - second) < mpmath.mpf(10) ** -40
    # The matrices themselves differ.
    first, second = (DamagedTooth(GEARBOX, 0.3, tooth).transition_matrix(SPEED) for tooth in (0, 40))
    assert relative(first, second) > 1e-3


def test_multipliers_in_double_precision():
    found = [
        np.linalg.eigvals(DamagedTooth(GEARBOX, 0.3, tooth, "pinion").transition_matrix(SPEED))
        for tooth in range(31)
    ]
    for values in found[1:]:
        for value in found[0][np.abs(found[0]) > 0.1]:
            assert np.abs(values - value).min() < 1e-12 * abs(value)


def test_response_of_another_tooth_comes_later():
    """By as many mesh periods: sidebands turn by as many times their order over N2 revolutions."""
    first, second = (
        steady_response(DamagedTooth(GEARBOX, 0.3, tooth, torque=800.0).system(SPEED)).harmonics(250)[:, 1]
        for tooth in (0, 33)
    )
    expected = first * np.exp(-2j * np.pi * np.arange(251) * 33 / 107)
    np.testing.assert_allclose(second, expected, atol=1e-9 * np.abs(first).max())
    assert np.abs(second - first).max() > 0.01 * np.abs(first[1:]).max()
    # The intact gearbox has harmonics of the mesh only.
    intact = steady_response(DamagedTooth(GEARBOX, 0.3, torque=800.0).pressed(SPEED).repeated(107))
    lines = np.abs(intact.harmonics(250)[:, 1])
    lines[[0, 107, 214]] = 0.0
    assert lines.max() < 1e-10 * np.abs(first[1:]).max()


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"loss": 0.0}, ValueError, "loss must be at least 1e-09 and below 1, got 0"),
        ({"loss": 1.0}, ValueError, "loss must be at least 1e-09 and below 1, got 1"),
        ({"loss": "0.1"}, TypeError, "loss"),
        ({"tooth": 107}, ValueError, "tooth"),
        ({"tooth": 31, "wheel": "pinion"}, ValueError, "tooth"),
        ({"wheel": "load"}, ValueError, "wheel must be"),
        ({"torque": -1.0}, ValueError, "torque"),
        ({"torsional": 3}, TypeError, "torsional must be a Torsional"),
        (
            {"torsional": dataclasses.replace(GEARBOX, contact=Contact(ContactPath, rate="total"))},
            ValueError,
            'sharing "each"',
        ),
    ],
)
def test_bad_input_names_the_parameter(change, error, message):
    with pytest.raises(error, match=message):
        DamagedTooth(**({"torsional": GEARBOX, "loss": 0.1} | change))
    with pytest.raises(ValueError, match="speed"):
        DamagedTooth(GEARBOX, 0.1).system(0.0)
