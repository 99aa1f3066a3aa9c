"""Responses over speed against single ones and a closed form; what is refused."""

from dataclasses import dataclass

import joblib
import numpy as np
import pytest

from facegear.drives.studies.gearbox import gearbox_study
from facegear.floquet.loads import ContactLoad
from facegear.floquet.models import Coordinate, replace_parameter
from facegear.floquet.modified_models import Excited, WithoutRigidMotion
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.response import steady_response
from facegear.maps.response_map import frequency_response, response_map
from facegear.maps.stability_map import stability_map
from facegear.maps.tracing import tongues
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


ONE = PiecewiseChebyshev.constant([1.0])


@dataclass(frozen=True)
class Broken:
    """A method that has forgotten to return something."""

    part: float = 1.0
    coordinates = ()

    def system(self, speed):
        PeriodicSystem([[1.0]], [[0.1]], [[self.part]], (), speed)


@dataclass(frozen=True)
class Shifting:
    """Another load from the speed 1 on."""

    loads: int = 1
    coordinates = (Coordinate("mass", "m"),)

    def system(self, speed):
        loads = (ContactLoad(ONE, 0.1),) * (self.loads + (speed > 1.0))
        return PeriodicSystem([[1.0]], [[0.1]], [[1.0]], loads, 2.0 * np.pi / speed, force=WAVE)


@dataclass(frozen=True)
class Narrow:
    """A spring in a load and a damper so weak that a grid of speeds passes by its resonances, under a force."""

    damping: float = 1e-4
    stiffness: float = 1.0
    force: PiecewiseChebyshev = ONE
    coordinates = (Coordinate("mass", "m"),)

    def system(self, speed):
        load = ContactLoad(ONE, 1.0)
        stiffness = [[self.stiffness - 1.0]]
        return PeriodicSystem(
            [[1.0]], [[self.damping]], stiffness, (load,), 2.0 * np.pi / speed, force=self.force
        )


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
    np.testing.assert_allclose(found.force_highest[:, 0], highest, rtol=1e-5)
    assert found.peak_label.values.tolist() == ["1/2", "1/1"]
    np.testing.assert_allclose(found.peak_speed, [0.5, 1.0], atol=0.01)


def test_forces_of_loads_together_are_those_of_one_as_strong():
    """Springs of 0.3 and 0.1 side by side are one of 0.4; what is alone is as it was."""

    @dataclass(frozen=True)
    class Springs:
        parts: tuple[float, ...]
        coordinates = (Coordinate("mass", "m"),)

        def system(self, speed):
            loads = tuple(ContactLoad(ONE, part, 0.2 * part) for part in self.parts)
            return PeriodicSystem([[1.0]], [[0.05]], [[0.6]], loads, 2.0 * np.pi / speed, force=WAVE)

    one = frequency_response(Springs((0.4, 0.2)), SPEEDS, jobs=1)
    found = frequency_response(Springs((0.3, 0.2, 0.1)), SPEEDS, together=[(0, 2), (1,)], jobs=1)
    for name in ("force_mean", "force_rms", "force_lowest", "force_highest"):
        np.testing.assert_allclose(found[name], one[name], rtol=1e-9, atol=1e-12, err_msg=name)
    assert found.peak_label.values.tolist() == one.peak_label.values.tolist() == ["1/2"] * 2 + ["1/1"] * 2
    for load in (0, 1):
        peaks = (part.peak_force_highest[part.peak_load == load] for part in (found, one))
        np.testing.assert_allclose(*peaks, rtol=1e-9)
    assert "displacement_rms" in one
    assert "displacement_rms" not in found


def test_the_ends_of_the_force_at_a_peak_are_those_of_its_closed_form():
    found = frequency_response(Narrow(1e-2, 1.0, WAVE), np.linspace(0.35, 1.63, 9), jobs=1)
    for place, speed in enumerate(found.peak_speed.values.tolist()):
        w = speed * np.array([1.0, 2.0])
        amplitudes = np.array([1.0, 0.3]) / (1.0 - w**2 + 1e-2j * w)
        motion = (np.exp(2j * np.pi * np.outer(np.linspace(0.0, 1.0, 20_001), [1, 2])) @ amplitudes).real
        ends = (found.peak_force_lowest.values[place], found.peak_force_highest.values[place])
        np.testing.assert_allclose(ends, (motion.min(), motion.max()), rtol=1e-5)


