"""What a shaper leaves of the face-gear flank that it generates, by brute force.

The shaper is a solid: involute teeth on a tip circle, all round, between two end planes. A point of the face gear is
carried through the whole motion in small steps and held against that solid at each of them; nothing is solved for but
the deepest instant, by sampling finer and finer about it. The flank itself comes from the motion alone: the position
along the shaper at which a profile point generates is where the motion, differentiated by a complex step, has no
component along the profile's normal.
"""

import math

import numpy as np
from scipy.optimize import fsolve


class Shaper:
    """Motion and solid of the shaper of a drive; lengths in metres."""

    def __init__(self, drive, ends, turns=1501):
        self.teeth, self.ratio = drive.pinion_teeth, drive.pinion_teeth / drive.gear_teeth
        self.tilt = math.pi - drive.shaft_angle
        pitch_radius = 0.5 * drive.module * drive.pinion_teeth
        self.base = pitch_radius * math.cos(drive.pressure_angle)
        self.tip = pitch_radius + 1.25 * drive.module
        self.half_space = math.pi / (2 * self.teeth) - math.tan(drive.pressure_angle) + drive.pressure_angle
        self.ends = ends
        self.turns = np.linspace(-2.2, 2.2, turns)

    def profile(self, roll):
        """Point (x, y) of the flank: the string unwound from the base circle."""
        angle = self.half_space + roll
        x = np.sin(angle) - roll * np.cos(angle)
        return self.base * x, -self.base * (np.cos(angle) + roll * np.sin(angle))

    def to_gear(self, x, y, z, turn):
        """From the shaper's frame to the face gear's when the shaper has turned by φs."""
        c, s = np.cos(turn), np.sin(turn)
        x, y = c * x - s * y, s * x + c * y
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        y, z = c * y - s * z, s * y + c * z
        c, s = np.cos(self.ratio * turn), np.sin(self.ratio * turn)
        return c * x + s * y, -s * x + c * y, z

    def to_shaper(self, x, y, z, turn):
        """Back from the face gear's frame to the shaper's."""
        c, s = np.cos(self.ratio * turn), np.sin(self.ratio * turn)
        x, y = c * x - s * y, s * x + c * y
        c, s = math.cos(self.tilt), math.sin(self.tilt)
        y, z = c * y + s * z, -s * y + c * z
        c, s = np.cos(turn), np.sin(turn)
        return c * x + s * y, -s * x + c * y, z

    def generated(self, roll, turn):
        """Point that a profile point generates at a rotation, in the gear's frame, and its position u."""
        roll, turn = np.broadcast_arrays(roll, turn)
        x, y = self.profile(roll)
        normal = np.cos(self.half_space + roll), np.sin(self.half_space + roll), np.zeros(roll.shape)

        def slip(u):
            motion = self.to_gear(x, y, np.full(roll.shape, u), turn + 1e-30j)
            carried = self.to_gear(*normal, turn)
            return sum(np.imag(a) * 1e30 * b for a, b in zip(motion, carried, strict=True))

        at_0, at_1 = slip(0.0), slip(1.0)
        u = at_0 / (at_0 - at_1)
        return (*self.to_gear(x, y, u, turn), u)

    def depth(self, x, y, z, turn):
        """Distance by which a point lies inside the solid, at most; negative outside."""
        x, y, z = self.to_shaper(x, y, z, turn)
        radius = np.hypot(x, y)
        roll = np.sqrt(np.maximum((radius / self.base) ** 2 - 1.0, 0.0))
        pitch = 2 * math.pi / self.teeth
        from_space = np.abs((np.arctan2(x, -y) + pitch / 2) % pitch - pitch / 2)
        flank = self.base * (from_space - self.half_space - roll + np.arctan(roll))
        return np.min([flank, self.tip - radius, z - self.ends[0], self.ends[1] - z], axis=0)

    def deepest(self, x, y, z, generated_at):
        """Greatest depth over the motion but for the instants about the generation of each point."""
        turns = self.turns
        shape, points = np.shape(x), [np.ravel(v)[:, None] for v in (x, y, z)]
        own = np.ravel(generated_at)[:, None]
        step, best = turns[1] - turns[0], np.full(own.size, -np.inf)
        depths = self.depth(*points, own + turns)
        # Every local maximum is looked at: a narrow one may be the deepest.
        inner = (depths[:, 1:-1] >= depths[:, :-2]) & (depths[:, 1:-1] >= depths[:, 2:])
        which, k = np.nonzero(
            inner & (np.abs(turns[1:-1]) > 2 * step) & (depths[:, 1:-1] > -0.05 * self.base)
        )
        if which.size:
            centre, width = turns[k + 1], step
            few = [p[which] for p in points]
            for _ in range(9):
                near = centre[:, None] + width * np.linspace(-1.0, 1.0, 33)
                local = self.depth(*few, own[which] + near)
                j = local.argmax(axis=1)
                centre, width = near[np.arange(which.size), j], width / 16
            np.maximum.at(best, which, local.max(axis=1))
        return best.reshape(shape)

    def cut_end(self, turn, low, high):
        """Roll angle up to which the shaper takes the lower end of a contact line, by bisection; `low` if none."""

        def cut(roll):
            points = self.generated(np.array([roll]), np.array([turn]))
            return self.deepest(*points[:3], np.array([turn]))[0] > 0.0

        if not cut(low):
            return low
        for _ in range(45):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if cut(middle) else (low, middle)
        return high


