"""Tooth numbers, module and angles of a drive, and the circles of pinion and shaper that follow from them.

The shaper is identical to the pinion but for its addendum, unless it has more teeth: contact is then at a point, and
what the shaper makes is that of the drive in line contact with it (`generating`). Conventions, in units of the module
1/P_d: addendum of pinion and face gear 1.0, addendum of the shaper 1.25, dedendum 1.25.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property, wraps
from typing import Concatenate, ParamSpec, Self, TypeVar

from facegear.support import parameters
from facegear.symbolic import twins

ADDENDUM = 1.0  # pinion and face gear, in modules
SHAPER_ADDENDUM = 1.25
DEDENDUM = 1.25
SHAPER_OVERHANG = 0.5  # by which the shaper is longer at either end than what generates the flank, in modules
# With fewer, contact lines run through the cusp of the involute on the base circle.
FEWEST_TEETH = 10

D = TypeVar("D", bound="Proportions")
P = ParamSpec("P")
T = TypeVar("T")


def of_generating(compute: Callable[Concatenate[D, P], T]) -> Callable[Concatenate[D, P], T]:
    """Compute something that the shaper makes from the drive that it is the pinion of."""

    @wraps(compute)
    def computed(drive: D, /, *arguments: P.args, **named: P.kwargs) -> T:
        return compute(drive.generating, *arguments, **named)

    return computed


def involute(angle: float) -> float:
    """Involute function tan α − α of a pressure angle [rad]."""
    return math.tan(angle) - angle


@dataclass(frozen=True)
class Proportions:
    """Tooth numbers, module and angles of a pinion, the shaper and the face gear that it makes.

    Parameters and errors are those of :class:`facegear.geometry.drive.Drive`, but for what leaves no flank.
    """

    pinion_teeth: int
    gear_teeth: int
    module: float
    pressure_angle: float = math.radians(25.0)
    shaft_angle: float = math.radians(90.0)
    shaper_teeth: int | None = None

    def __post_init__(self) -> None:
        parameters.keep(
            self,
            pinion_teeth=parameters.integer_at_least("pinion_teeth", self.pinion_teeth, FEWEST_TEETH),
            gear_teeth=parameters.integer_at_least("gear_teeth", self.gear_teeth, FEWEST_TEETH + 1),
        )
        if self.gear_teeth <= self.pinion_teeth:
            raise ValueError(
                f"gear_teeth must exceed pinion_teeth={self.pinion_teeth}, got {self.gear_teeth!r}"
            )
        parameters.keep(
            self,
            module=parameters.within("module", self.module, 1e-4, 0.1, "m"),
            pressure_angle=parameters.angle_within("pressure_angle", self.pressure_angle, 14.5, 30.0),
            shaft_angle=parameters.angle_within("shaft_angle", self.shaft_angle, 60.0, 120.0),
        )
        if self.shaper_teeth is not None:
            teeth = parameters.integer_within(
                "shaper_teeth", self.shaper_teeth, self.pinion_teeth, self.gear_teeth - 1
            )
            parameters.keep(self, shaper_teeth=teeth)

    @cached_property
    def generating(self) -> Self:
        """The shaper, as a pinion, with the face gear that it makes: this drive itself if it has as many teeth."""
        if self.shaper_teeth is None or self.shaper_teeth == self.pinion_teeth:
            return self
        return self.with_teeth(self.shaper_teeth)

    def with_teeth(self, teeth: int) -> Self:
        """Give pinion and shaper as many teeth; nothing is checked."""
        made = object.__new__(type(self))
        parts = {part.name: getattr(self, part.name) for part in fields(self)}
        parameters.keep(made, **(parts | {"pinion_teeth": teeth, "shaper_teeth": None}))
        return made

    @property
    def axis_offset(self) -> float:
        """B = r_ps − r_p1, by which the pinion's axis is nearer the gear than the shaper's [m]; 0 in line contact."""
        return self.generating.pitch_radius - self.pitch_radius

    @property
    def has_line_contact(self) -> bool:
        """Whether pinion and face gear touch along lines, as the shaper has as many teeth as the pinion."""
        return self.generating is self

    def require_line_contact(self, name: str) -> None:
        """Refuse to be asked for contact lines where contact is at a point.

        Raises
        ------
        ValueError
            Naming what asks.
        """
        if not self.has_line_contact:
            raise ValueError(
                f"{name} needs contact along lines, of a shaper with as many teeth as the pinion "
                f"({self.pinion_teeth}); "
                f"with shaper_teeth={self.shaper_teeth} contact is at a point: fg.UnloadedContact has it, and for a "
                'model fg.Contact(path=fg.point_contact, sharing="mean") or '
                "fg.Contact(path=fg.loaded_contact(torque))"
            )

    @property
    def speed_ratio(self) -> float:
        """m_21 = N1/N2, face-gear speed over pinion speed: m_2s of a shaper with as many teeth."""
        return self.pinion_teeth / self.gear_teeth

    @property
    def gear_ratio(self) -> float:
        """N2/N1, pinion speed over face-gear speed."""
        return self.gear_teeth / self.pinion_teeth

    @property
    def angular_pitch(self) -> float:
        """θ_N = 2π/N2 of the face gear [rad] (5-1)."""
        return 2.0 * math.pi / self.gear_teeth

    @property
    def pitch_radius(self) -> float:
        """r_p of the pinion [m]."""
        return 0.5 * self.module * self.pinion_teeth

    @property
    def base_radius(self) -> float:
        """r_b1 of the pinion [m], r_bs of a shaper with as many teeth."""
        return self.pitch_radius * math.cos(self.pressure_angle)

    @property
    def pinion_tip_radius(self) -> float:
        """Addendum circle of the pinion [m]."""
        return self.pitch_radius + ADDENDUM * self.module

    @property
    @of_generating
    def shaper_tip_radius(self) -> float:
        """r_as, addendum circle of the shaper [m]."""
        return self.pitch_radius + SHAPER_ADDENDUM * self.module

    @property
    def dedendum_radius(self) -> float:
        """r_ds, dedendum circle of the shaper and of the pinion [m]."""
        return self.pitch_radius - DEDENDUM * self.module

    @property
    def tooth_top_distance(self) -> float:
        """r_p − a_g, distance of the face-gear tooth top from the pinion's axis [m]."""
        return self.pitch_radius - ADDENDUM * self.module

    @cached_property
    def space_half_angle(self) -> float:
        """θ_0s, half angle of the pinion's tooth space on the base circle [rad] (3-1)."""
        return float(twins.space_half_angle(self.pinion_teeth, self.pressure_angle))

    def roll_angle(self, radius: float) -> float:
        """Roll angle θs of the involute at a circle of the shaper [rad] (3-12)."""
        return math.sqrt(radius**2 - self.base_radius**2) / self.base_radius

    @property
    def pinion_tip_roll(self) -> float:
        """θ_a, roll angle at the pinion's addendum circle [rad]."""
        return self.roll_angle(self.pinion_tip_radius)

    @property
    @of_generating
    def shaper_tip_roll(self) -> float:
        """θ_s*, roll angle at the shaper's addendum circle [rad] (3-12)."""
        return self.roll_angle(self.shaper_tip_radius)

    @property
    def half_tooth_at_shaper_tip(self) -> float:
        """Half angle of the shaper's tooth at its addendum circle [rad]; zero when pointed."""
        at_tip = math.acos(self.base_radius / self.shaper_tip_radius)
        return math.pi / (2 * self.pinion_teeth) + involute(self.pressure_angle) - involute(at_tip)

    @property
    @of_generating
    def cone_cotangent(self) -> float:
        """Cot γ_s (3-16), so that u_s = r_bs cot γ_s / cos α_s wherever f = 0."""
        return float(twins.pointing_cone_angle_cotangent(self.speed_ratio, self.shaft_angle))
