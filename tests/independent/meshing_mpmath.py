"""Face-gear meshing from the motion of the shaper alone, in 30-digit arithmetic.

Nothing is solved on paper here. The shaper's involute is moved by three rotations (3-4); a point touches the generated
surface where the velocity of the motion has no component along the normal, with every derivative taken numerically.
The undercutting limit is where the generated surface becomes singular, the pointed tooth where its two flanks meet.
"""

from functools import cached_property, lru_cache

import numpy as np
from mpmath import (
    acos,
    acot,
    atan,
    atan2,
    cos,
    cos_sin,
    cot,
    findroot,
    hypot,
    mp,
    mpf,
    pi,
    quad,
    sin,
    sqrt,
    tan,
)

mp.dps = 30

RIGHT_ANGLE = pi / 2


class Drive:
    """Plain numbers of a drive, every length in metres, as 30-digit floats."""

    def __init__(self, pinion_teeth, gear_teeth, module, pressure_angle_deg=25, shaft_angle_deg=90):
        self.pinion_teeth, self.gear_teeth = pinion_teeth, gear_teeth
        self.module = mpf(module)
        pressure = mpf(pressure_angle_deg) * pi / 180
        self.shaft_angle = mpf(shaft_angle_deg) * pi / 180
        self.about_x = cos_sin(pi - self.shaft_angle)  # of gamma_m
        self.ratio = mpf(pinion_teeth) / gear_teeth  # m_2s
        self.pitch_radius = self.module * pinion_teeth / 2
        self.base_radius = self.pitch_radius * cos(pressure)
        self.half_space = pi / (2 * pinion_teeth) - (tan(pressure) - pressure)  # theta_0s (3-1)
        self.tip_roll = self.roll(self.pitch_radius + self.module)
        self.shaper_tip_roll = self.roll(self.pitch_radius + mpf("1.25") * self.module)
        self.root_radius = self.pitch_radius - mpf("1.25") * self.module

    def roll(self, radius):
        """Roll angle of the involute at a radius."""
        return sqrt((radius / self.base_radius) ** 2 - 1)

    def shaper_point(self, roll, u):
        """Point of the shaper's flank in its own frame (3-2): the involute unwound from the base circle."""
        c, s = cos_sin(self.half_space + roll)
        on_base = vector(s, -c, 0) * self.base_radius
        tangent = vector(c, s, 0) * (self.base_radius * roll)
        return on_base - tangent + vector(0, 0, u)

    def to_space(self, rotation, point):
        """Shaper frame to the frame fixed in space."""
        c, s = cos_sin(rotation)
        return vector(c * point[0] - s * point[1], s * point[0] + c * point[1], point[2])

    def to_gear(self, rotation, point):
        """Shaper frame to the rotating frame of the face gear (3-4)."""
        x, y, z = self.to_space(rotation, point)
        c, s = self.about_x
        x, y, z = x, c * y - s * z, s * y + c * z
        c, s = cos_sin(self.ratio * rotation)
        return vector(c * x + s * y, -s * x + c * y, z)

    def velocity_along_normal(self, roll, u, rotation):
        """Component of the shaper's motion, seen from the gear, along the common normal."""

        def moved(r, v, angle):
            return self.to_gear(angle, self.shaper_point(r, v))

        motion = derivative(lambda angle: moved(roll, u, angle), rotation)
        along_profile = derivative(lambda r: moved(r, u, rotation), roll)
        along_tooth = derivative(lambda v: moved(roll, v, rotation), u)
        return dot(motion, cross(along_profile, along_tooth))

    def u_of_contact(self, roll, rotation):
        """Position along the shaper's axis at which a profile point touches the gear; the condition is linear in it."""
        at_0 = self.velocity_along_normal(roll, mpf(0), rotation)
        at_1 = self.velocity_along_normal(roll, mpf(1), rotation)
        return at_0 / (at_0 - at_1)

    @property
    def tooth_top(self):
        """Distance of the plane of the gear's tooth tops from the pinion's axis."""
        return self.pitch_radius - self.module


def vector(*components):
    """Components that are added and multiplied together; a matrix of mpmath takes four times as long."""
    return np.array(components, dtype=object)


def derivative(function, at):
    """Central difference of fourth order of a vector function."""
    h = mpf("1e-6")
    far = function(at + 2 * h) - function(at - 2 * h)
    return (8 * (function(at + h) - function(at - h)) - far) / (12 * h)


