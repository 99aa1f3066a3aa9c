"""Periodic motions with clearances against closed forms, event-driven integration, and linear limits."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

from facegear.floquet.clearance import ClearanceSystem
from facegear.floquet.contact_patterns import Panels
from facegear.floquet.loads import ContactLoad, StateJump
from facegear.floquet.multipliers import multipliers
from facegear.floquet.orbits import periodic_orbit
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.floquet.response import steady_response
from facegear.floquet.transients import settled
from tests.independent.impacts import Drive, Touch

ONE = PiecewiseChebyshev.constant([1.0])


def wave(*amplitudes, components=1):
    """Real part of the sum of c_s e^{2πisx}, s = 0, 1, ..., in the first of some components."""
    series = PiecewiseChebyshev.fit(
        lambda x, _: sum((c * np.exp(2j * np.pi * s * x)).real for s, c in enumerate(amplitudes)), [0.0]
    )
    return series.embedded(components)


def gear_pair(frequency, mean=0.1, amplitude=0.05, ratio=0.03, contact_damping=0.0, gap=1.0):
    """X'' + 2ζ x' + f(x) = F_m + F_a cos Wt with f = x ∓ b beyond a gap of 2b, and a damper in contact."""
    loads = (ContactLoad(ONE, 1.0, contact_damping),) * 2
    force = wave(mean, amplitude)
    system = PeriodicSystem([[1.0]], [[2.0 * ratio]], [[0.0]], loads, 2.0 * np.pi / frequency, force)
    return ClearanceSystem(system, sides=(1, -1), clearances=(gap, gap))


class ClosedForm:
    """The same motion from one contact to the next in closed form."""

    def __init__(self, frequency, mean=0.1, amplitude=0.05, ratio=0.03, contact_damping=0.0):
        self.w, self.mean, self.amplitude = frequency, mean, amplitude
        self.loss = {0: 2.0 * ratio, 1: 2.0 * ratio + contact_damping, -1: 2.0 * ratio + contact_damping}

    def along(self, zone, start, x, v):
        """Displacement and velocity at times after `start`, as a function of the time."""
        loss, spring = self.loss[zone], abs(zone)
        answer = self.amplitude / (spring - self.w**2 + 1j * self.w * loss)

        def forced(t):
            turned = answer * np.exp(1j * self.w * t)
            steady = (self.mean / spring + zone) if spring else self.mean * (t - start) / loss
            speed = 0.0 if spring else self.mean / loss
            return turned.real + steady, (1j * self.w * turned).real + speed

        x0, v0 = (a - b for a, b in zip((x, v), forced(start), strict=True))

        def motion(t):
            s, (xf, vf) = t - start, forced(t)
            if spring:
                w = np.sqrt(1.0 - loss**2 / 4.0)
                fading, second = np.exp(-loss * s / 2.0), (v0 + loss * x0 / 2.0) / w
                xh = fading * (x0 * np.cos(w * s) + second * np.sin(w * s))
                vh = fading * (v0 * np.cos(w * s) - (x0 + loss * second / (2.0 * w)) * w * np.sin(w * s))
                vh = -loss / 2.0 * xh + fading * w * (second * np.cos(w * s) - x0 * np.sin(w * s))
                return np.array([xf + xh, vf + vh])
            fading = np.exp(-loss * s)
            return np.array([xf + x0 + v0 * (1.0 - fading) / loss, vf + v0 * fading])

        return motion

    def after(self, x, v, duration):
        """State after a time, and how many contacts were made or lost."""
        time, zone, count = 0.0, int(np.sign(x)) * (abs(x) > 1.0), 0
        while True:
            motion = self.along(zone, time, x, v)
            grid = np.linspace(time, duration, 4000)[1:]
            places = motion(grid)[0]
            left = (places * zone < 1.0) if zone else (np.abs(places) > 1.0)
            if not left.any():
                return motion(duration), count
            first = int(left.argmax())
            edge = float(zone or np.sign(places[first]))
            before = grid[first - 1] if first else time + 1e-9
            time = brentq(lambda t, m=motion, e=edge: m(t)[0] - e, before, grid[first], xtol=1e-15)
            x, v = motion(time)
            zone, count = (0 if zone else int(edge)), count + 1


