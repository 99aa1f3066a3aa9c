import math
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from facegear import design
from facegear.geometry import Drive
from facegear.parameters import MeshLoad, rad_per_s, watt
from facegear.periodic import ContactLoad, PeriodicSystem
from facegear.piecewise import PiecewiseChebyshev
from facegear.plate import Body

DRIVE = design.constant_diametral_pitch(25)
LOAD = MeshLoad(stiffness=0.8, damping=1e-5, mass=1.0)


# --- families and stress -------------------------------------------------------------------------------------------


def test_families_keep_what_their_names_say():
    by_pitch = [design.constant_diametral_pitch(teeth) for teeth in (22, 35)]
    assert [drive.module for drive in by_pitch] == [25.4e-3 / 8] * 2
    by_radius = [design.constant_pitch_radius(teeth) for teeth in (22, 35)]
    assert [drive.pitch_radius for drive in by_radius] == pytest.approx([49.2125e-3] * 2, rel=1e-15)
    assert [drive.gear_teeth for drive in by_pitch + by_radius] == [110, 175, 110, 175]


def test_tooth_thickness_is_half_a_pitch_at_the_pitch_circle():
    chord = 2 * DRIVE.pitch_radius * math.sin(math.pi / (2 * DRIVE.pinion_teeth))
    assert design.tooth_thickness(DRIVE, DRIVE.pitch_radius) == pytest.approx(chord, rel=1e-14)


def test_tooth_and_space_fill_the_pitch_on_the_base_circle():
    """θ0s of (3-1) is half the space; the tooth has the rest."""
    half_tooth = math.pi / DRIVE.pinion_teeth - DRIVE.space_half_angle
    chord = 2 * DRIVE.base_radius * math.sin(half_tooth)
    assert design.tooth_thickness(DRIVE, DRIVE.base_radius) == pytest.approx(chord, rel=1e-12)


def test_tooth_follows_the_flank_of_the_generating_pinion():
    """Points of the flank (3-2) bound the tooth space; the tooth lies on the other side of them."""
    drive = design.constant_diametral_pitch(32)
    points = drive.pinion_flank(along=2, across=9).points[0]
    radius = np.hypot(points[:, 0], points[:, 1])
    # Angle from the middle of the space, whichever axis it lies on.
    polar = np.abs(np.arctan2(points[:, 0], points[:, 1]))
    space = np.minimum(polar, np.abs(polar - np.pi / 2))
    space = np.minimum(space, np.pi - polar)
    chord = 2 * radius * np.sin(np.pi / drive.pinion_teeth - space)
    ours = [design.tooth_thickness(drive, r) for r in np.clip(radius, None, drive.pinion_tip_radius)]
    assert ours == pytest.approx(chord, rel=1e-10)


