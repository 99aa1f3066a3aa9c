from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh_tridiagonal
from scipy.optimize import brentq

from facegear.floquet import multiplier_curves
from facegear.floquet.hsu import resonance_bands
from facegear.floquet.loads import ContactLoad
from facegear.floquet.multiplier_curves import MultiplierCurve
from facegear.floquet.multipliers import growth_rate
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.maps import parallel, scanning, tracing
from facegear.maps.scanning import scan_of
from facegear.maps.scans import Scan
from facegear.maps.tracing import borders, search_seconds, tongues
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.sharing import shared_load
from facegear.mechanics.torsional import Gearbox, Torsional
from facegear.mechanics.transverse import Transverse
from facegear.support.parameters import rad_per_s, rpm
from tests.comparing import agree

TURN = 2.0 * np.pi
COSINE = PiecewiseChebyshev.fit(lambda x, piece: np.cos(TURN * x), [0.0])
SQUARE = PiecewiseChebyshev(np.array([0.0, 0.5]), np.array([[[1.0]], [[-1.0]]]))
BORDER_RPM = 0.01


@dataclass(frozen=True)
class Modulated:
    """Modes with a load of a cosine or square wave, stiffness or damping; the speed is the frequency of the wave."""

    frequencies: tuple[float, ...] = (50.0,)
    shape: tuple[float, ...] = (1.0,)
    damping: float = 0.0
    stiffness_wave: float = 0.0
    damping_wave: float = 0.0
    wave: PiecewiseChebyshev = field(default=COSINE, repr=False)

    def system(self, speed: float) -> PeriodicSystem:
        load = ContactLoad(
            PiecewiseChebyshev.constant(self.shape),
            stiffness=self.stiffness_wave,
            damping=self.damping_wave,
            weight=self.wave,
        )
        n = len(self.frequencies)
        squares = np.diag(np.square(self.frequencies))
        return PeriodicSystem(np.eye(n), self.damping * np.eye(n), squares, [load], TURN / speed)


def mathieu(modulation, damping=0.0, frequency=50.0):
    return Modulated((frequency,), (1.0,), damping, modulation * frequency**2)