@pytest.mark.parametrize("contact_damping", [0.0, 0.2])
@pytest.mark.parametrize(("frequency", "crossings"), [(0.8, 2), (0.44, 4)])
def test_gear_pair_in_closed_form(frequency, crossings, contact_damping):
    amplitude = 0.05 if crossings == 2 else 0.25
    exact = ClosedForm(frequency, amplitude=amplitude, contact_damping=contact_damping)
    system = gear_pair(frequency, amplitude=amplitude, contact_damping=contact_damping)
    end = settled(system, [[1.2, 0.0]], 60)[0, 0]
    orbit = periodic_orbit(system, guess=end)
    assert len(orbit.pattern.crossings) == crossings
    # Newton's method for the closed form begins a little beside.
    start = fsolve(lambda y: exact.after(*y, system.period)[0] - y, orbit.start * 1.001, xtol=1e-12)
    assert exact.after(*start, system.period)[1] == crossings
    np.testing.assert_allclose(orbit.start, start, atol=1e-10)
    for x in (0.2, 0.55, 0.9):
        np.testing.assert_allclose(orbit.state(x), exact.after(*start, x * system.period)[0], atol=1e-10)
    # The derivative of the closed form, central differences.
    step = 1e-5
    columns = [
        (exact.after(*(start + d), system.period)[0] - exact.after(*(start - d), system.period)[0])
        / (2.0 * step)
        for d in step * np.eye(2)
    ]
    np.testing.assert_allclose(orbit.transition, np.array(columns).T, atol=2e-8)


def coming(x):
    """Return a shape that is there for a part of the period, and its derivative."""
    return np.array([1.0 + 0.3 * x, -0.8 + 0.2 * np.cos(2.0 * x)]), np.array(
        [0.3 + 0.0 * x, -0.4 * np.sin(2.0 * x)]
    )


def staying(x):
    """Return a shape that jumps back once a period, and its derivative."""
    x = x % 1.0
    return np.array([1.0 + 0.0 * x, -1.0 + 0.1 * x**2]), np.array([0.0 * x, 0.2 * x])


def meshing(rate="total", factor=1.0, gap=0.02, damping=0.05):
    """Two coordinates, loads on either side that come and go, a transmission error, a weight."""
    first = PiecewiseChebyshev.fit(lambda x, piece: coming(x)[0].T * (piece == 0), [0.0, 0.35])
    second = PiecewiseChebyshev.fit(lambda x, _: staying(x)[0].T, [0.0])
    error = wave(0.0, 0.01 * factor, 0.004j * factor)
    loads = (
        ContactLoad(first, 6.0, damping, rate=rate),
        ContactLoad(second, 9.0, damping, rate=rate, transmission_error=error, weight=wave(1.0, 0.2)),
        ContactLoad(second.shift(0.4), 8.0, damping, rate=rate),
    )
    force = wave(0.4 * factor, 0.3 * factor, components=2)
    mass, losses = np.diag([1.0, 1.5]), np.array([[0.2, -0.05], [-0.05, 0.25]])
    springs = np.array([[0.1, 0.0], [0.0, 1.0]])
    system = PeriodicSystem(mass, losses, springs, loads, 4.0, force)
    return ClearanceSystem(system, (1, 1, -1), (gap * factor,) * 3)


def as_drive(system):
    """Return the same for event-driven integration."""
    inner, period, turn = system.system, system.period, 2.0 * np.pi

    def plain(shape, ahead):
        def at(t):
            phi, slope = shape(t / period + ahead)
            return phi, slope / period, 0.0, 0.0

        return at

    def erring(t):
        phi, slope = staying(t / period)
        angle = turn * t / period
        e = 0.01 * np.cos(angle) - 0.004 * np.sin(2.0 * angle)
        rate = -0.01 * np.sin(angle) - 0.008 * np.cos(2.0 * angle)
        return phi, slope / period, e, rate * turn / period

    total = inner.loads[0].rate == "total"
    gap, damping = system.clearances[0], inner.loads[0].damping
    touches = [
        Touch(
            plain(lambda x: coming(x % 1.0), 0.0),
            1,
            gap,
            6.0,
            damping,
            lambda t: t / period % 1.0 < 0.35,
            total,
        ),
        Touch(
            erring,
            1,
            gap,
            9.0,
            damping,
            total=total,
            strength=lambda t: 1.0 + 0.2 * np.cos(turn * t / period),
        ),
        Touch(plain(staying, 0.4), -1, gap, 8.0, damping, total=total),
    ]
    force = lambda t: np.array([0.4 + 0.3 * np.cos(turn * t / period), 0.0])  # noqa: E731
    breaks = (0.35 * period, 0.6 * period)
    return Drive(inner.mass, inner.damping, inner.stiffness, force, touches, period, breaks)


