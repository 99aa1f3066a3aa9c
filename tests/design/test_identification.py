"""Losses from exponents: exact data, bounds from difference quotients, scatter of fits, what is not told."""

import numpy as np
import pytest

from facegear.design.identification import Survey, bound_together
from facegear.design.measurements import drawn, scatter_over_bound
from facegear.floquet.hill import exponents
from facegear.floquet.models import replace_parameter, value_of
from facegear.mechanics.backlash import Backlash
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.torsional import Torsional
from facegear.support.parameters import rad_per_s

GEARBOX = Torsional(FIGURES["7.12b"].gearbox.in_si)
SPEED = float(rad_per_s(700.0))
NAMES = ("input_stiffness", "output_stiffness", "mesh_stiffness")
FREQUENCIES = GEARBOX.natural_frequencies()
LOSSES = np.array([0.05, 0.1, 0.2])


def survey(motions=(0, 1, 2), decays=np.inf, error=1e-3, speed=SPEED):
    sizes = error * FREQUENCIES[list(motions)]
    return Survey(GEARBOX, speed, NAMES, motions, np.stack([decays * sizes, sizes], axis=1))


def moved(losses):
    """Exponents above the real axis by contact-force collocation, slowest decay first."""
    model = GEARBOX
    for name, loss in zip(NAMES, losses, strict=True):
        model = replace_parameter(model, name, value_of(GEARBOX, name) * (1.0 - loss))
    return exponents(model.system(SPEED))


def nearest(found, to):
    return np.array([found[np.abs(found - mu).argmin()] for mu in to])


def test_exact_data_give_exact_losses():
    three = survey()
    assert three.condition(np.zeros(3)) < 5.0
    stiffer = {"start": np.zeros(3), "least": -0.1}
    for losses, where in ((LOSSES, {}), ([0.0, 0.0, 0.3], {}), ([0.3, 0.02, -0.05], stiffer)):
        truth = nearest(moved(losses), three.expected(losses)[0])
        np.testing.assert_allclose(three.identified(truth, **where), losses, atol=1e-6)


def test_images_of_exponents_are_as_good():
    three = survey()
    turns = 2j * np.pi / three.intact.period * np.array([1, -2, 5])
    measured = three.expected(LOSSES)[0] + turns
    np.testing.assert_allclose(three.identified(measured, start=LOSSES + 0.02), LOSSES, atol=1e-8)


def test_large_losses_are_found_though_frequencies_fold():
    """From no losses alone a fit goes astray: to the nearest images, with a part that would be stiffer than new."""
    three = survey(speed=float(rad_per_s(500.0)))
    losses = [0.478, 0.142, 0.324]
    measured = three.expected(losses)[0]
    np.testing.assert_allclose(three.identified(measured), losses, atol=1e-7)
    astray = three.identified(measured, start=[0.0, 0.0, 0.0], least=-1.0)
    assert astray.min() < -0.3
    turns = (three.expected(astray)[0] - measured).imag * three.intact.period / (2.0 * np.pi)
    np.testing.assert_allclose(turns, turns.round(), atol=1e-6)


def test_several_losses_that_fit_are_refused():
    three = survey(speed=float(rad_per_s(500.0)))
    other = [0.1045, 0.8269, 0.0280]  # to four digits
    turn = 2.0 * np.pi / three.intact.period
    away = np.mod((three.expected(other)[0] - three.expected(LOSSES)[0]).imag + turn / 2.0, turn) - turn / 2.0
    assert np.abs(away / three.deviations[:, 1]).max() < 0.05
    with pytest.raises(ArithmeticError, match=r"explained by losses \[.*\] .* and by \[") as told:
        three.identified(three.expected(LOSSES)[0], most=0.9)
    assert "[0.05, 0.1, 0.2]" in str(told.value)
    assert "[0.1045, 0.8269, 0.028]" in str(told.value)