def characteristic_value(order, q, kind):
    """Characteristic value a_order or b_order of Mathieu's equation from its symmetric tridiagonal matrix."""
    size = 40
    if order % 2:
        diagonal = (2.0 * np.arange(size) + 1.0) ** 2
        diagonal[0] += q if kind == "a" else -q
        return eigh_tridiagonal(diagonal, np.full(size - 1, q))[0][(order - 1) // 2]
    if kind == "b":
        return eigh_tridiagonal((2.0 * np.arange(1, size + 1)) ** 2, np.full(size - 1, q))[0][order // 2 - 1]
    off = np.full(size - 1, q)
    off[0] *= np.sqrt(2.0)
    return eigh_tridiagonal((2.0 * np.arange(size)) ** 2, off)[0][order // 2]


def mathieu_borders(order, modulation, frequency):
    """Speeds θ where 4ω²/θ² is a characteristic value at q = 2εω²/θ² ."""

    def speed(kind):
        def residual(theta):
            ratio = (frequency / theta) ** 2
            return 4.0 * ratio - characteristic_value(order, 2.0 * modulation * ratio, kind)

        centre = 2.0 * frequency / order
        return brentq(residual, 0.8 * centre, 1.2 * centre, xtol=1e-12)

    return sorted((speed("a"), speed("b")))


@pytest.mark.parametrize("modulation", [1e-5, 1e-4, 1e-3, 2e-2, 0.2])
def test_mathieu_tongues_have_the_borders_of_the_characteristic_values(modulation):
    found = {tongue.label: tongue for tongue in tongues(mathieu(modulation), (40.0, 120.0))}
    orders = {1e-5: 1, 1e-4: 1, 1e-3: 2, 2e-2: 2, 0.2: 2}[modulation]
    assert len(found) == orders
    for order in range(1, orders + 1):
        tongue = found[f"(1+1)/{order}"]
        lower, upper = mathieu_borders(order, modulation, 50.0)
        # The threshold of growth moves a border by what it takes to grow by it; second order in it.
        assert rpm(abs(tongue.lower - lower)) < BORDER_RPM / 10
        assert rpm(abs(tongue.upper - upper)) < BORDER_RPM / 10
        assert tongue.width == pytest.approx(upper - lower, rel=2e-2)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    st.floats(-5.0, -2.0),
    st.floats(0.0, 0.995),
    st.floats(30.0, 90.0),
    st.floats(0.0, 1.0),
)
def test_damped_mathieu_tongues_of_any_width_are_found(exponent, closing, frequency, offset):
    modulation = 10.0**exponent
    # Closed form to first order: the growth rate is εω/4 − c/2 at the centre, the width √((εω)² − (2c)²).
    damping = closing * modulation * frequency / 2.0
    # The threshold of growth in a period, 1e-8, acts as that much more damping.
    least = 2.0 * 1e-8 * frequency / np.pi
    width = np.sqrt((modulation * frequency) ** 2 - (2.0 * (damping + least)) ** 2)
    # Only the principal tongue is within the range, wherever in it.
    lowest = 2.0 * frequency * (0.55 + 0.4 * offset)
    (tongue,) = tongues(mathieu(modulation, damping, frequency), (lowest, 2.2 * lowest))
    assert tongue.label == "(1+1)/1"
    assert tongue.width == pytest.approx(width, rel=modulation + 0.02)
    assert tongue.peak == pytest.approx(2.0 * frequency, rel=modulation)
    assert tongue.growth_rate == pytest.approx(
        modulation * frequency / 4.0 - damping / 2.0, rel=0.02 + 20 * modulation, abs=1e-7
    )


def test_closed_tongues_are_not_reported():
    assert tongues(mathieu(1e-3, damping=0.0251), (90.0, 110.0)) == ()
    assert len(tongues(mathieu(1e-3, damping=0.0249), (90.0, 110.0))) == 1


PAIR = {"frequencies": (30.0, 71.0), "shape": (0.8, 0.6)}


@pytest.mark.parametrize("strength", [0.005, 0.05, 0.5])
def test_sum_and_difference_resonances_of_two_modes_are_both_found(strength):
    # Damping that alternates drives sums and differences alike; f⁰ is just short of closing the combination.
    coupling = strength * 0.8 * 0.6
    damping = 0.49 * coupling
    model = Modulated(**PAIR, damping=damping, damping_wave=strength)
    found = {tongue.label: tongue for tongue in tongues(model, (25.0, 160.0))}
    # f_11 = 0.64/0.48 f_12 opens the tongue of the first mode as well, f_22 = 0.36/0.48 f_12 does not.
    assert set(found) == {"(1+1)/1", "(1+2)/1", "(2-1)/1"}
    width = np.sqrt(coupling**2 - 4.0 * damping**2)
    for label, centre in (("(1+2)/1", 101.0), ("(2-1)/1", 41.0)):
        tongue = found[label]
        assert tongue.peak == pytest.approx(centre, abs=strength**2)
        assert tongue.width == pytest.approx(width, rel=0.01 + strength / 5)
        assert tongue.growth_rate == pytest.approx((coupling - 2.0 * damping) / 4.0, rel=0.01 + strength / 5)


def test_tongues_are_those_of_averaging_with_the_same_labels():
    model = Modulated(**PAIR, damping=0.01, stiffness_wave=40.0)
    found = tongues(model, (50.0, 160.0))
    bands = resonance_bands(model.system(100.0), order=1)
    assert (
        [tongue.label for tongue in found]
        == [band.label for band in bands]
        == ["(1+1)/1", "(1+2)/1", "(2+2)/1"]
    )
    for tongue, band in zip(found, bands, strict=True):
        assert rpm(abs(tongue.lower - band.lower)) < 0.05
        assert rpm(abs(tongue.upper - band.upper)) < 0.05


def square_wave_radii(model, speeds):
    """max|λ| of a square-wave system, from two constant state matrices in closed form."""
    n = len(model.frequencies)
    product = np.eye(2 * n)
    for sign in (1.0, -1.0):
        outer = np.outer(model.shape, model.shape)
        state = np.zeros((2 * n, 2 * n))
        state[:n, n:] = np.eye(n)
        state[n:, :n] = -np.diag(np.square(model.frequencies)) - sign * model.stiffness_wave * outer
        state[n:, n:] = -model.damping * np.eye(n)
        values, vectors = np.linalg.eig(state)
        factors = np.exp(values * (np.pi / speeds)[:, None])
        product = (vectors * factors[:, None, :]) @ np.linalg.inv(vectors) @ product
    return np.abs(np.linalg.eigvals(product)).max(axis=-1)


@pytest.mark.parametrize("seed", range(8))
def test_no_unstable_speed_of_a_fine_scan_is_missed(seed):
    random = np.random.default_rng(seed)
    modes = 2 + seed % 3
    model = Modulated(
        tuple(sorted(random.uniform(20.0, 120.0, modes))),
        tuple(random.uniform(0.2, 1.0, modes)),
        random.uniform(0.05, 1.0),
        random.uniform(100.0, 700.0),
        wave=SQUARE,
    )
    found = tongues(model, (15.0, 150.0))
    speeds = np.linspace(15.0, 150.0, 15_000)[1:-1]
    margin = 1e-6
    inside = np.zeros(speeds.size, dtype=bool)
    near = np.zeros(speeds.size, dtype=bool)
    for tongue in found:
        inside |= (speeds > tongue.lower) & (speeds < tongue.upper)
        near |= (np.abs(speeds - tongue.lower) < margin) | (np.abs(speeds - tongue.upper) < margin)
    unstable = np.concatenate(
        [square_wave_radii(model, part) > 1.0 + 1e-8 for part in np.array_split(speeds, 10)]
    )
    assert inside[~near].tolist() == unstable[~near].tolist()
    for tongue in found:
        assert tongue.lower <= tongue.peak <= tongue.upper
        assert np.log(
            square_wave_radii(model, np.array([tongue.peak]))[0]
        ) * tongue.peak / TURN == pytest.approx(tongue.growth_rate, rel=1e-6, abs=1e-9)


def test_tongues_narrower_than_any_sample_lie_within_the_scan_of_a_square_wave():
    # Damping leaves the seventh-order tongue of the square wave a width of some 1e-4 rad/s.
    model = Modulated((50.0,), (1.0,), 0.30, 500.0, wave=SQUARE)
    thinnest = min(tongues(model, (8.0, 120.0)), key=lambda tongue: tongue.width)
    across = np.linspace(thinnest.lower - thinnest.width, thinnest.upper + thinnest.width, 301)
    unstable = square_wave_radii(model, across) > 1.0 + 1e-8
    assert unstable[101:200].all()
    assert not unstable[:99].any()
    assert not unstable[202:].any()


def transverse(stiffness):
    return Transverse(Body(Drive(26, 130, 3.175e-3), thickness_ratio=0.03), MeshLoad(stiffness, 3e-6, 1.0))


@pytest.mark.parametrize(
    ("stiffness", "low", "high", "step", "count"),
    [(1.0, 284.0, 292.0, 0.1, 1), (1.0, 229.0, 231.0, 0.02, 1), (0.3, 25.9, 26.4, 0.005, 1)],
)
def test_tongues_of_case_one_are_those_of_a_fine_scan(stiffness, low, high, step, count):
    model = transverse(stiffness)
    found = tongues(model, (rad_per_s(low), rad_per_s(high)))
    assert len(found) == count
    speeds = rad_per_s(np.arange(low + step / 2, high, step))
    unstable = np.array([growth_rate(model.system(speed)) > 0.0 for speed in speeds])
    inside = np.any([(speeds > t.lower) & (speeds < t.upper) for t in found], axis=0)
    assert 3 < inside.sum() < inside.size - 3
    assert inside.tolist() == unstable.tolist()


def test_borders_of_case_one_are_known_to_a_hundredth_of_a_revolution_per_minute():
    model = transverse(0.3)
    found = tongues(model, (rad_per_s(100.0), rad_per_s(160.0)))
    assert [tongue.label for tongue in found] == ["(1+1)/1", "(1+4)/1", "(1+5)/1"]
    half = rad_per_s(BORDER_RPM / 2)
    for tongue in found:
        for inner, outer in (
            (tongue.lower + half, tongue.lower - half),
            (tongue.upper - half, tongue.upper + half),
        ):
            assert growth_rate(model.system(inner)) > 0.0 > growth_rate(model.system(outer))
        # A multiplier rounded in its last places, over a period of some hundredths of a second.
        assert growth_rate(model.system(tongue.peak)) == pytest.approx(tongue.growth_rate, abs=1e-10)
        assert growth_rate(model.system(tongue.peak + 0.02 * tongue.width)) <= tongue.growth_rate
        assert growth_rate(model.system(tongue.peak - 0.02 * tongue.width)) <= tongue.growth_rate


def test_a_range_that_begins_or_ends_inside_a_tongue_cuts_it():
    lower, upper = mathieu_borders(1, 0.1, 50.0)
    (cut,) = tongues(mathieu(0.1), (100.0, 110.0))
    assert cut.lower == 100.0
    assert cut.upper == pytest.approx(upper, rel=1e-6)
    (cut,) = tongues(mathieu(0.1), (90.0, 100.0))
    assert cut.upper == 100.0
    assert cut.lower == pytest.approx(lower, rel=1e-6)
    (whole,) = tongues(mathieu(0.1), (99.5, 100.5))
    assert (whole.lower, whole.upper) == (99.5, 100.5)


def test_a_mean_system_that_is_unstable_is_one_tongue():
    (found,) = tongues(Modulated((50.0, 80.0), (0.6, 0.8), -0.1, 1.0), (200.0, 250.0))
    assert (found.lower, found.upper) == (200.0, 250.0)
    assert found.label.startswith("mean")


def test_neutral_systems_have_no_tongues():
    assert tongues(Modulated(frequencies=(30.0, 71.0), shape=(1.0, 0.0)), (10.0, 200.0)) == ()


def test_the_curve_of_multipliers_is_that_of_the_systems():
    model = transverse(1.0)
    low, high = rad_per_s(np.array([40.0, 400.0]))
    curve = MultiplierCurve.of(model, low, high)
    assert curve.error < 1e-10
    speeds = np.random.default_rng(4).uniform(low, high, 6)
    for speed, radius in zip(speeds, curve.spectral_radii(speeds), strict=True):
        system = model.system(speed)
        assert np.log(radius) / system.period == pytest.approx(growth_rate(system), abs=1e-8)
    # The derivative against a central difference.
    step = 1e-6
    slowness = 1.0 / speeds
    slopes = curve.slopes(speeds)
    ahead = curve.transition_matrices(1.0 / (slowness + step))
    behind = curve.transition_matrices(1.0 / (slowness - step))
    difference = (ahead - behind) / (2.0 * step)
    assert np.abs(slopes - difference).max() < 1e-5 * np.abs(slopes).max()


def test_borders_follow_the_tongues_over_a_parameter():
    values = [0.0, 0.01, 0.024, 0.0251]
    sections = borders(mathieu(1e-3), "damping", values, (90.0, 110.0), jobs=1)
    assert [section.value for section in sections] == values
    widths = [section.tongues[0].width for section in sections[:3]]
    assert widths == pytest.approx([np.sqrt(0.05**2 - (2 * c) ** 2) for c in values[:3]], rel=0.01)
    assert sections[3].tongues == ()


def test_borders_go_on_where_they_were_interrupted(tmp_path, monkeypatch):
    arguments = (mathieu(1e-3), "damping", [0.0, 0.01, 0.024, 0.0251], (90.0, 110.0))
    expected = borders(*arguments, jobs=1)
    run, done = parallel._run, []

    def stopping(number, task):
        done.append(number)
        if len(done) == 3:
            raise KeyboardInterrupt
        return run(number, task)

    monkeypatch.setattr(parallel, "_run", stopping)
    with pytest.raises(KeyboardInterrupt):
        borders(*arguments, jobs=1, cache_directory=tmp_path)
    resumed = borders(*arguments, jobs=1, cache_directory=tmp_path)
    assert agree(resumed, expected, rel=1e-9)
    # Values 0 and 1 once, 2 twice, 3 once; the last has lost its neighbour's tongue and is searched again.
    assert done == [0, 1, 2, 2, 3, 0]
    done.clear()
    assert borders(*arguments, jobs=1, cache_directory=tmp_path) == resumed  # read, not computed
    assert done == []


@dataclass(frozen=True)
class Jumping(Modulated):
    """Stiffness that depends on speed by steps."""

    def system(self, speed: float) -> PeriodicSystem:
        return Modulated((self.frequencies[0] + np.floor(speed / 3.0),)).system(speed)


def test_models_that_jump_with_speed_are_refused():
    with pytest.raises(ArithmeticError, match="do not vary smoothly with speed"):
        tongues(Jumping(), (90.0, 110.0))


@pytest.mark.parametrize(
    ("low", "high", "message"),
    [
        (0.0, 10.0, "speeds must be greater than 0"),
        (10.0, 10.0, "speeds must ascend"),
        (10.0, np.nan, "speeds must be finite"),
    ],
)
def test_ranges_are_checked(low, high, message):
    with pytest.raises(ValueError, match=message):
        tongues(mathieu(0.1), (low, high))


def test_other_arguments_are_checked():
    with pytest.raises(ValueError, match="threshold must lie in"):
        tongues(mathieu(0.1), (90.0, 110.0), threshold=0.0)
    with pytest.raises(ValueError, match="hints must be finite"):
        tongues(mathieu(0.1), (90.0, 110.0), hints=[np.inf])
    with pytest.raises(ValueError, match=r"hints must list speeds in rad/s, got 61\.0"):
        tongues(mathieu(0.1), (90.0, 110.0), hints=61.0)
    with pytest.raises(ValueError, match="values must list"):
        borders(mathieu(0.1), "damping", [], (90.0, 110.0), jobs=1)
    with pytest.raises(ValueError, match=r"parameter must be one of .*damping"):
        borders(mathieu(0.1), "thickness", [0.1], (90.0, 110.0), jobs=1)


def test_samples_that_nearly_coincide_do_not_hide_the_peak():
    """Growth 0.1 (0.25 − (v − 2)²), sampled twice at 1.9 with the second value lower by rounding."""

    class Curve:
        lowest_speed, highest_speed = 1.0, 3.0

        @staticmethod
        def spectral_radii(speeds):
            return np.exp(0.1 * (0.25 - (speeds - 2.0) ** 2) / speeds)

    speeds = np.array([1.0, 1.6, 1.9, 1.9 * (1 + 1e-12), 2.3, 3.0])
    radii = Curve.spectral_radii(speeds)
    radii[3] = radii[2] * (1 - 1e-15)
    scan = Scan(speeds, radii, np.full(6, np.nan), *np.ones((2, 6, 1)))
    ((lower, upper, peak),) = tracing._runs(Curve, scan, 1e-12)
    assert (lower, upper) == pytest.approx((1.5, 2.5), rel=1e-8)
    assert peak == pytest.approx(2.0, rel=1e-6)


def test_progress_says_beforehand_what_it_costs(capsys):
    quiet = tongues(mathieu(0.3, 0.01, 1.0), (0.8, 2.5), progress=False)
    assert capsys.readouterr().err == ""
    assert tongues(mathieu(0.3, 0.01, 1.0), (0.8, 2.5), progress=True) == quiet
    shown = capsys.readouterr().err
    assert "tongues, about 0 s" in shown.split("\r")[1]
    assert "matrices" in shown


def test_few_matrices_are_worked_on_at_once_so_that_an_interruption_is_heard(monkeypatch):
    alone = tongues(mathieu(0.3, 0.01, 1.0), (0.8, 2.5))
    monkeypatch.setattr(multiplier_curves, "_CUBES_AT_ONCE", 7 * 2**3)
    counts = []
    curve = MultiplierCurve.of(mathieu(0.3, 0.01, 1.0), 0.8, 2.5, looked_at=counts.append)
    computed = len(counts)
    scan_of(curve, 1e-8, [])
    assert curve.batch == 7
    assert len(counts) > computed + 10
    assert max(counts[computed:]) <= 7
    again = tongues(mathieu(0.3, 0.01, 1.0), (0.8, 2.5))
    assert [tongue.label for tongue in again] == [tongue.label for tongue in alone]
    np.testing.assert_allclose([t.lower for t in again], [t.lower for t in alone], rtol=1e-9)


def test_cost_grows_with_size_and_range():
    small = Transverse(Body(Drive(26, 130, 3.175e-3), 0.03), MeshLoad(1.0, 3e-6, 1.0))
    large = Transverse(
        Body(Drive(26, 130, 3.175e-3), 0.03, nodal_circles=2, nodal_diameters=6), MeshLoad(1.0, 3e-6, 1.0)
    )
    ends = [float(rad_per_s(speed)) for speed in (400.0, 600.0)]
    # Measured on a busy machine: 0.1 and 0.8 s.
    assert 0.03 < search_seconds(small, ends) < 0.3 < search_seconds(large, ends) < 2.4
    assert search_seconds(small, (ends[0] / 4.0, ends[1])) > search_seconds(small, ends)
    with pytest.raises(ValueError, match="speeds must ascend"):
        search_seconds(small, ends[::-1])


class Growing:
    """Motions whose multipliers are 1 and some growth in a period that is a polynomial of the speed."""

    lowest_speed, highest_speed, batch = 1.0, 3.0, 64

    def __init__(self, *growths):
        self.growths = [np.polynomial.Polynomial(growth) for growth in growths]

    def transition_matrices(self, speeds):
        return np.stack([np.diag([1.0 + growth(v) for growth in self.growths]) for v in speeds])

    def spectral_radii(self, speeds):
        return np.abs(self.transition_matrices(speeds)).max(axis=(1, 2))

    def slopes(self, speeds):
        return np.stack([np.diag([-(v**2) * growth.deriv()(v) for growth in self.growths]) for v in speeds])


# 1e-3 − (v − 2)²: unstable from 1.968 to 2.032.
HUMP = (1e-3 - 4.0, 4.0, -1.0)


def runs_of(scan):
    unstable = scan.radii > 1.0 + 1e-8
    return int(np.count_nonzero(np.diff(np.append(0, unstable.astype(int))) == 1))


@pytest.mark.parametrize("beside", [0.2, 0.02, 1e-4, 1e-8, 1e-12])
def test_a_hump_between_stable_samples_is_seen_however_close_two_of_them_are(beside):
    curve = Growing(HUMP)
    scan = Scan.of(curve, np.array([1.0, 1.955, 2.04, 2.04 + beside, 2.5, 3.0]))
    assert (scan.radii < 1.0).all()
    assert runs_of(scanning._rising(curve, scan, 1e-8)) == 1


@pytest.mark.parametrize("first", [1.7, 1.955, 1.9679])
def test_a_hump_and_a_valley_beside_a_tongue_are_seen(first):
    """Unstable from 1.968 to 2.032 and from 2.2 on, where another motion has taken over, and not between."""
    curve = Growing(HUMP, (-1.1, 0.5))
    scan = Scan.of(curve, np.array([1.0, first, 2.4, 3.0]))
    assert runs_of(scan) == 1
    scan = scanning._rising(curve, scan, 1e-8)
    assert runs_of(scan.with_samples(scanning._gaps(curve, scan, 1e-8))) == 2


@pytest.mark.parametrize("width", [-0.05, 1e-7, 1e-3, 0.05])
def test_between_two_motions_that_take_over_a_gap_is_found_if_there_is_one(width):
    """Growth falls to 0 at 2 − width/2, that of another motion rises from 0 at 2 + width/2; looked at from afar."""
    curve = Growing((0.2 * (2.0 - width / 2.0), -0.2), (-0.1 * (2.0 + width / 2.0), 0.1))
    scan = scanning._gaps(curve, Scan.of(curve, np.array([1.0, 1.7, 2.6, 3.0])), 1e-8)
    assert (scan.radii <= 1.0 + 1e-8).any() == (width > 0.0)


def test_where_unstable_motions_take_over_from_each_other_it_is_seen_at_once():
    """Growth 0.2 − 0.05 (v − 1) and 0.05 (v − 1) meet at 3 with 0.1."""
    curve = Growing((0.25, -0.05), (-0.05, 0.05))
    assert scanning._gaps(curve, Scan.of(curve, np.array([1.0, 2.6, 3.6, 5.0])), 1e-8).speeds.size < 10


def test_of_two_maxima_in_a_tongue_the_larger_is_the_peak_whichever_a_sample_is_near():
    """Growth 0.1 − (v − 1.5)² (v − 2.5)²/2 in a period: the rate is larger near 2.5, and only 1.5 is a sample."""
    hump = np.polynomial.Polynomial.fromroots([1.5, 1.5, 2.5, 2.5])
    curve = Growing((0.1 - 0.5 * hump).coef)
    scan = Scan.of(curve, np.array([1.0, 1.5, 2.0, 3.0]))
    ((_, _, peak),) = tracing._runs(curve, scan, 1e-8)
    speeds = np.linspace(2.4, 2.8, 400001)
    assert peak == pytest.approx(speeds[(np.log1p(0.1 - 0.5 * hump(speeds)) * speeds).argmax()], abs=2e-6)


def test_where_nothing_can_rise_far_enough_nothing_is_added():
    curve = Growing((-2.0, *HUMP[1:]))
    scan = Scan.of(curve, np.linspace(1.0, 3.0, 21) + 0.03)
    assert scanning._rising(curve, scan, 1e-8).speeds.size == scan.speeds.size


@pytest.mark.parametrize("angle", [0.2, 0.25, 0.3, 0.4])
def test_a_tongue_between_a_slow_and_a_dying_motion_is_found_wherever_samples_lie(monkeypatch, angle):
    """(1+7)/1 of this drive, 0.76 rpm wide, is not where the phases meet: with 0.3 rad it was missed."""
    drive = Drive(27, 98, 3.175e-3)
    body = Body(drive, 0.0342979519, 0.0374231916, nodal_circles=2, nodal_diameters=3)
    load = MeshLoad(stiffness=0.132025752, damping=5.9420277e-6, mass=1.44288192)
    monkeypatch.setattr(scanning, "_SAMPLE_ANGLE", angle)
    found = tongues(Transverse(body, load), rad_per_s([422.492858, 881.68634]), progress=False)
    assert found[0].label == "(1+7)/1"
    assert rpm([found[0].lower, found[0].upper]) == pytest.approx([443.0032, 443.7618], abs=1e-3)


@pytest.mark.parametrize("lowest_rpm", [300.0, 317.0, 330.0])
def test_a_tongue_next_to_another_one_is_found_wherever_samples_lie(lowest_rpm):
    """The motion that a follower force drives grows once more just below (17-1)/1: from 300 rpm on it was missed."""
    body = Body(Drive(31, 155, 2.581e-3), 0.0215, 0.036, nodal_circles=1, nodal_diameters=4)
    model = MeshOscillator(
        body,
        MeshLoad(stiffness=0.4771, damping=7.618e-6, mass=1.561),
        contact=Contact(path=shared_load("equal"), sharing="each", rate="total"),
        force=DrivingForce(power=76.49e3, pinion_speed=523.6, following="follower", harmonics=8),
        mesh_stiffness=7.86637476e7,
        mesh_damping=1.821e-7,
    )
    found = tongues(model, rad_per_s([lowest_rpm, 600.0]), threshold=1e-7, progress=False)
    (tongue,) = (t for t in found if 515.0 < rpm(t.peak) < 526.5)
    assert tongue.label == "mean 1"
    assert rpm([tongue.lower, tongue.upper]) == pytest.approx([524.34, 525.58], abs=0.02)
    # The spectral radius itself, by another method and without any scan.
    for speed, unstable in ((524.0, False), (525.0, True), (526.2, False), (529.0, True)):
        assert (growth_rate(model.system(float(rad_per_s(speed)))) > 0.0) == unstable


@pytest.mark.parametrize("lowest_rpm", [148.7290615, 176.0568871, 183.7927330])
def test_a_tongue_that_a_dying_pair_makes_by_itself_is_found_beside_a_wide_one(lowest_rpm):
    """(2+2)/7 of this gearbox, 0.23 rpm wide: its phases turn back before they meet, and it was missed."""
    gearbox = Gearbox(
        Drive(26, 65, 3.077e-3),
        pinion_inertia=3.712e-3,
        gear_inertia=0.1229,
        load_inertia=3.4369,
        mesh_stiffness=2.309562301e8,
        mesh_damping=125.29375483,
        input_stiffness=8728.1,
        input_damping=4.73499425e-3,
        output_stiffness=3.6739173e6,
        output_damping=1.99310013525,
    )
    model = Torsional(gearbox, arm="conjugate")
    found = tongues(model, rad_per_s([lowest_rpm, 290.0]), threshold=1e-7, progress=False)
    borders_rpm = [(rpm(t.lower), rpm(t.upper)) for t in found if 212.0 < rpm(t.peak) < 215.7]
    assert borders_rpm == [
        pytest.approx((213.33, 213.56), abs=0.02),
        pytest.approx((213.69, 215.75), abs=0.02),
    ]
    # The spectral radius itself, without any scan.
    for speed, unstable in ((213.2, False), (213.45, True), (213.62, False), (214.0, True)):
        assert (growth_rate(model.system(float(rad_per_s(speed)))) > 0.0) == unstable