@pytest.mark.parametrize("rate", ["total", "frozen"])
def test_event_driven_shooting_and_its_derivative(rate):
    system = meshing(rate, damping=0.2)
    orbit = periodic_orbit(system, guess=settled(system, np.zeros((1, 4)), 60)[0, 0])
    assert len(orbit.pattern.crossings) >= 4
    assert orbit.pattern.pressed.any(axis=0).all()
    drive = as_drive(system)
    # One step of Newton's method for shooting, from the orbit's start: where it leads is as far as both agree.
    left = drive.flown(orbit.start)[0] - orbit.start
    away = np.linalg.solve(orbit.transition - np.eye(4), left)
    assert np.abs(away).max() < 1e-8 * np.abs(orbit.start).max()
    for change in 5e-8 * np.random.default_rng(1).standard_normal((2, 4)):
        ahead, behind = (drive.flown(orbit.start + sign * change)[0] for sign in (1.0, -1.0))
        np.testing.assert_allclose(orbit.transition @ change, (ahead - behind) / 2.0, atol=1e-6 * 5e-8)
    # Without saltation the same entries are wrong by more than a hundred times that.
    plain = replace(orbit.linear, jumps=())
    assert np.abs(np.sort(np.abs(multipliers(plain))) - np.sort(np.abs(orbit.multipliers))).max() > 3e-4


def test_multipliers_are_those_of_the_linear_system_with_saltation():
    system = meshing()
    orbit = periodic_orbit(system, guess=settled(system, np.zeros((1, 4)), 60)[0, 0])
    found = np.sort_complex(multipliers(orbit.linear))
    np.testing.assert_allclose(found, np.sort_complex(orbit.multipliers), atol=1e-9)
    # Forces and motion are those of a response of the loads in contact.
    response = steady_response(orbit.response.system, allow_unstable=True)
    x = np.linspace(0.0, 1.0, 50)
    np.testing.assert_allclose(orbit.response.contact_forces(x), response.contact_forces(x), atol=1e-9)
    np.testing.assert_allclose(orbit.state(x), response.state(x), atol=1e-10)


def test_homogeneous_of_degree_one():
    start = settled(meshing(), np.zeros((1, 4)), 60)[0, 0]
    orbit = periodic_orbit(meshing(), guess=start)
    times = periodic_orbit(meshing(factor=37.0), guess=37.0 * start)
    x = np.linspace(0.0, 1.0, 50)
    size = np.abs(orbit.state(x)).max()
    assert np.abs(times.state(x) / 37.0 - orbit.state(x)).max() < 1e-10 * size
    np.testing.assert_allclose(times.pattern.instants, orbit.pattern.instants, atol=1e-10)


def test_under_a_large_force_it_is_the_linear_response():
    """Pressed for good, one load moves by its clearance: the response with that transmission error."""
    system = gear_pair(0.6, mean=3.0)
    load = system.system.loads[0]
    error = PiecewiseChebyshev.constant([1.0])
    linear = replace(system.system, loads=(replace(load, transmission_error=error),))
    orbit, response = periodic_orbit(system), steady_response(linear)
    x = np.linspace(0.0, 1.0, 30)
    np.testing.assert_allclose(orbit.state(x), response.state(x), atol=1e-11)
    np.testing.assert_allclose(orbit.in_contact, [1.0, 0.0], atol=0.0)


