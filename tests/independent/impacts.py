"""Motions with contacts that are made and lost, by DOP853 from event to event: shares nothing with the package."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp


def _always(time):
    return True


def _whole(time):
    return 1.0


@dataclass
class Touch:
    """A spring and damper that acts while side · u > gap, u = φ(t)ᵀq − e(t); `at` gives φ, φ̇, e, ė."""

    at: Any
    side: int
    gap: float
    stiffness: float
    damping: float
    there: Any = _always
    total: bool = True
    strength: Any = _whole


@dataclass
class Drive:
    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    force: Any
    touches: list
    period: float
    breaks: tuple = ()

    def beyond(self, touch, time, state):
        n = len(self.mass)
        phi, _, e, _ = touch.at(time)
        return touch.side * (phi @ state[:n] - e) - touch.gap

    def rate(self, pressed):
        n = len(self.mass)
        inverse = np.linalg.inv(self.mass)
        active = [touch for touch, on in zip(self.touches, pressed, strict=True) if on]

        def rate(time, state):
            q, v = state[:n], state[n:]
            push = self.force(time) - self.damping @ v - self.stiffness @ q
            for touch in active:
                phi, moving, e, e_rate = touch.at(time)
                u = phi @ q - e - touch.side * touch.gap
                u_rate = phi @ v - e_rate + (moving @ q if touch.total else 0.0)
                push = push - phi * touch.strength(time) * (touch.stiffness * u + touch.damping * u_rate)
            return np.concatenate([v, inverse @ push])

        return rate

    def flown(self, state, periods=1):
        """State after some periods, and how often contacts were made or lost."""
        inside = [x for x in self.breaks if 0.0 < x < self.period]
        edges = [0.0, *inside, self.period]
        edges = [k * self.period + x for k in range(periods) for x in edges[:-1]] + [periods * self.period]
        count = 0
        for start, stop in pairwise(edges):
            middle = (start + stop) / 2.0
            there = [touch.there(middle) for touch in self.touches]
            just = start + 1e-13 * self.period
            pressed = [
                on and self.beyond(x, just, state) > 0.0 for x, on in zip(self.touches, there, strict=True)
            ]
            time = start
            while time < stop:
                events = []
                numbers = [i for i, on in enumerate(there) if on]
                for i in numbers:

                    def event(t, y, touch=self.touches[i]):
                        return self.beyond(touch, t, y)

                    event.terminal, event.direction = True, -1.0 if pressed[i] else 1.0
                    events.append(event)
                result = solve_ivp(
                    self.rate(pressed),
                    (time, stop),
                    state,
                    method="DOP853",
                    rtol=1e-12,
                    atol=1e-16,
                    events=events,
                )
                time, state = float(result.t[-1]), result.y[:, -1]
                if result.status == 1:
                    (which,) = [i for i, found in zip(numbers, result.t_events, strict=True) if found.size]
                    pressed[which] = not pressed[which]
                    count += 1
        return state, count
