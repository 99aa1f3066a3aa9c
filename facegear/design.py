"""Stability-based design of the face-gear body (section 4.7): root stress, critical thickness, weight.

The critical thickness ratio of a drive is the smallest h/a above which it is stable at every operating speed. It is
the highest tip of all lobes of instability in the chart of speed and thickness. Tips are sharp, so they are not
looked for on a grid: :func:`facegear.tracing.tongues` finds every tongue at a few thicknesses, from above, and each
is then followed to the thickness at which its largest growth rate vanishes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from scipy.optimize import brentq, minimize_scalar

from facegear.floquet import Method, growth_rate
from facegear.geometry import DEDENDUM, Drive
from facegear.labels import combination
from facegear.models import Model
from facegear.multiplier_curves import method_for
from facegear.parameters import MeshLoad, integer_at_least, positive, within
from facegear.plate import THICKNESS_RATIO_RANGE, Body
from facegear.tracing import Tongue, tongues
from facegear.transverse import Transverse

MODULE = 25.4e-3 / 8
"""Module of the designs with constant diametral pitch, P_d = 8 (1/in) [m]."""
PITCH_RADIUS = 1.9375 * 25.4e-3
"""Pitch radius of the designs with constant pitch radius, 1.9375 in [m] (printed beside it: 49.2 mm)."""
GEAR_RATIO = 5
"""N2/N1 of both families of designs."""

# Thicknesses at which all tongues are looked for, each so many times the one above.
_LEVEL = 0.93
# Tongues of the levels are looked for above this part of the highest speed, where they are cheap to find; the
# whole range is searched just above the tip that they lead to.
_FAST_PART = 1 / 8
# Thickness steps in which the peak of a tongue is followed, relative, and window in which it is looked for.
_STEP = 0.01
_WINDOW = 0.004
_MOST_WINDOWS = 40


def constant_diametral_pitch(
    pinion_teeth: int, module: float = MODULE, gear_ratio: int = GEAR_RATIO
) -> Drive:
    """Drive of the family with constant diametral pitch (section 4.7.1).

    Parameters
    ----------
    pinion_teeth : int
        N1.
    module : float
        m_d = 1/P_d [m].
    gear_ratio : int
        N2/N1, at least 2.

    Raises
    ------
    TypeError, ValueError
        As :class:`facegear.geometry.Drive`, or a ratio that is not a whole number of at least 2.
    """
    teeth = integer_at_least("pinion_teeth", pinion_teeth, 1)
    return Drive(teeth, integer_at_least("gear_ratio", gear_ratio, 2) * teeth, module)


def constant_pitch_radius(
    pinion_teeth: int, pitch_radius: float = PITCH_RADIUS, gear_ratio: int = GEAR_RATIO
) -> Drive:
    """Drive of the family with constant pinion pitch radius (section 4.7.2).

    Parameters
    ----------
    pinion_teeth : int
        N1.
    pitch_radius : float
        r_p [m].
    gear_ratio : int
        N2/N1, at least 2.

    Raises
    ------
    TypeError, ValueError
        As :func:`constant_diametral_pitch`, or a radius that is not a positive number.
    """
    teeth = integer_at_least("pinion_teeth", pinion_teeth, 1)
    module = 2 * positive("pitch_radius", pitch_radius, "m") / teeth
    return constant_diametral_pitch(teeth, module, gear_ratio)


# --- stress -------------------------------------------------------------------------------------------------------


def tooth_thickness(drive: Drive, radius: float) -> float:
    """Chord of the pinion's tooth at a circle about its axis [m].

    The tooth is half a pitch thick, an arc, at the pitch circle. Outside the base circle the flanks are involutes,
    inside it they are taken as radial.

    Parameters
    ----------
    drive : Drive
    radius : float
        Between dedendum and tip circle [m].

    Raises
    ------
    TypeError, ValueError
        If `radius` is not a number in that interval.
    """
    radius = within("radius", radius, drive.dedendum_radius, drive.pinion_tip_radius, "m")
    roll = math.acos(min(drive.base_radius / radius, 1.0))
    involute = math.tan(drive.pressure_angle) - drive.pressure_angle
    half_angle = math.pi / (2 * drive.pinion_teeth) + involute - (math.tan(roll) - roll)
    return 2 * radius * math.sin(half_angle)


def root_thickness(drive: Drive) -> float:
    """Root thickness W of the pinion's tooth for (4-20): its chord at the dedendum circle [m].

    The text defines W by a sketch only. Fillets are left out.
    """
    return tooth_thickness(drive, drive.dedendum_radius)


def root_stress(drive: Drive, power: float, pinion_speed: float, thickness: float | None = None) -> float:
    """Largest bending stress at the root of the pinion's tooth (4-20, 4-21).

    Parameters
    ----------
    drive : Drive
    power : float
        P [W].
    pinion_speed : float
        Ω1 [rad/s].
    thickness : float, optional
        Root thickness W [m]; :func:`root_thickness` if left out.

    Returns
    -------
    float
        σ_max = 6 F_t H/(L W²), F_t = P/(Ω1 r_p), with dedendum H and face width L = L2 - L1 [Pa].

    Raises
    ------
    TypeError, ValueError
        If a number is not positive.
    """
    power, pinion_speed = positive("power", power, "W"), positive("pinion_speed", pinion_speed, "rad/s")
    root = root_thickness(drive) if thickness is None else positive("thickness", thickness, "m")
    force = power / (pinion_speed * drive.pitch_radius)
    return 6 * force * DEDENDUM * drive.module / (drive.face_width * root**2)


# --- critical thickness -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Lobe:
    """Tip of a lobe of instability in the chart of speed and thickness.

    Attributes
    ----------
    thickness_ratio : float
        h/a of its highest point [-].
    speed : float
        Ω2 there [rad/s]; an end of the speed range where the lobe is cut off by it.
    label : str
        Modes and order, as :attr:`facegear.tracing.Tongue.label`.
    """

    thickness_ratio: float
    speed: float
    label: str


@dataclass(frozen=True)
class CriticalThickness:
    """Smallest thickness ratio above which a drive is stable in the whole speed range.

    Attributes
    ----------
    lobes : tuple of Lobe
        Lobes whose tips were traced, the deciding one first. Lobes far below it are not among them.
    """

    lobes: tuple[Lobe, ...]

    @property
    def lobe(self) -> Lobe:
        """Lobe that decides."""
        return self.lobes[0]

    @property
    def thickness_ratio(self) -> float:
        """Critical thickness ratio h/a [-]."""
        return self.lobe.thickness_ratio


def critical_thickness(
    drive: Drive,
    load: MeshLoad,
    speed_range: tuple[float, float],
    *,
    thickness_range: tuple[float, float] = (0.025, 0.06),
    contact_ratio: float | None = None,
    nodal_circles: int = 1,
    nodal_diameters: int = 3,
) -> CriticalThickness:
    """Critical thickness ratio h/a of a drive with one pinion (section 4.7.1).

    Parameters
    ----------
    drive : Drive
    load : MeshLoad
        μ, ζ, τ.
    speed_range : tuple of float
        Operating speeds of the face gear, lowest and highest [rad/s]. The time it takes is nearly in inverse
        proportion to the lowest.
    thickness_range : tuple of float
        h/a between which the highest tip is looked for.
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh; Tregold's if left out.
    nodal_circles, nodal_diameters : int
        M and N of the body.

    Returns
    -------
    CriticalThickness
        To 1e-5 in h/a.

    Raises
    ------
    TypeError, ValueError
        As :func:`highest_lobes`, or as :class:`Transverse` for what makes up the model.
    """
    body = Body(
        drive,
        within("thickness_range", thickness_range[1], *THICKNESS_RATIO_RANGE),
        nodal_circles=nodal_circles,
        nodal_diameters=nodal_diameters,
    )
    model = Transverse(body, load, contact_ratio=contact_ratio)

    def model_at(thickness_ratio: float) -> Transverse:
        return replace(model, body=replace(body, thickness_ratio=thickness_ratio))

    return highest_lobes(model_at, speed_range, thickness_range)


def highest_lobes(
    model_at: Callable[[float], Model],
    speed_range: tuple[float, float],
    thickness_range: tuple[float, float],
    tolerance: float = 1e-5,
) -> CriticalThickness:
    """Tips of the highest lobes of any model that depends on a thickness ratio.

    From the top of the range downwards, all tongues are found at thicknesses 7 % apart until there are some. Each is
    followed upwards to its tip. Just above the highest tip all tongues are looked for once more, and followed if
    there are any, until there are none. What can be missed is a lobe that opens and closes between two of the
    levels above the result.

    Parameters
    ----------
    model_at : callable
        Thickness ratio to model.
    speed_range : tuple of float
        Lowest and highest speed [rad/s].
    thickness_range : tuple of float
        Lowest and highest thickness ratio.
    tolerance : float
        Accuracy of the tips in h/a, 1e-7 to 1e-3.

    Returns
    -------
    CriticalThickness

    Raises
    ------
    TypeError, ValueError
        If a range is not two ascending positive numbers, the model is unstable at the top of the thickness range, or
        stable in all of it.
    """
    lowest_speed, highest_speed = _ascending("speed_range", speed_range, "rad/s")
    thinnest, thickest = _ascending("thickness_range", thickness_range)
    tolerance = within("tolerance", tolerance, 1e-7, 1e-3)
    search = _Search(model_at, (lowest_speed, highest_speed), thickest, tolerance)
    fast = (max(lowest_speed, _FAST_PART * highest_speed), highest_speed)
    if found := search.tongues_at(thickest, fast):
        raise ValueError(
            f"thickness_range must end above all lobes: at h/a = {thickest:.6g} the model is unstable at "
            f"{found[0].peak:.6g} rad/s"
        )
    level = thickest
    while not found and level > thinnest:
        level = max(_LEVEL * level, thinnest)
        found = search.tongues_at(level, fast)
    # Without any in the fast part, slow lobes may still reach the bottom of the range.
    found = found or search.tongues_at(level, search.speed_range)
    lobes: list[Lobe] = []
    while found:
        lobes += [search.tip(level, tongue) for tongue in found]
        level = max(lobe.thickness_ratio for lobe in lobes) + tolerance
        found = search.tongues_at(level, search.speed_range)
    if not lobes:
        raise ValueError(
            f"thickness_range must reach down to an unstable lobe: down to h/a = {thinnest:.6g} the model is stable "
            f"from {lowest_speed:.6g} to {highest_speed:.6g} rad/s"
        )
    return CriticalThickness(tuple(sorted(lobes, key=lambda lobe: -lobe.thickness_ratio)))


def _ascending(name: str, values: tuple[float, float], unit: str = "") -> tuple[float, float]:
    if len(values) != 2:
        raise ValueError(f"{name} must be two numbers, lowest and highest, got {values!r}")
    low, high = (positive(name, value, unit) for value in values)
    if low >= high:
        raise ValueError(f"{name} must ascend, got {values!r}")
    return low, high


@dataclass(frozen=True)
class _Search:
    """Model, and where its lobes are looked for."""

    model_at: Callable[[float], Model]
    speed_range: tuple[float, float]
    thickest: float
    tolerance: float

    def tongues_at(self, thickness_ratio: float, speed_range: tuple[float, float]) -> tuple[Tongue, ...]:
        return tongues(self.model_at(thickness_ratio), *speed_range)

    def tip(self, level: float, tongue: Tongue) -> Lobe:
        """Follow the largest growth rate of a tongue upwards to where it vanishes."""
        method = method_for(self.model_at(level), *self.speed_range)
        points = [(level, tongue.peak)]
        growth = tongue.growth_rate

        def peak(thickness_ratio: float) -> float:
            """Growth rate; remembers the speed."""
            (x0, y0), (x1, y1) = points[-2] if len(points) > 1 else points[0], points[-1]
            # Natural frequencies are nearly in proportion to thickness, until two points tell more.
            exponent = math.log(y1 / y0) / math.log(x1 / x0) if x1 != x0 else 1.0
            guess = y1 * (thickness_ratio / x1) ** min(max(exponent, 0.0), 2.0)
            speed, value = _peak(self.model_at(thickness_ratio), method, guess, self.speed_range)
            points.append((thickness_ratio, speed))
            return value

        step = 0.1 * _STEP
        low = high = level
        while growth > 0.0:
            if high >= self.thickest:
                raise ValueError(
                    f"thickness_range must end above all lobes: lobe {tongue.label} goes on at {high:.6g}"
                )
            low, high = high, high * (1 + step)
            growth = peak(high)
            step = _STEP
        tip = float(brentq(peak, low, high, xtol=self.tolerance / 4))
        peak(tip)
        speed = points[-1][1]
        return Lobe(tip, speed, combination(self.model_at(tip).system(speed), method).label)


def _peak(
    model: Model, method: Method, guess: float, speed_range: tuple[float, float]
) -> tuple[float, float]:
    """Speed near a guess at which the growth rate is largest, and the growth rate there."""

    def growth(speed: float) -> float:
        return growth_rate(model.system(speed), method)

    lowest, highest = speed_range
    centre = min(max(guess, lowest), highest)
    for _ in range(_MOST_WINDOWS):
        low, high = max(centre * (1 - _WINDOW), lowest), min(centre * (1 + _WINDOW), highest)
        result = minimize_scalar(
            lambda speed: -growth(speed),
            bounds=(low, high),
            method="bounded",
            options={"xatol": 2e-6 * centre},
        )
        best, value = float(result.x), -float(result.fun)
        margin = 0.02 * (high - low)
        ends = [end for end in (low, high) if abs(best - end) < margin]
        if not ends:
            return best, value
        (end,) = ends
        if end in speed_range:
            at_end = growth(end)
            return (end, at_end) if at_end >= value else (best, value)
        centre = best
    raise ArithmeticError(f"no largest growth rate near {guess:.6g} rad/s: the resonance was lost")


# --- the flow of Fig. 4.6 -----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Requirements:
    """What a design has to fulfil (Table 4.4).

    Parameters
    ----------
    power : float
        P [W].
    pinion_speed : float
        Ω1 at that power [rad/s].
    safety_factor : float
        SF of (4-22), 1 or greater.
    speed_range : tuple of float
        Operating speeds of the face gear, lowest and highest [rad/s].

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or outside its range.
    """

    power: float
    pinion_speed: float
    safety_factor: float
    speed_range: tuple[float, float]

    def __post_init__(self) -> None:
        positive("power", self.power, "W")
        positive("pinion_speed", self.pinion_speed, "rad/s")
        within("safety_factor", self.safety_factor, 1.0, 100.0)
        _ascending("speed_range", self.speed_range, "rad/s")


@dataclass(frozen=True)
class BodyDesign:
    """Result of the design flow for one drive.

    Attributes
    ----------
    body : Body
        Face-gear body at the critical thickness.
    critical : CriticalThickness
        What decides it.
    root_stress : float
        σ_max [Pa] (4-20).
    allowable_stress : float
        σ_Y/SF [Pa] (4-22).
    """

    body: Body
    critical: CriticalThickness
    root_stress: float
    allowable_stress: float

    @property
    def stress_safe(self) -> bool:
        """Whether (4-22) holds."""
        return self.root_stress < self.allowable_stress


def design_body(
    drive: Drive,
    load: MeshLoad,
    requirements: Requirements,
    thickness_range: tuple[float, float] = (0.025, 0.06),
) -> BodyDesign:
    """Design a face-gear body for a drive: stress at the root, then thickness from stability (Fig. 4.6).

    Parameters
    ----------
    drive : Drive
    load : MeshLoad
        μ, ζ, τ.
    requirements : Requirements
    thickness_range : tuple of float
        As for :func:`critical_thickness`.

    Returns
    -------
    BodyDesign
        Also where the stress is too high: a family of designs shows both.
    """
    critical = critical_thickness(drive, load, requirements.speed_range, thickness_range=thickness_range)
    body = Body(drive, critical.thickness_ratio)
    stress = root_stress(drive, requirements.power, requirements.pinion_speed)
    return BodyDesign(body, critical, stress, body.material.yield_strength / requirements.safety_factor)


def design_family(
    drives: Sequence[Drive],
    load: MeshLoad,
    requirements: Requirements,
    highest_speeds: Sequence[float],
    thickness_range: tuple[float, float] = (0.025, 0.06),
    jobs: int = -1,
) -> tuple[tuple[BodyDesign, ...], ...]:
    """Design bodies for many drives and several operating speed ranges, in parallel processes.

    Parameters
    ----------
    drives : sequence of Drive
    load : MeshLoad
    requirements : Requirements
        Its speed range gives the lowest speed.
    highest_speeds : sequence of float
        Upper ends of the operating speed ranges [rad/s].
    thickness_range : tuple of float
        As for :func:`critical_thickness`.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.

    Returns
    -------
    tuple of tuple of BodyDesign
        One row a drive, one entry a highest speed in the given order.
    """
    from joblib import Parallel, delayed

    work = (delayed(_designs)(d, load, requirements, tuple(highest_speeds), thickness_range) for d in drives)
    return tuple(Parallel(n_jobs=jobs)(work))


def _designs(
    drive: Drive,
    load: MeshLoad,
    requirements: Requirements,
    highest_speeds: tuple[float, ...],
    thickness_range: tuple[float, float],
) -> tuple[BodyDesign, ...]:
    """Designs of one drive; a narrower speed range is stable wherever a wider one is, which saves levels."""
    from threadpoolctl import threadpool_limits

    lowest = requirements.speed_range[0]
    done: dict[float, BodyDesign] = {}
    thinnest, top = thickness_range
    with threadpool_limits(limits=1):
        for highest in sorted(set(highest_speeds), reverse=True):
            wanted = replace(requirements, speed_range=(lowest, highest))
            done[highest] = design_body(drive, load, wanted, (thinnest, top))
            top = done[highest].critical.thickness_ratio * (1 + 1e-3)
    return tuple(done[highest] for highest in highest_speeds)