def test_root_stress_is_that_of_a_cantilever():
    power, speed = float(watt(600.0)), float(rad_per_s(5000.0))
    width, length = design.root_thickness(DRIVE), 1.25 * DRIVE.module
    force = power / speed / DRIVE.pitch_radius
    moment_of_area = DRIVE.face_width * width**3 / 12
    expected = force * length * (width / 2) / moment_of_area
    assert design.root_stress(DRIVE, power, speed) == pytest.approx(expected, rel=1e-14)
    assert design.root_stress(DRIVE, power, speed, thickness=2 * width) == pytest.approx(expected / 4)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: design.constant_pitch_radius(25, pitch_radius=0.0), "pitch_radius"),
        (lambda: design.constant_pitch_radius(25, pitch_radius=49.2125), "module"),
        (lambda: design.constant_pitch_radius(0), "pinion_teeth"),
        (lambda: design.constant_diametral_pitch(25, gear_ratio=1), "gear_ratio"),
        (lambda: design.root_stress(DRIVE, -1.0, 500.0), "power"),
        (lambda: design.root_stress(DRIVE, 1.0, math.nan), "pinion_speed"),
        (lambda: design.root_stress(DRIVE, 1.0, 500.0, thickness=0.0), "thickness"),
        (lambda: design.tooth_thickness(DRIVE, 39.6875), "radius"),
        (lambda: design.Requirements(1.0, 1.0, 0.5, (1.0, 2.0)), "safety_factor"),
        (lambda: design.Requirements(1.0, 1.0, 1.5, (2.0, 1.0)), "speed_range"),
        (lambda: design.critical_thickness(DRIVE, LOAD, (30.0, 20.0)), "speed_range"),
        (lambda: design.critical_thickness(DRIVE, LOAD, (1.0, 2.0, 3.0)), "speed_range"),
        (
            lambda: design.critical_thickness(DRIVE, LOAD, (20.0, 30.0), thickness_range=(0.04, 40.0)),
            "thickness",
        ),
        (lambda: design.critical_thickness(DRIVE, LOAD, (20.0, 30.0), contact_ratio=0.5), "contact_ratio"),
    ],
)
def test_wrong_input_names_the_parameter(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_teeth_are_counted():
    with pytest.raises(TypeError, match="pinion_teeth"):
        design.constant_diametral_pitch(25.0)


# --- tips of lobes against a closed form ---------------------------------------------------------------------------

STIFF, SOFT = 1.5, 0.5
HALF = PiecewiseChebyshev(np.array([0.0, 0.5]), np.array([[[1.0]], [[0.0]]]))


@dataclass(frozen=True)
class Meissner:
    """q̈ + 2 d q̇ + (d² + k(t)) q = 0 with k stiff for half the period: growth rate of d = 0, less d, exactly."""

    damping: float

    def system(self, speed: float) -> PeriodicSystem:
        contact = ContactLoad(PiecewiseChebyshev.constant([1.0]), stiffness=STIFF - SOFT, weight=HALF)
        return PeriodicSystem(
            [[1.0]], [[2 * self.damping]], [[SOFT + self.damping**2]], (contact,), 2 * math.pi / speed
        )


def undamped_growth(speed):
    """Growth rate from the trace of two exponentials (Meissner)."""
    first, second, half = math.sqrt(STIFF), math.sqrt(SOFT), math.pi / speed
    a, b = first * half, second * half
    trace = 2 * math.cos(a) * math.cos(b) - (first / second + second / first) * math.sin(a) * math.sin(b)
    return math.acosh(max(abs(trace) / 2, 1.0)) / (2 * half)


def model_at(thickness_ratio):
    return Meissner(damping=10 * thickness_ratio)


def test_tip_of_meissners_principal_lobe():
    best = minimize_scalar(
        lambda speed: -undamped_growth(speed), bounds=(1.6, 2.3), method="bounded", options={"xatol": 1e-9}
    )
    result = design.highest_lobes(model_at, (1.3, 3.0), (0.005, 0.06), tolerance=1e-6)
    assert result.thickness_ratio == pytest.approx(-best.fun / 10, abs=1e-6)
    assert result.lobe.speed == pytest.approx(best.x, rel=1e-3)
    assert result.lobe.label == "(1+1)/1"


@pytest.mark.parametrize("speed_range", [(2.05, 3.0), (1.4, 1.8)])
def test_lobe_cut_off_by_the_end_of_the_speed_range(speed_range):
    end = min(speed_range, key=lambda speed: abs(speed - 1.95))
    result = design.highest_lobes(model_at, speed_range, (0.005, 0.06), tolerance=1e-6)
    assert result.thickness_ratio == pytest.approx(undamped_growth(end) / 10, abs=1e-6)
    assert result.lobe.speed == end


def test_secondary_lobe_decides_where_the_principal_is_out_of_range():
    best = minimize_scalar(
        lambda speed: -undamped_growth(speed), bounds=(0.9, 1.1), method="bounded", options={"xatol": 1e-9}
    )
    result = design.highest_lobes(model_at, (0.7, 1.2), (5e-4, 0.06), tolerance=1e-6)
    assert result.thickness_ratio == pytest.approx(-best.fun / 10, abs=1e-6)


def test_unstable_top_and_stable_range_are_refused():
    with pytest.raises(ValueError, match="thickness_range must end above all lobes"):
        design.highest_lobes(model_at, (1.3, 3.0), (0.001, 0.005))
    with pytest.raises(ValueError, match="thickness_range must reach down to an unstable lobe"):
        design.highest_lobes(model_at, (1.3, 3.0), (0.05, 0.06))


# --- the printed example -------------------------------------------------------------------------------------------


def test_lobe_a_of_figure_4_9():
    """Printed, read off a plot: h/a ≈ 0.0375 for 0 to 300 rpm. Nothing else reaches this high between 150 and 300."""
    speeds = tuple(rad_per_s([150.0, 300.0]).tolist())
    result = design.critical_thickness(DRIVE, LOAD, speeds, thickness_range=(0.036, 0.039))
    assert result.thickness_ratio == pytest.approx(0.0375, abs=1.5e-4)
    assert result.lobe.label == "(1+1)/1"
    assert result.lobes == tuple(sorted(result.lobes, key=lambda lobe: -lobe.thickness_ratio))


def test_design_flow():
    speeds = tuple(rad_per_s([150.0, 300.0]).tolist())
    needed = design.Requirements(float(watt(600.0)), float(rad_per_s(5000.0)), 1.5, speeds)
    ((result,),) = design.design_family([DRIVE], LOAD, needed, [speeds[1]], (0.036, 0.039), jobs=1)
    alone = design.design_body(DRIVE, LOAD, needed, (0.036, 0.039))
    assert alone == result
    assert result.body == Body(DRIVE, result.critical.thickness_ratio)
    assert result.allowable_stress == pytest.approx(439.9e6 / 1.5)
    assert result.stress_safe == (result.root_stress < result.allowable_stress)
    thin = Drive(22, 110, design.MODULE)
    assert design.root_stress(thin, needed.power, needed.pinion_speed) > result.allowable_stress