def test_without_a_gap_it_is_the_linear_system():
    """Two sides of one shape without a gap, and a load that acts always, are the linear load."""
    system = gear_pair(0.6, mean=0.02, amplitude=0.3, contact_damping=0.1, gap=0.0)
    linear = replace(system.system, loads=system.system.loads[:1])
    response = steady_response(linear)
    x = np.linspace(0.0, 1.0, 30)
    assert response.displacements(x).min() < -0.1
    always = ClearanceSystem(linear, (0,), (0.0,))
    for orbit in (periodic_orbit(system), periodic_orbit(always)):
        np.testing.assert_allclose(orbit.state(x), response.state(x), atol=1e-11)
        found, expected = np.sort_complex(orbit.multipliers), np.sort_complex(multipliers(linear))
        np.testing.assert_allclose(found, expected, atol=1e-11)
        assert orbit.is_stable


def test_error_falls_exponentially_with_the_nodes():
    system = gear_pair(0.44, amplitude=0.25, contact_damping=0.2)
    guess = settled(system, [[1.2, 0.0]], 60)[0, 0]
    truth = periodic_orbit(system, guess=guess, panels=Panels(24, 1.2)).start
    nodes = np.array([4, 5, 6, 7])
    orbits = [periodic_orbit(system, guess=guess, panels=Panels(int(n), 1.2)) for n in nodes]
    errors = np.array([np.abs(orbit.start - truth).max() for orbit in orbits])
    # Gauss nodes: the end of a panel is known with twice the order, a thousand times better with each node.
    assert np.polyfit(nodes[:3], np.log10(errors[:3]), 1)[0] < -2.5
    assert errors[-1] < 1e-13
    tails = np.array([orbit.unresolved for orbit in orbits])
    assert np.polyfit(nodes, np.log10(tails), 1)[0] < -0.6


def test_several_periods():
    system = meshing()
    guess = settled(system, np.zeros((1, 4)), 60)[0, 0]
    once, thrice = (periodic_orbit(system, periods, guess) for periods in (1, 3))
    np.testing.assert_allclose(thrice.start, once.start, atol=1e-10)
    np.testing.assert_allclose(thrice.transition, np.linalg.matrix_power(once.transition, 3), atol=1e-10)
    again = periodic_orbit(system, 3, thrice)
    np.testing.assert_allclose(again.start, once.start, atol=1e-10)


@pytest.fixture(params=["compiled", "NumPy"])
def route(request, monkeypatch):
    if request.param == "compiled":
        pytest.importorskip("facegear.floquet.lockstep_transients", exc_type=ImportError)
    else:
        monkeypatch.setattr("facegear.floquet.transients._compiled", lambda: None)


def test_transients_settle_on_the_stable_orbit(route):
    system = gear_pair(0.6)
    orbit = periodic_orbit(system, guess=settled(system, [[1.2, 0.0]], 80)[0, 0])
    assert orbit.is_stable
    rng = np.random.default_rng(0)
    states = orbit.start + 0.05 * rng.standard_normal((20, 2))
    ends = settled(system, states, 120, kept=2)
    assert ends.shape == (2, 20, 2)
    # Runge-Kutta steps that meet contacts anywhere: a ten thousandth.
    assert np.abs(ends - orbit.start).max() < 1e-4


@pytest.mark.parametrize(
    "system", [gear_pair(0.6, contact_damping=0.02), meshing()], ids=["gear pair", "meshing"]
)
def test_compiled_steps_are_those_of_numpy(system, monkeypatch):
    """Through contacts on both sides; differences of rounding grow with motions from period to period."""
    pytest.importorskip("facegear.floquet.lockstep_transients", exc_type=ImportError)
    states = 2.0 * np.random.default_rng(3).uniform(-1.0, 1.0, (5, 2 * system.size))
    compiled = settled(system, np.asfortranarray(states), 6, kept=3)
    monkeypatch.setattr("facegear.floquet.transients._compiled", lambda: None)
    expected = settled(system, states, 6, kept=3)
    assert compiled.shape == expected.shape == (3, 5, 2 * system.size)
    np.testing.assert_allclose(compiled, expected, rtol=0.0, atol=1e-10)
    assert np.abs(expected - states).max() > 0.1