def test_what_no_losses_explain_is_refused():
    three = survey()
    with pytest.raises(
        ArithmeticError, match=r"no losses from 0 to 0.1 .* explain measured \[0j, 0j, 0j\] .* χ²"
    ):
        three.identified([0.0, 0.0, 0.0], most=0.1)
    # Errors of the stated size are explained, far larger ones are not: there are more data than losses.
    known = survey(decays=1e-3)
    measured = known.expected(LOSSES)[0]
    assert np.abs(known.identified(measured, LOSSES) - LOSSES).max() < 1e-9
    size = known.deviations[1, 0]
    assert np.abs(known.identified(measured + size * np.eye(3)[1], LOSSES) - LOSSES).max() < 0.05
    with pytest.raises(ArithmeticError, match="the best"):
        known.identified(measured + 100.0 * size, LOSSES)


def test_bound_from_difference_quotients():
    three = survey(decays=1.0)
    centre, step = three.expected(LOSSES)[0], 1e-4
    columns = []
    for unit in step * np.eye(3):
        ends = [nearest(moved(LOSSES + s * unit), centre) for s in (-1.0, 1.0)]
        change = (ends[1] - ends[0]) / (2.0 * step)
        columns.append(np.concatenate([change.real, change.imag]) / np.tile(1e-3 * FREQUENCIES, 2))
    expected = np.linalg.inv(np.array(columns) @ np.array(columns).T)
    np.testing.assert_allclose(three.bound(LOSSES), expected, rtol=1e-5, atol=1e-9)


def test_fits_scatter_as_the_bound_says():
    three = survey()
    measured = drawn(three.expected(LOSSES)[0], three.deviations, 24, seed=3)
    fits = np.array([three.identified(values, LOSSES) for values in measured])
    ratio, low, high = scatter_over_bound(fits, LOSSES, three.bound(LOSSES))
    assert low < ratio < high
    assert low < 1.0 < high
    # With thrice the errors it would show.
    assert scatter_over_bound(LOSSES + 3.0 * (fits - LOSSES), LOSSES, three.bound(LOSSES))[1] > 1.0


@pytest.mark.parametrize("motions", [(0, 1), (0, 2), (1, 2)])
def test_frequencies_of_two_motions_do_not_tell_three_losses(motions):
    two = survey(motions)
    assert two.condition(LOSSES) == np.inf
    with pytest.raises(ValueError, match="must tell 3 losses"):
        two.bound(LOSSES)
    with pytest.raises(ValueError, match="must tell 3 losses"):
        bound_together([two, two], LOSSES)
    with pytest.raises(ValueError, match="must tell 3 losses"):
        two.identified(two.expected(LOSSES)[0])
    # Along the mix that is not told nothing changes to first order.
    change = two.jacobian(LOSSES) @ two.untold(LOSSES)
    assert np.abs(change).max() < 1e-9 * np.abs(two.jacobian(LOSSES)).max()
    # With decay rates they do, badly.
    assert 20.0 < survey(motions, decays=1.0).condition(LOSSES) < 1e5


def test_two_speeds_tell_what_one_does_not():
    """The bound of all data together, from normal equations."""
    two = survey((0, 1))
    other = Survey(GEARBOX, float(rad_per_s(500.0)), NAMES, (0, 1), two.deviations)
    rows = np.concatenate([two.jacobian(LOSSES), other.jacobian(LOSSES)])
    np.testing.assert_allclose(bound_together([two, other], LOSSES), np.linalg.inv(rows.T @ rows), rtol=1e-8)
    assert np.sqrt(np.diag(bound_together([two, other], LOSSES))).max() < 0.02
    with pytest.raises(ValueError, match="same parameters"):
        bound_together([two, Survey(GEARBOX, SPEED, NAMES[:2], (0, 1), two.deviations)], LOSSES)


