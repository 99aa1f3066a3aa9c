"""Responses over speed against single ones and a closed form; what is refused."""

from dataclasses import dataclass

import numpy as np
import pytest

from facegear.drives import studies
from facegear.floquet.models import Coordinate, Excited, replace_parameter
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import ContactLoad, PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.response import steady_response
from facegear.maps.response_map import frequency_response, response_map
from facegear.mechanics.classical import Mathieu
from facegear.support.parameters import rad_per_s

WAVE = PiecewiseChebyshev.fit(lambda x, _: np.cos(2.0 * np.pi * x) + 0.3 * np.cos(4.0 * np.pi * x), [0.0])


@dataclass(frozen=True)
class Plain:
    """Q'' + 0.1 Q' + Q = 0, a part of the spring and half of the damper in a load."""

    part: float = 0.4

    @property
    def coordinates(self):
        return (Coordinate("mass", "m"),)

    def system(self, speed):
        load = ContactLoad(PiecewiseChebyshev.constant([1.0]), self.part, 0.05)
        return PeriodicSystem([[1.0]], [[0.05]], [[1.0 - self.part]], (load,), 2.0 * np.pi / speed)


MODEL = Excited(Plain(), transmission_error=WAVE)
SPEEDS = np.linspace(0.3, 1.6, 27)


def test_an_oscillator_over_speed_against_its_closed_form():
    """Driven at the speed and at twice the speed: peaks at 1 and at 1/2."""
    found = frequency_response(MODEL, SPEEDS, jobs=1)
    order = np.array([1.0, 2.0])
    w = order * SPEEDS[:, None]
    u = ((0.4 + 0.05j * w) / (1.0 - w**2 + 0.1j * w) - 1.0) * [1.0, 0.3]
    force = (0.4 + 0.05j * w) * u
    np.testing.assert_allclose(
        found.displacement_rms[:, 0], np.sqrt((np.abs(u) ** 2).sum(axis=1) / 2.0), rtol=1e-10
    )
    np.testing.assert_allclose(
        found.force_rms[:, 0], np.sqrt((np.abs(force) ** 2).sum(axis=1) / 2.0), rtol=1e-10
    )
    np.testing.assert_allclose(found.force_mean[:, 0], 0.0, atol=1e-12)
    turning = np.exp(2j * np.pi * np.outer(np.linspace(0.0, 1.0, 2001), order))
    highest = (turning @ force.T).real.max(axis=0)
    np.testing.assert_allclose(found.force_highest[:, 0], highest, rtol=1e-3)
    assert found.peak_label.values.tolist() == ["1/2", "1/1"]
    np.testing.assert_allclose(found.peak_speed, [0.5, 1.0], atol=0.01)


@pytest.fixture(scope="module")
def gearbox():
    study = studies.gearbox_study()
    model = study.model(study.settings({}))
    return Excited(model, force=PiecewiseChebyshev.constant([0.0, 0.0, -800.0]))


def test_a_gearbox_under_torque(gearbox):
    """The mean force of the mesh balances the output torque; where the drive is unstable there are no numbers."""
    speeds = rad_per_s(np.linspace(200.0, 1000.0, 33))
    found = frequency_response(gearbox, speeds, jobs=1)
    stable = np.array([growth_rate(gearbox.system(v)) < 0.0 for v in speeds.tolist()])
    assert 3 < stable.sum() < speeds.size
    assert (np.isfinite(found.force_rms.values).all(axis=1) == stable).all()
    assert (found.spectral_radius.values > 1.0).sum() == speeds.size - stable.sum()
    speed = float(speeds[stable][0])
    response = steady_response(gearbox.system(speed))
    arm = response.mean(
        lambda x: sum(
            load.shape(x)[:, 1] * response.contact_forces(x)[:, i]
            for i, load in enumerate(response.system.loads)
        )
    )
    assert abs(float(arm)) == pytest.approx(800.0, rel=1e-9)
    chosen = found.sel(speed=speed)
    forces = response.contact_forces(response.instants)
    np.testing.assert_allclose(chosen.force_highest, forces.max(axis=0), rtol=1e-3, atol=1e-9)
    # One of the two pairs is out of mesh for a part of the period, where its force is none.
    assert (found.peak_label.values != "").all()


def test_maps_are_made_of_responses(gearbox, tmp_path):
    speeds, values = rad_per_s(np.array([300.0, 500.0, 900.0])), [0.3, 0.5]
    options = {"jobs": 1, "cache_directory": tmp_path}
    chart = response_map(gearbox, speeds, "correction_factor", values, **options)
    assert chart.force_rms.dims == ("correction_factor", "speed", "load")
    for value in values:
        row = frequency_response(replace_parameter(gearbox, "correction_factor", value), speeds, jobs=1)
        np.testing.assert_allclose(chart.force_rms.sel(correction_factor=value), row.force_rms, rtol=1e-9)
    assert len(list(tmp_path.iterdir())) == 2
    again = response_map(gearbox, speeds, "correction_factor", values, **options)
    np.testing.assert_allclose(again.force_rms, chart.force_rms, rtol=1e-15)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: frequency_response(Mathieu(0.1), SPEEDS), ValueError, "force or a transmission error"),
        (lambda: frequency_response(3.0, SPEEDS), TypeError, "model"),
        (lambda: frequency_response(MODEL, [2.0, 1.0]), ValueError, "speeds must ascend"),
        (lambda: response_map(MODEL, SPEEDS, "part", []), ValueError, "values must list"),
        (
            lambda: response_map(MODEL, SPEEDS, "pard", [1.0]),
            ValueError,
            r"must be one of model\.part or others",
        ),
        (lambda: frequency_response(MODEL, SPEEDS, jobs=0), ValueError, "jobs"),
        (lambda: Excited(3.0), TypeError, "model"),
        (lambda: Excited(Mathieu(0.1), force=1.0), TypeError, "force must be a PiecewiseChebyshev"),
    ],
)
def test_bad_input(call, error, message):
    with pytest.raises(error, match=message):
        call()
