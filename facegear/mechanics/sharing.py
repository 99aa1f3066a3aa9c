"""How the tooth pairs in mesh share the load: rules beside the stiffness that a loaded contact gives each pair.

A rule says what stiffness a pair has, over the mean stiffness k_m of a pair alone (7-2), while its line sweeps the
tooth. All of them leave the mesh as stiff in the mean over a mesh period, cr times k_m; they differ in when it is stiff
and where. :class:`facegear.mechanics.paths.loaded_contact` needs none: there the compliance of the teeth decides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from facegear.floquet.fourier import fourier_series
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.timed_pairs import PairStates, TimedPairs
from facegear.support.parameters import one_of, positive
from facegear.support.types import FloatArray

Rule = Callable[[PairStates, "SharedPath"], FloatArray]


def _by_share(states: PairStates, path: SharedPath) -> FloatArray:
    return np.asarray(path.contact_ratio * states.length / states.length.sum(axis=0))


def _by_length(states: PairStates, path: SharedPath) -> FloatArray:
    return path.contact_ratio * states.length / path.mean_length


def _equally(states: PairStates, path: SharedPath) -> FloatArray:
    return states.in_contact.astype(float)


RULES: dict[str, Rule] = {"length_share": _by_share, "length": _by_length, "equal": _equally}
"""Stiffness of the pairs over k_m, of the shape of their states, by the name of the rule."""


@dataclass(frozen=True)
class shared_load:  # noqa: N801 (a path, as the functions line_contact and point_contact)
    """Another path whose pairs share the load by a rule: a path for `Contact`.

    Parameters
    ----------
    rule : {"length_share", "length", "equal"}
        Stiffness of a pair over k_m: cr times its part of the length of all contact lines at that instant, so that the
        mesh is always as stiff; cr times its length over the mean of that of all; or 1 while it is in mesh.
    path : class
        Where the pairs are, on contact lines: :class:`ContactPath`, :func:`facegear.mechanics.paths.line_contact` or
        :class:`facegear.mechanics.paths.loaded_contact`, whose pairs are weighted by their forces.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or there is no such rule.

    Examples
    --------
    >>> import facegear as fg
    >>> contact = fg.Contact(path=fg.shared_load("length_share"), sharing="each")
    >>> young, old = contact.places(fg.Drive(26, 130, 3.175e-3))
    >>> float(young.weight(0.4)[0] + old.weight(0.4)[0])
    1.5532
    """

    rule: str
    path: Callable[..., TimedPairs] = ContactPath

    def __post_init__(self) -> None:
        one_of("rule", self.rule, tuple(RULES))
        if not callable(self.path):
            raise TypeError(f"path must be a class of contact points such as ContactPath, got {self.path!r}")

    def __call__(self, drive: Drive, contact_ratio: float | None = None) -> SharedPath:
        """Path of a drive, on the clock of the path whose load is shared.

        Raises
        ------
        TypeError, ValueError
            As that path, or if it has no contact lines.
        """
        own = self.path(drive, contact_ratio)
        if not isinstance(own, TimedPairs):
            raise TypeError(f"path must return contact points, a TimedPairs such as ContactPath, got {own!r}")
        return SharedPath(drive, own.contact_ratio, own=own, rule=self.rule)


@dataclass(frozen=True)
class SharedPath(TimedPairs):
    """Path of contact of a drive whose pairs share the load by a rule.

    Parameters
    ----------
    drive : Drive
    contact_ratio : float
        That of `own`.
    own : TimedPairs
        Where the pairs are, with the lengths of their contact lines.
    rule : {"length_share", "length", "equal"}

    Raises
    ------
    TypeError, ValueError
        If a parameter is not valid, or the path has no contact lines.
    """

    own: TimedPairs = field(kw_only=True)
    rule: str = field(kw_only=True)

    has_lengths: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.own.has_lengths:
            raise ValueError(
                f"path must have contact lines to share the load by, as ContactPath has, got {type(self.own).__name__} "
                f'(Contact with sharing = "each" gives each of its pairs k_m)'
            )
        if self.contact_ratio == 1.0:
            raise ValueError(
                "contact_ratio must exceed 1 for pairs to share the load, got 1.0: one leaves as the next one enters"
            )

    @property
    def breakpoints(self) -> tuple[float, ...]:
        """Fractions of T0 in [0, 1), ascending from 0, between which all is smooth."""
        return self.own.breakpoints

    @property
    def fit_tolerances(self) -> FloatArray:
        """Relative errors that a fit may have, shape (pieces,) [-]."""
        return self.own.fit_tolerances

    @property
    def centroid_jumps(self) -> bool:
        """Whether the centroid of the pairs jumps, as on the path whose load is shared."""
        return self.own.centroid_jumps

    @property
    def pitch_passage(self) -> float:
        """Mesh periods since entry at which a pair passes the pitch point."""
        return self.own.pitch_passage

    def require_followable(self, name: str, mean: bool) -> None:
        """As that of the path whose load is shared."""
        self.own.require_followable(name, mean)

    def pair_states(self, x: ArrayLike) -> PairStates:
        """As :meth:`TimedPairs.pair_states`, with the stiffness of each pair."""
        return self._stiffened(self.own.pair_states(x))

    def pair_states_on_pieces(self, pieces: NDArray[np.intp], local: FloatArray) -> PairStates:
        """As :meth:`TimedPairs.pair_states_on_pieces`, with the stiffness of each pair."""
        return self._stiffened(self.own.pair_states_on_pieces(pieces, local))

    def _states(self, ages: FloatArray, in_mesh: NDArray[np.bool_]) -> PairStates:
        return self._stiffened(self.own._states(ages, in_mesh))

    def _stiffened(self, states: PairStates) -> PairStates:
        return states._replace(stiffness=RULES[self.rule](states, self))

    @cached_property
    def mean_length(self) -> float:
        """Mean over a mesh period of the length of all contact lines [m]."""

        def total(fraction: FloatArray) -> FloatArray:
            return np.asarray(self.own.pair_states(fraction).length.sum(axis=0)[:, np.newaxis, np.newaxis])

        return float(fourier_series(total, np.array(self.breakpoints), 1).mean.item())

    def transmission_error(self, approach: float) -> PiecewiseChebyshev:
        """Find the static transmission error: how far the teeth of all pairs give way together under a constant force.

        Over the pinion's base radius it is the angle by which the pinion is ahead of where rigid gears would have it,
        as :meth:`facegear.mechanics.loaded_contact.LoadedContact.transmission_error` for pairs of another law.

        Parameters
        ----------
        approach : float
            Force along the line of action over k_m: what one pair alone would give way [m], greater than 0.

        Returns
        -------
        PiecewiseChebyshev
            Approach δ of the teeth along the line of action against t/T0 [m].

        Raises
        ------
        TypeError, ValueError
            If `approach` is not a number greater than 0.
        """
        alone = positive("approach", approach, "m")

        def error(fraction: FloatArray, piece: int) -> FloatArray:
            stiffness = RULES[self.rule](self.own.pair_states(fraction), self)
            return np.asarray(alone / stiffness.sum(axis=0))

        return PiecewiseChebyshev.fit(error, self.breakpoints, tolerance=self.fit_tolerances)