PLAY = Backlash(GEARBOX, torque=800.0, gap=1e-4)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"motions": (0, 3)}, ValueError, r"motions\[1\]"),
        ({"motions": (1, 1)}, ValueError, "must differ"),
        ({"motions": ()}, ValueError, "number of motions"),
        ({"motions": 0}, TypeError, "motions must be a list of numbers, got 0"),
        ({"parameters": "mesh_stiffness"}, TypeError, "parameters must be a list of names"),
        ({"deviations": "a"}, TypeError, "deviations must be real numbers"),
        ({"deviations": [[1.0, 1.0]]}, ValueError, "deviations must have shape"),
        ({"deviations": [[1.0, 0.0], [1.0, 1.0]]}, ValueError, "greater than 0"),
        ({"parameters": ("stiffness_of_input",)}, ValueError, "parameter must be one of"),
        ({"parameters": ()}, ValueError, "number of parameters"),
        ({"parameters": ("gear_teeth",)}, ValueError, "must be such that can lose a part, got 'gear_teeth'"),
        ({"parameters": (NAMES[0], f"gearbox.{NAMES[0]}")}, ValueError, "parameters must differ"),
        ({"model": PLAY}, TypeError, "what model.system.speed. returns must be a PeriodicSystem"),
        ({"speed": -1.0}, ValueError, "speed"),
        ({"model": 3}, TypeError, "model must have a method"),
    ],
)
def test_bad_input_names_the_parameter(change, error, message):
    valid = {
        "model": GEARBOX,
        "speed": SPEED,
        "parameters": NAMES,
        "motions": (0, 1),
        "deviations": np.ones((2, 2)),
    }
    with pytest.raises(error, match=message):
        Survey(**(valid | change))


def test_bad_losses_and_data():
    three = survey()
    with pytest.raises(ValueError, match="losses must be 3 numbers below 1"):
        three.expected([0.1, 0.2, 1.0])
    with pytest.raises(ValueError, match="measured must be 3 finite exponents"):
        three.identified([1j, 2j])
    with pytest.raises(TypeError, match="measured must be 3 finite exponents"):
        three.identified("abc")
    with pytest.raises(
        ValueError, match=r"start must lie between least=0 and most=0.5, got \[0.7, 0.0, 0.0\]"
    ):
        three.identified([1j, 2j, 3j], start=[0.7, 0.0, 0.0])
    with pytest.raises(ValueError, match="start must be 3 numbers below 1"):
        three.identified([1j, 2j, 3j], start=[0.1, 0.0])
    with pytest.raises(ValueError, match="most must be greater than least=0 and below 1, got 1"):
        three.identified([1j, 2j, 3j], most=1.0)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"deviations": [[1.0, 1.0]]}, ValueError, r"deviations must have shape \(3, 2\)"),
        ({"deviations": [[1.0, np.nan]] * 3}, ValueError, "deviations must be greater than 0"),
        ({"deviations": "a"}, TypeError, "deviations must be real numbers"),
        ({"exponents": 1j}, ValueError, "exponents must be finite exponents"),
        ({"exponents": [np.nan]}, ValueError, "exponents must be finite exponents"),
        ({"count": 0}, ValueError, "count must be at least 1"),
        ({"seed": -1}, ValueError, "seed must be at least 0, got -1"),
    ],
)
def test_what_cannot_be_drawn_is_refused(change, error, message):
    valid = {"exponents": [0j] * 3, "deviations": np.ones((3, 2)), "count": 2, "seed": 1}
    with pytest.raises(error, match=message):
        drawn(**(valid | change))


def test_scatter_of_nothing_is_refused():
    with pytest.raises(ValueError, match="losses must have shape"):
        scatter_over_bound(np.zeros((0, 2)), np.zeros(2), np.eye(2))
    with pytest.raises(ValueError, match=r"truth must have shape \(2,\)"):
        scatter_over_bound(np.zeros((4, 2)), 0.0, np.eye(2))
    with pytest.raises(ValueError, match="bound must be a positive definite matrix"):
        scatter_over_bound(np.zeros((4, 2)), np.zeros(2), -np.eye(2))