@pytest.mark.parametrize("damping", [1e-1, 1e-3, 1e-5])
def test_peaks_between_the_speeds_are_found_to_a_millionth(damping):
    """Of two harmonics, height 1/(√2 c ω) each but for c²; the ends of the range are none."""
    found = frequency_response(Narrow(damping, 1.0, WAVE), np.linspace(0.35, 1.63, 9), jobs=1)
    assert found.peak_label.values.tolist() == ["1/2", "1/1"]
    amplitudes = []
    for speed in found.peak_speed.values:
        w = speed * np.array([1.0, 2.0])
        amplitudes.append(np.sqrt((np.abs([1.0, 0.3] / (1.0 - w**2 + 1j * w * damping)) ** 2).sum() / 2.0))
    np.testing.assert_allclose(found.peak_force_rms, amplitudes, rtol=1e-9)
    fine = found.peak_speed.values[:, None] * (1.0 + damping * np.linspace(-1.0, 1.0, 10_001))
    w = fine[..., None] * np.array([1.0, 2.0])
    exact = np.sqrt((np.abs([1.0, 0.3] / (1.0 - w**2 + 1j * w * damping)) ** 2).sum(axis=-1) / 2.0)
    np.testing.assert_allclose(found.peak_force_rms, exact.max(axis=1), rtol=1e-6)


def test_a_resonance_that_is_found_at_one_of_the_speeds_is_one_peak():
    """Coarsely looked for between 0.995 and 1.01, it is where one of them stands already."""
    speeds = np.sort(np.append(np.linspace(0.6, 1.4, 9)[[0, 1, 2, 6, 7, 8]], [0.995, 1.01]))
    found = frequency_response(Narrow(1e-3, 1.0, WAVE), speeds, resolution=1e-2, jobs=1)
    assert found.peak_label.values.tolist() == ["1/1"]
    assert abs(found.peak_speed.values[0] - 1.0) < 1e-2


def test_what_rises_up_to_a_border_of_instability_between_the_speeds_is_no_peak():
    """Where a multiplier is 1 no motion repeats itself: as near as one looks, so large it is."""
    model = Mathieu(depth=0.9, damping_ratio=0.1)
    wave = PiecewiseChebyshev.fit(lambda x, _: np.cos(2.0 * np.pi * x), [0.0])
    (tongue,) = tongues(model, (0.7, 1.3))
    speeds = np.array([0.75, 0.85, 1.05, 1.15, 1.25])
    assert 0.85 < tongue.lower < tongue.upper < 1.05
    found = frequency_response(Excited(model, transmission_error=wave), speeds, jobs=1)
    assert np.isfinite(found.force_rms).all()
    assert (found.sizes["peak"], found.attrs["at_borders"]) == (0, 1)
    near = [
        steady_response(Excited(model, transmission_error=wave).system(tongue.upper * (1.0 + away)))
        for away in (1e-4, 1e-6)
    ]
    rms = [np.sqrt(each.mean(lambda x, each=each: each.contact_forces(x) ** 2)) for each in near]
    assert rms[1] > 50.0 * rms[0] > 500.0 * float(found.force_rms.max())


def test_small_work_starts_no_processes(monkeypatch):
    def parallel(*_, **__):
        raise AssertionError("processes for a moment's work")

    monkeypatch.setattr(joblib, "Parallel", parallel)
    found = response_map(MODEL, SPEEDS[:9], "part", [0.3, 0.4, 0.5], jobs=2)
    assert np.isfinite(found.force_rms).all()


def test_rounding_makes_no_peaks():
    found = frequency_response(Narrow(0.1), np.linspace(0.3, 1.6, 200), jobs=1)
    assert 0.0 < found.force_rms.max() < 1e-10
    assert found.sizes["peak"] == 0