def shaper_of(drive):
    """Half a module longer at either end than what generates the flank, whose corners are its extremes."""
    corners = drive.tooth_flank(2, 2).position
    more = 0.5 * drive.module
    return Shaper(drive, (corners.min() - more, corners.max() + more))


def contact_ratio(drive, inner, outer):
    """Mesh periods from first to last contact on the flank that is left, given R1 and R2 [m].

    For drives whose last contact is at the pinion's tip, inside the outer edge, and whose flank begins at R1.
    """
    shaper = Shaper(drive, (-math.inf, math.inf))
    module, gamma = drive.module, drive.shaft_angle
    pitch_radius = 0.5 * module * drive.pinion_teeth
    tip_roll = math.sqrt(((pitch_radius + module) / shaper.base) ** 2 - 1.0)
    shaper_tip_roll = math.sqrt((shaper.tip / shaper.base) ** 2 - 1.0)

    def place(roll, turn):
        """Distance along the gear plane in the generating position, height over the tooth top, position u."""
        x, y, z, u = shaper.generated(roll, turn)
        c, s = math.cos(shaper.ratio * turn), math.sin(shaper.ratio * turn)
        depth = -z * math.sin(gamma) - np.hypot(x, y) * math.cos(gamma)
        return -(s * x + c * y), depth - (pitch_radius - module), u

    def turn_at(radius, roll):
        start = math.acos(min(1.0, shaper.base / (shaper.ratio * radius))) - shaper.half_space - roll
        return float(fsolve(lambda t: (place(roll, t[0])[0] - radius) / module, start, xtol=1e-13)[0])

    def top(unknown):
        out, height, _ = place(*unknown)
        return (out - outer) / module, height / module

    roll, first = fsolve(top, (0.6 * tip_roll, turn_at(outer, 0.6 * tip_roll)), xtol=1e-13)
    lowest = place(shaper_tip_roll, turn_at(inner, shaper_tip_roll))[2]
    more = 0.5 * module
    shaper.ends = float(lowest) - more, float(place(roll, first)[2]) + more

    def left(turn):
        x, y, z, _ = shaper.generated(np.array([tip_roll]), np.array([turn]))
        return shaper.deepest(x, y, z, np.array([turn]))[0] <= 0.0

    low = turn_at(inner, tip_roll)
    if not left(low):
        high = low + 0.1
        assert left(high)
        for _ in range(45):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if left(middle) else (middle, high)
    return shaper.teeth * (first - low) / (2 * math.pi)
