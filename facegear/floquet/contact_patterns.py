"""Which contacts are closed along an orbit, and the panels that end where one is made or lost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.clearance import ClearanceSystem
from facegear.support.parameters import integer_within, keep, within
from facegear.support.types import FloatArray

BoolArray = NDArray[np.bool_]

# Two instants closer than this fraction of the period are one.
_SAME = 1e-11
# Panels beyond which each step of Newton's method takes seconds.
_MOST_PANELS = 5000


@dataclass(frozen=True)
class Panels:
    """How finely a motion is resolved.

    Parameters
    ----------
    nodes : int
        Gauss nodes of each panel, 4 to 40: the degree to which accelerations are followed.
    angle : float
        Largest angle of the fastest natural motion along a panel [rad].

    Raises
    ------
    TypeError, ValueError
        Naming the argument.
    """

    nodes: int = 12
    angle: float = 2.5

    def __post_init__(self) -> None:
        keep(
            self,
            nodes=integer_within("nodes", self.nodes, 4, 40),
            angle=within("angle", self.angle, 0.05, 20.0),
        )

    def edges(self, system: ClearanceSystem) -> FloatArray:
        """Return the ends of panels without regard to contacts, breakpoints among them, from 0 to 1.

        Raises
        ------
        ArithmeticError
            If there are so many that no motion would be found in any time.
        """
        turns = system.fastest * system.period / self.angle
        if turns > _MOST_PANELS:
            raise ArithmeticError(
                f"the fastest motion in contact, {system.fastest:.3g} rad/s, takes {turns:.3g} panels of "
                f"{self.angle:g} rad in {system.period:.3g} s, more than {_MOST_PANELS}: contacts are too stiff to "
                "resolve"
            )
        return system.divided(self.angle)


@dataclass(frozen=True, eq=False)
class Pattern:
    """Which loads are in contact when.

    Attributes
    ----------
    edges : array, shape (P + 1,)
        Ends of the panels, from 0 to 1.
    pressed : array of bool, shape (P, p)
        Loads in contact along each panel.
    crossings : tuple of (int, int, float)
        Panel at whose start a contact is made or lost by the motion, load, and u̇ of the damper over |u̇| of the
        displacement, positive where contact is made.
    """

    edges: FloatArray
    pressed: BoolArray
    crossings: tuple[tuple[int, int, float], ...] = ()

    @property
    def instants(self) -> FloatArray:
        """Instants at which contacts are made or lost by the motion, fractions of the period."""
        return np.array([self.edges[panel] for panel, *_ in self.crossings])

    def repeated(self, periods: int) -> Pattern:
        """Return the pattern over several periods taken for one."""
        count = len(self.pressed)
        starts = (self.edges[:-1] + np.arange(periods)[:, np.newaxis]) / periods
        crossings = tuple((panel + k * count, i, r) for k in range(periods) for panel, i, r in self.crossings)
        return Pattern(np.append(starts.ravel(), 1.0), np.tile(self.pressed, (periods, 1)), crossings)

    def on(self, base: FloatArray) -> Pattern:
        """Return the pattern on other panels, its own instants kept."""
        edges = merged(base, self.instants)
        middles = (edges[:-1] + edges[1:]) / 2.0
        pressed = self.pressed[np.searchsorted(self.edges, middles, side="right") - 1]
        crossings = tuple(
            (int(np.abs(edges[:-1] - self.edges[panel]).argmin()), i, r) for panel, i, r in self.crossings
        )
        return Pattern(edges, pressed, crossings)


def merged(base: FloatArray, instants: FloatArray) -> FloatArray:
    """Return ends of panels with some instants among them; those that nearly coincide are one."""
    if not instants.size:
        return base
    away = np.abs(instants[:, np.newaxis] - base).min(axis=1)
    new = np.sort(instants[away > _SAME])
    if new.size:
        new = new[np.append(True, np.diff(new) > _SAME)]
    return np.sort(np.concatenate([base, new]))