def test_nothing_known_at_any_speed_is_said_and_why():
    spring = ContactLoad(PiecewiseChebyshev.constant([1.0, -1.0]), 1.0, 0.1, transmission_error=WAVE)

    @dataclass(frozen=True)
    class Pair:
        part: float = 1.0
        coordinates = (Coordinate("one", "m"), Coordinate("other", "m"))

        def system(self, speed):
            return PeriodicSystem(
                np.eye(2), np.zeros((2, 2)), np.zeros((2, 2)), (spring,), 2.0 * np.pi / speed
            )

    with pytest.raises(ArithmeticError, match=r"WithoutRigidMotion\(model\) takes out"):
        frequency_response(Pair(), SPEEDS[:3], jobs=1)
    with pytest.raises(ArithmeticError, match=r"WithoutRigidMotion\(model\) takes out"):
        response_map(Pair(), SPEEDS[:3], "part", [1.0], jobs=1)
    assert np.isfinite(frequency_response(WithoutRigidMotion(Pair()), SPEEDS[:3], jobs=1).force_rms).all()
    with pytest.raises(ArithmeticError, match="too long for the fastest motion"):
        frequency_response(Narrow(0.1, 1e30), SPEEDS[:3], jobs=1)


@pytest.fixture(scope="module")
def gearbox():
    study = gearbox_study()
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
            r"must be one of model\.part \(the last part is enough\), got 'pard'; model\.part\?",
        ),
        (lambda: frequency_response(MODEL, SPEEDS, jobs=0), ValueError, "jobs"),
        (lambda: response_map(MODEL, SPEEDS, "part", [0.3, 0.3]), ValueError, "values must differ"),
        (lambda: frequency_response(MODEL, [0.0, 1.0]), ValueError, r"greater than 0 rad/s, got 0\.0$"),
        (
            lambda: frequency_response(MODEL, SPEEDS, cache_directory=3),
            TypeError,
            "cache_directory must be a path",
        ),
        (
            lambda: frequency_response(MODEL, SPEEDS, method="magnus"),
            TypeError,
            "method must be a Collocation",
        ),
        (
            lambda: stability_map(MODEL, SPEEDS, "part", [0.3], method="magnus"),
            TypeError,
            "method must be a Coll",
        ),
        (lambda: growth_rate(MODEL.system(1.0), "magnus"), TypeError, "method must be a Collocation"),
        (
            lambda: frequency_response(Broken(), SPEEDS),
            TypeError,
            "returns must be a PeriodicSystem, got a NoneType",
        ),
        (
            lambda: stability_map(Broken(), SPEEDS, "part", [1.0]),
            TypeError,
            "returns must be a PeriodicSystem",
        ),
        (
            lambda: tongues(Broken(), (0.1, 1.0)),
            TypeError,
            "returns must be a PeriodicSystem",
        ),
        (lambda: WithoutRigidMotion(Broken()).system(1.0), TypeError, "returns must be a PeriodicSystem"),
        (lambda: WithoutRigidMotion(3), TypeError, "model must have a method system"),
        (
            lambda: frequency_response(Shifting(), SPEEDS, jobs=1),
            ValueError,
            "as many loads at all speeds and values",
        ),
        (
            lambda: response_map(Shifting(), SPEEDS[:3], "loads", [1, 2], jobs=1),
            ValueError,
            "as many loads at all speeds and values, 1 as at the first; got 2",
        ),
        (
            lambda: frequency_response(MODEL, SPEEDS, together=[(0, 1)], jobs=1),
            ValueError,
            r"together must list numbers of loads, 0 to 0, in one group or more, got \[\(0, 1\)\]",
        ),
        (
            lambda: Excited(Mathieu(0.1), transmission_error=PiecewiseChebyshev.constant([0.0, 1.0])),
            ValueError,
            "transmission_error must have one component, got 2",
        ),
        (
            lambda: Excited(Shifting(loads=0), transmission_error=WAVE).system(0.5),
            ValueError,
            "transmission_error must be None for a model without loads",
        ),
        (lambda: Excited(3.0), TypeError, "model"),
        (lambda: Excited(Mathieu(0.1), force=1.0), TypeError, "force must be a PiecewiseChebyshev"),
    ],
)
def test_bad_input(call, error, message):
    with pytest.raises(error, match=message):
        call()