LINEAR = meshing().system


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: ClearanceSystem(LINEAR, (1, 1), (0.0, 0.0, 0.0)), ValueError, "sides must have 3 entries"),
        (
            lambda: ClearanceSystem(LINEAR, (1, 1, 2), (0.0,) * 3),
            ValueError,
            "sides must be an integer from -1",
        ),
        (
            lambda: ClearanceSystem(LINEAR, (1, 1, -1), (0.1, 0.1, -0.1)),
            ValueError,
            "clearances must be 0 or",
        ),
        (
            lambda: ClearanceSystem(LINEAR, (1, 1, 0), (0.1,) * 3),
            ValueError,
            "must be 0 for a load that acts always",
        ),
        (lambda: ClearanceSystem(LINEAR, 1, (0.1,) * 3), TypeError, "sides must be a sequence"),
        (lambda: ClearanceSystem(meshing(), (1,), (0.1,)), TypeError, "system must be a PeriodicSystem"),
        (
            lambda: ClearanceSystem(gear_pair(1.0).system.replace_loads(mass=0.1), (1, -1), (0.1,) * 2),
            ValueError,
            "loads without mass",
        ),
        (
            lambda: ClearanceSystem(
                replace(LINEAR, jumps=(StateJump(0.5, np.eye(4)),)), (1, 1, -1), (0.1,) * 3
            ),
            ValueError,
            "no jumps of the state",
        ),
        (lambda: periodic_orbit(LINEAR), TypeError, "system must be a ClearanceSystem"),
        (lambda: periodic_orbit(meshing(), 0), ValueError, "periods must be at least 1"),
        (
            lambda: periodic_orbit(meshing(), guess=[1.0]),
            ValueError,
            r"guess must be a state of shape \(4,\)",
        ),
        (lambda: periodic_orbit(meshing(), panels=12), TypeError, "panels must be a Panels"),
        (lambda: Panels(nodes=3), ValueError, "nodes must be"),
        (lambda: Panels(angle=0.0), ValueError, "angle must lie in"),
        (lambda: settled(meshing(), np.zeros(4), 3), ValueError, r"states must have shape \(m, 4\)"),
        (
            lambda: settled(meshing(), np.zeros((1, 4)), 3, 0),
            ValueError,
            "kept must be an integer from 1 to 3, got 0",
        ),
        (
            lambda: settled(meshing(), np.zeros((1, 4)), 3, 9),
            ValueError,
            "kept must be an integer from 1 to 3",
        ),
        (
            lambda: periodic_orbit(meshing(), guess=periodic_orbit(gear_pair(1.5))),
            ValueError,
            "guess must be an orbit of a system with 2 coordinates and 3 loads, got one of 1 and 2",
        ),
        (
            lambda: ClearanceSystem(replace(gear_pair(1.0).system, loads=()), (), ()),
            ValueError,
            "system must have at least one load",
        ),
    ],
)
def test_bad_input_names_the_parameter(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_nothing_closes_the_gap():
    """A mass that hangs on its contacts only, and no force: any place in the gap is one."""
    free = gear_pair(0.6, mean=0.0, amplitude=0.0, ratio=0.0)
    with pytest.raises(ArithmeticError, match="too small to close the gap"):
        periodic_orbit(free, guess=[0.2, 0.0])


def test_contacts_too_stiff_to_resolve_are_told_at_once():
    stiff = gear_pair(1.0).system.replace_loads(stiffness=1e8)
    with pytest.raises(ArithmeticError, match="more than 5000: contacts are too stiff to resolve"):
        periodic_orbit(ClearanceSystem(stiff, (1, -1), (1.0, 1.0)))


def test_a_motion_without_contact_on_the_way_is_no_rigid_body():
    """Stiff stops under a large force: the steps come to a flight between them, which nothing brings back."""
    hard = gear_pair(1.0, amplitude=0.5).system.replace_loads(stiffness=1e4, damping=1.0)
    with pytest.raises(ArithmeticError, match=r"came to contacts that hold nothing, .* after \d+ steps"):
        periodic_orbit(ClearanceSystem(hard, (1, -1), (1.0, 1.0)))