def cross(a, b):
    return vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def tip_area(drive, rotation):
    """Signed area element of the surface that the shaper's tip circle generates; zero where it is singular (3-8)."""
    roll = drive.shaper_tip_roll

    def surface(r, angle):
        return drive.to_gear(angle, drive.shaper_point(r, drive.u_of_contact(r, angle)))

    along = derivative(lambda r: surface(r, rotation), roll)
    across = derivative(lambda angle: surface(roll, angle), rotation)
    normal = drive.to_gear(rotation, vector(*cos_sin(drive.half_space + roll), 0))
    return dot(cross(along, across), normal)


def singular_tangents(drive):
    """Tangents of the local pressure angle at which the tip generates a singular point, ascending."""
    offset = drive.half_space + drive.shaper_tip_roll
    steps = 120
    angles = [RIGHT_ANGLE * (2 * (k + mpf("0.5")) / steps - 1) for k in range(steps)]
    values = [tip_area(drive, angle - offset) for angle in angles]
    found = []
    for a, b, fa, fb in zip(angles, angles[1:], values, values[1:], strict=False):
        if fa * fb < 0:
            angle = findroot(lambda q: tip_area(drive, q - offset), (a, b), solver="anderson", tol=1e-20)
            found.append(tan(angle))
    return found


@lru_cache
def inner_limit(drive):
    """L1 (3-13): where the surface that the shaper's tip generates becomes singular for positive pressure angles."""
    roll = drive.shaper_tip_roll
    (tangent,) = [t for t in singular_tangents(drive) if t > 0]
    rotation = atan(tangent) - drive.half_space - roll
    return drive.u_of_contact(roll, rotation) - drive.root_radius * cot(drive.shaft_angle)


@lru_cache
def pointed_point(drive):
    """Roll angle and rotation at which both flanks meet in the plane of the tooth tops, shaft angle 90° only."""

    def meet(roll, rotation):
        point = drive.to_gear(rotation, drive.shaper_point(roll, drive.u_of_contact(roll, rotation)))
        return point[0] / drive.module, (point[2] + drive.tooth_top) / drive.module

    roll, rotation = findroot(meet, (drive.tip_roll * mpf("0.6"), mpf("0.1")), tol=1e-18)
    return roll, rotation


@lru_cache
def outer_limit(drive):
    """L2 (3-14 to 3-16), the pointing condition as printed, with its small-angle step."""
    c = mpf(drive.pinion_teeth - 2) / drive.pinion_teeth / (drive.base_radius / drive.pitch_radius)
    angle = findroot(
        lambda a: a - c * sin(a) - drive.half_space, (mpf("0.2"), mpf("1.2")), solver="anderson", tol=1e-25
    )
    ratio, shaft = drive.ratio, drive.shaft_angle
    pitch_cone = acot((1 + ratio * cos(shaft)) / (ratio * sin(shaft)))
    cos_pressure = drive.base_radius / drive.pitch_radius
    return (
        drive.pitch_radius * (cot(pitch_cone) - cot(shaft))
        + drive.module * cot(shaft)
        + drive.pitch_radius * cot(pitch_cone) * (cos_pressure - cos(angle)) / cos(angle)
    )


def tregold_contact_ratio(drive):
    """Length of the path of contact of the formative spur gears over the base pitch (3-23 to 3-26).

    A pitch cone of more than a right angle unrolls into an internal gear: its tooth number is negative.
    """
    ratio, shaft = 1 / drive.ratio, drive.shaft_angle
    cones = atan2(sin(shaft), ratio + cos(shaft)), atan2(ratio * sin(shaft), 1 + ratio * cos(shaft))
    teeth = [z / cos(cone) for z, cone in zip((drive.pinion_teeth, drive.gear_teeth), cones, strict=True)]
    cos_pressure = drive.base_radius / drive.pitch_radius
    path = mpf(0)
    for z in teeth:
        pitch, side = z * drive.module / 2, 1 if z > 0 else -1
        base = pitch * cos_pressure
        path += side * (sqrt((pitch + drive.module) ** 2 - base**2) - sqrt(pitch**2 - base**2))
    return path / (pi * drive.module * cos_pressure)


