"""Contact under load between shafts at 90°, in 30-digit arithmetic, from its definition.

Nothing here imports facegear. A point of the gear's flank is a tangent of the shaper's base circle, at the local
pressure angle q, of the length of the arc that it has left. The pinion's flank has the same tangent planes about its
own axis, which parallel errors shift. Each slice q is pressed by what the approach exceeds its gap; forces are added up
by quadrature between ends that are looked for one by one, and the approach is what balances the torque.
"""

from functools import cached_property

from mpmath import atan2, cos, findroot, hypot, mp, mpf, pi, quad, sin, sqrt

from tests.independent import meshing_mpmath


class LoadedContact:
    """A drive with a larger shaper, errors ΔE and Δq [m], torque at the pinion [N m], and one law of compliance."""

    def __init__(self, teeth, shaper_teeth, module, torque, law, offset=0, gear_axial=0, factor="0.5"):
        self.own = meshing_mpmath.Drive(*teeth, module)
        self.shaper = meshing_mpmath.Drive(shaper_teeth, teeth[1], module)
        self.alpha = 25 * pi / 180
        self.B = self.shaper.pitch_radius - self.own.pitch_radius
        self.E, self.Q = mpf(offset), mpf(gear_axial)
        self.rb, self.rb1 = self.shaper.base_radius, self.own.base_radius
        self.K = self.rb / self.shaper.ratio  # u cos q
        self.inner, self.outer = (
            meshing_mpmath.inner_limit(self.shaper),
            meshing_mpmath.outer_limit(self.shaper),
        )
        m = self.own.module
        # (7-1) and (7-2): cantilevers of the circular pitch, loaded at their tip, two in series.
        tooth = mpf(200e9) * (pi * m) ** 3 * (self.outer - self.inner) / (32 * (mpf("2.25") * m) ** 3)
        self.k = mpf(factor) * tooth / cos(self.alpha) / 2
        self.force = mpf(torque) / self.rb1
        self.law = law
        self.pitch = 2 * pi / shaper_teeth
        self.known = {}

    # --- gap -----------------------------------------------------------------------------------------------

    def passes(self, q):
        """By how much the normal at q passes the pinion's base circle at a distance."""
        return self.B * cos(self.alpha) - self.E * sin(q) - (self.B + self.Q) * cos(q)

    @cached_property
    def q0(self):
        return findroot(self.passes, self.alpha)

    def gap(self, q):
        """Integral of what normals pass the base circle at: both tangent planes turn about their own points."""

        def antiderivative(x):
            return self.B * cos(self.alpha) * x + self.E * cos(x) - (self.B + self.Q) * sin(x)

        return antiderivative(q) - antiderivative(self.q0)

    def reach(self, level):
        """Local pressure angles on both sides at which the gap is that large."""
        width = sqrt(2 * level / (self.B * sin(self.alpha)))
        ends = []
        for sense in (-1, 1):
            step = width
            while self.gap(self.q0 + sense * step) < level:
                step *= mpf("1.2")
            ends.append(
                findroot(
                    lambda q: self.gap(q) - level,
                    (self.q0 + sense * step / 4, self.q0 + sense * step),
                    "illinois",
                )
            )
        return ends

    # --- lines ---------------------------------------------------------------------------------------------

    def own_roll(self, q, roll):
        return (self.rb * roll + self.E * cos(q) - (self.B + self.Q) * sin(q)) / self.rb1

    @cached_property
    def bounds(self):
        """Functions of q and of the roll angle that are not negative on both flanks; the first ones end lines below."""
        return [
            lambda q, roll: roll,
            lambda q, roll: self.own_roll(q, roll),
            lambda q, roll: self.rb * (cos(q) + roll * sin(q)) - self.shaper.tooth_top,
            lambda q, roll: self.K / cos(q) - self.inner,
        ], [
            lambda q, roll: self.shaper.shaper_tip_roll - roll,
            lambda q, roll: self.own.tip_roll - self.own_roll(q, roll),
            lambda q, roll: self.outer - self.K / cos(q),
        ]

    def ends(self, c):
        """Both ends of the line θs = q − c."""
        if c not in self.known:
            self.known[c] = self.found_ends(c)
        return self.known[c]

    def found_ends(self, c):
        sides = []
        for functions, choose in zip(self.bounds, (max, min), strict=True):
            low, high = mpf("0.02"), mpf("1.2")
            roots = []
            for function in functions:
                f_low, f_high = function(low, low - c), function(high, high - c)
                if f_low * f_high < 0:
                    roots.append(
                        findroot(lambda q, f=function: f(q, q - c), (low, high), "illinois", maxsteps=200)
                    )
                else:  # nowhere a bound, or everywhere beyond it
                    roots.append(low if (f_low >= 0) == (choose is max) else high)
            sides.append(choose(roots))
        return sides

    @cached_property
    def first(self):
        """C of the first line: the tooth top at the outer edge."""
        q = mp.acos(self.K / self.outer)
        roll = (self.shaper.tooth_top / self.rb - cos(q)) / sin(q)
        return q - roll

    def line(self, age):
        return self.first - age * self.pitch

    # --- load ----------------------------------------------------------------------------------------------

    def pressed(self, level, age):
        """Interval of q that a pair presses, None if none."""
        low, high = self.ends(self.line(age))
        if low >= high:
            return None
        inside, outside = self.reach(level)
        low, high = max(low, inside), min(high, outside)
        return (low, high) if low < high else None

    def nearest(self, age):
        low, high = self.ends(self.line(age))
        return min(max(self.q0, low), high) if low < high else None

    def pair_force(self, level, age):
        if self.law == "pair":
            q = self.nearest(age)
            return mpf(0) if q is None else max(self.k * (level - self.gap(q)), mpf(0))
        ends = self.pressed(level, age)
        if ends is None:
            return mpf(0)
        return quad(lambda q: self.load(q, level), ends, method="gauss-legendre", maxdegree=4)

    def load(self, q, level):
        """Load per local pressure angle [N/rad]."""
        return self.k / (self.outer - self.inner) * (level - self.gap(q)) * self.K * sin(q) / cos(q) ** 2

    def pair(self, level, age):
        """Force and stiffness of a pair, and the integral of its load times radius and angle."""
        if self.law == "pair":
            q = self.nearest(age)
            over = None if q is None else level - self.gap(q)
            if over is None or over <= 0:
                return mpf(0), mpf(0), mpf(0), mpf(0)
            radius, angle = self.place(q, age)
            return self.k * over, self.k, self.k * over * radius, self.k * over * angle
        ends = self.pressed(level, age)
        if ends is None:
            return mpf(0), mpf(0), mpf(0), mpf(0)
        per_length = self.k / (self.outer - self.inner)

        def moment(arm):
            return quad(lambda q: self.load(q, level) * arm(q), ends, method="gauss-legendre", maxdegree=4)

        return (
            self.pair_force(level, age),
            per_length * self.K * (1 / cos(ends[1]) - 1 / cos(ends[0])),
            moment(lambda q: self.place(q, age)[0]),
            moment(lambda q: self.place(q, age)[1]),
        )

    def place(self, q, age):
        x = self.rb * (sin(q) - (q - self.line(age)) * cos(q))
        return hypot(x, self.K / cos(q)), atan2(x, self.K / cos(q))

    def all_pairs(self, level, phase):
        return [self.pair(level, phase + k) for k in range(6)]

    def total(self, level, phase):
        return sum(self.pair_force(level, phase + k) for k in range(6))

    def approach(self, phase):
        """Where the pairs balance the torque."""
        low = high = self.force / self.k / 7
        while self.total(high, phase) < self.force:
            high *= 2
        while self.total(low, phase) > self.force:
            low /= 2
        return findroot(
            lambda level: self.total(level, phase) - self.force,
            (low, high),
            "illinois",
            tol=1e-30,
            maxsteps=200,
            verify=False,
        )

    # --- beginning and end ---------------------------------------------------------------------------------

    def begins(self):
        """Age at which a pair begins to be pressed: its end nearest to the contact has just the gap of the approach."""
        return self._touches(-1, mpf(0), 1)

    def stops(self):
        """Age at which a pair ceases to be pressed."""
        last = findroot(
            lambda age: self.ends(self.line(age))[1] - self.ends(self.line(age))[0], (2, 5), "illinois"
        )
        return self._touches(1, last, -1)

    def _touches(self, side, start, sense):
        def excess(age):
            end = self.ends(self.line(age))[0 if side < 0 else 1]
            return self.total(self.gap(end), age - mp.floor(age)) - self.force

        # At the first and the last line the pair is pressed at once if the approach exceeds the gap there.
        tiny = mpf("1e-9")
        if excess(start + sense * tiny) < 0:
            return start
        step = mpf("0.05")
        age = start + sense * tiny
        while excess(age + sense * step) > 0:
            age += sense * step
        return findroot(excess, (age, age + sense * step), "illinois", tol=1e-30, maxsteps=200, verify=False)
