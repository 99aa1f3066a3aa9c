"""Losses from exponents: exact data, bounds from difference quotients, scatter of fits, what is not told."""

import numpy as np
import pytest

from facegear.design.identification import Survey, bound_together, drawn, scatter_over_bound
from facegear.floquet.hill import exponents
from facegear.floquet.models import replace_parameter, value_of
from facegear.mechanics.gearboxes import FIGURES
from facegear.mechanics.torsional import Torsional
from facegear.support.parameters import rad_per_s

GEARBOX = Torsional(FIGURES["7.12b"].gearbox.in_si)
SPEED = float(rad_per_s(700.0))
NAMES = ("input_stiffness", "output_stiffness", "mesh_stiffness")
FREQUENCIES = GEARBOX.natural_frequencies()
LOSSES = np.array([0.05, 0.1, 0.2])


def survey(motions=(0, 1, 2), decays=np.inf, error=1e-3):
    sizes = error * FREQUENCIES[list(motions)]
    return Survey(GEARBOX, SPEED, NAMES, motions, np.stack([decays * sizes, sizes], axis=1))


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
    for losses in (LOSSES, np.array([0.0, 0.0, 0.3]), np.array([0.3, 0.02, -0.05])):
        truth = nearest(moved(losses), three.expected(losses)[0])
        np.testing.assert_allclose(three.identified(truth), losses, atol=1e-6)


def test_images_of_exponents_are_as_good():
    three = survey()
    turns = 2j * np.pi / three.intact.period * np.array([1, -2, 5])
    measured = three.expected(LOSSES)[0] + turns
    np.testing.assert_allclose(three.identified(measured), LOSSES, atol=1e-8)


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
    measured = drawn(three.expected(LOSSES)[0], three.deviations, 40, seed=3)
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


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"motions": (0, 3)}, ValueError, r"motions\[1\]"),
        ({"motions": (1, 1)}, ValueError, "must differ"),
        ({"motions": ()}, ValueError, "number of motions"),
        ({"deviations": [[1.0, 1.0]]}, ValueError, "deviations must have shape"),
        ({"deviations": [[1.0, 0.0], [1.0, 1.0]]}, ValueError, "greater than 0"),
        ({"parameters": ("stiffness_of_input",)}, ValueError, "parameter must be one of"),
        ({"parameters": ()}, ValueError, "number of parameters"),
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