class ContactLine:
    """Contact line at one rotation angle of the pinion, shaft angle 90°, found by walking along the profile.

    A point of the profile carries a contact if it lies between the ends of the tooth, below the pinion's tip, above
    the base circle and below the plane of the tooth tops of the gear.
    """

    def __init__(self, drive, rotation, steps=200):
        self.drive, self.rotation = drive, mpf(rotation)
        inner, outer = inner_limit(drive), outer_limit(drive)

        def room(roll):
            point = self.point(roll)
            return min(
                (point[2] - inner) / drive.module,
                (outer - point[2]) / drive.module,
                (-point[1] - drive.tooth_top) / drive.module,
            )

        rolls = [drive.tip_roll * k / steps for k in range(steps + 1)]
        inside = [room(roll) > 0 for roll in rolls]
        entering = [k for k in range(steps) if inside[k + 1] and not inside[k]]
        leaving = [k for k in range(steps) if inside[k] and not inside[k + 1]]

        def border(k):
            return findroot(room, (rolls[k], rolls[k + 1]), solver="anderson", tol=1e-22)

        self.start = border(entering[0]) if entering else rolls[0]
        self.end = border(leaving[0]) if leaving else rolls[-1]
        assert any(inside), "no contact at this rotation"
        assert len(entering) <= 1
        assert len(leaving) <= 1

    def point(self, roll):
        """Contact point in the frame fixed in space."""
        drive = self.drive
        return drive.to_space(
            self.rotation, drive.shaper_point(roll, drive.u_of_contact(roll, self.rotation))
        )

    def speed(self, roll):
        """Arc length per roll angle."""
        step = derivative(self.point, roll)
        return sqrt(dot(step, step))

    def length_to(self, roll):
        """Arc length from the start of the line."""
        return quad(self.speed, [self.start, roll], method="gauss-legendre", maxdegree=3)

    @cached_property
    def length(self):
        return self.length_to(self.end)

    @property
    def midpoint(self):
        """Radius and angle of the midpoint on the gear plane."""
        half, roll = self.length / 2, (self.start + self.end) / 2
        for _ in range(8):
            step = (self.length_to(roll) - half) / self.speed(roll)
            roll -= step
            # What Newton's method leaves is of the size of its last step squared.
            if abs(step) < mpf("1e-10"):
                break
        x, _, z = self.point(roll)
        return hypot(x, z), atan2(x, z)


@lru_cache
def sweep(drive):
    """Rotation angles of the first contact, at the outer end, and of the last, at the inner end."""

    def rotation_at(u, roll):
        # The point at (u, roll) touches when the gear has turned so that the condition of contact holds there.
        guess = acos(drive.base_radius / (drive.ratio * u)) - drive.half_space - roll
        return findroot(lambda angle: drive.u_of_contact(roll, angle) - u, guess, tol=1e-20)

    def top_at(u):
        """Rotation and roll at which the tooth-top plane passes through the end at u."""
        start = acos(drive.base_radius / (drive.ratio * u)) - drive.half_space

        def off(roll, angle):
            point = drive.to_space(angle, drive.shaper_point(roll, u))
            return (
                (-point[1] - drive.tooth_top) / drive.module,
                (drive.u_of_contact(roll, angle) - u) / drive.module,
            )

        _, angle = findroot(off, (drive.tip_roll / 2, start - drive.tip_roll / 2), tol=1e-18)
        return angle

    first = top_at(outer_limit(drive))
    last = rotation_at(inner_limit(drive), drive.tip_roll)
    return first, last


def geometric_contact_ratio(drive):
    first, last = sweep(drive)
    return drive.pinion_teeth * abs(first - last) / (2 * pi)


def contact_centroid(drive, fraction, contact_ratio):
    """Radius and angle of the contact centroid (3-21) at a fraction of the mesh period, line lengths as weights."""
    first, last = sweep(drive)
    weight = radius = angle = mpf(0)
    fraction, contact_ratio = mpf(fraction), mpf(contact_ratio)
    pair = 0
    while fraction + pair < contact_ratio:
        share = (fraction + pair) / contact_ratio
        if share > 0:
            line = ContactLine(drive, first + (last - first) * share)
            length = line.length
            r, theta = line.midpoint
            weight, radius, angle = weight + length, radius + r * length, angle + theta * length
        pair += 1
    return radius / weight, angle / weight
