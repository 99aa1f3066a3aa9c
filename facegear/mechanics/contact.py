"""Where the teeth of a pinion press, and when: from a path of contact points to shape vectors.

A path (:class:`facegear.geometry.kinematics.ContactPath`, :class:`~facegear.geometry.skew_line.SkewLine`, or any
class of the kind) says where each tooth pair touches at each instant of its mesh time. `Contact` puts it on a clock,
says how the pairs in mesh share the load, and gives each load's place against t/T0; a model turns places into its own
shape vectors, and pinions at other angles, faces or flanks into rotated, shifted, mirrored ones or such that run
backwards.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from facegear.floquet.loads import Rate
from facegear.floquet.piecewise import PiecewiseChebyshev
from facegear.geometry.drive import Drive
from facegear.geometry.kinematics import ContactPath
from facegear.geometry.skew_line import SkewLine
from facegear.geometry.timed_pairs import TimedPairs
from facegear.support.parameters import finite, keep, one_of, within
from facegear.support.types import FloatArray

Travel = Literal["printed", "with_disk"]
Sharing = Literal["centroid", "mean", "each"]


@dataclass(frozen=True)
class Contact:
    """How the tooth pairs of a mesh touch and share the load.

    Parameters
    ----------
    path : class
        Law of the contact points, called with a drive and a contact ratio or None: :class:`ContactPath`, the midpoints
        of the true contact lines; :class:`SkewLine`, the straight line of (3-22); those of
        :mod:`facegear.mechanics.paths`, on their own clocks; or another
        :class:`facegear.geometry.timed_pairs.TimedPairs`.
    sharing : {"centroid", "mean", "each"}
        One load at the mean contact point, weighted by the lengths of the contact lines (3-21) or with equal weights,
        the only mean of a contact at a point, which has no lines; or one load for each tooth pair, numbered by age,
        there while the pair is in mesh.
    contact_ratio : float, optional
        Mesh periods that a tooth pair stays in mesh, 1 or more, and 1.001 or more where total rate follows a mean
        point. Default None: that of the path, whatever the drive, which is Tregold's, as printed, for those of the
        dissertation. A number stays when the drive is replaced.
    rate : {"frozen", "total"}
        Whether a spring, damper or mass at the contact follows ∂w/∂t at the contact point ("frozen", as printed in
        4-1) or the displacement under the moving point ("total", chapter 7).
    travel : {"printed", "with_disk"}
        Whether the disk turns towards growing θ while the contact turns towards falling θ, (4-1) and section
        3.6 as printed, or contact, disk and the order in which a tooth meets the pinions agree ("with_disk":
        all angles against the disk's rotation). Torsion knows no angles: there it changes nothing.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or outside its range, or the sharing asks for what the path does not have.

    Examples
    --------
    >>> import facegear as fg
    >>> contact = fg.Contact(contact_ratio=1.6)
    >>> [place] = contact.places(fg.Drive(26, 130, 3.175e-3))
    >>> place.position(0.0).shape
    (2,)
    """

    path: Callable[..., TimedPairs] = ContactPath
    sharing: Sharing = "centroid"
    contact_ratio: float | None = None
    rate: Rate = "frozen"
    travel: Travel = "printed"

    def __post_init__(self) -> None:
        if not callable(self.path):
            raise TypeError(f"path must be a class of contact points such as ContactPath, got {self.path!r}")
        one_of("sharing", self.sharing, ("centroid", "mean", "each"))
        one_of("rate", self.rate, ("frozen", "total"))
        one_of("travel", self.travel, ("printed", "with_disk"))
        if self.contact_ratio is not None:
            hint = "below 1 there are instants without any tooth in mesh"
            keep(self, contact_ratio=within("contact_ratio", self.contact_ratio, 1.0, math.inf, hint=hint))

    @property
    def sense(self) -> float:
        """Sign that `travel` gives all angles."""
        return -1.0 if self.travel == "with_disk" else 1.0

    def ratio(self, drive: Drive) -> float:
        """Mesh periods that a tooth pair of a drive stays in mesh: `contact_ratio`, else that of the path.

        Raises
        ------
        TypeError, ValueError
            If it is not valid for the drive.
        """
        return _path(self.path, drive, self.contact_ratio).contact_ratio

    def require(self, drive: Drive) -> None:
        """Refuse a drive whose contact is not computed with these settings.

        Raises
        ------
        TypeError, ValueError
            Saying why: the path is none, the contact ratio is out of range, the path has no lengths to share by, or
            total rate would follow a point without a finite speed.
        """
        path = self._path_of(drive)
        if self.sharing == "centroid" and not path.has_lengths:
            raise ValueError(
                f'sharing must be "mean" or "each" for {type(path).__name__}, which has no contact lines to weight by, '
                f"got {self.sharing!r}"
            )
        if self.rate == "total":
            path.require_followable("rate = 'total'", self.sharing != "each")

    def _path_of(self, drive: Drive) -> TimedPairs:
        try:
            path = _path(self.path, drive, self.contact_ratio)
        except TypeError:
            path = None
        if not isinstance(path, TimedPairs):
            raise TypeError(
                "path must be a class of contact points (a TimedPairs, such as ContactPath) or a function of drive and "
                f"contact ratio that returns one, got {self.path!r}"
            )
        return path

    def require_one_load(self, drive: Drive, mass: float) -> None:
        """As :meth:`require`, of one load a mesh that may have a mass, which follows no contact point that jumps.

        Raises
        ------
        TypeError, ValueError
            As there, or if each pair has a load, or a mass is to follow a mean point that jumps.
        """
        path = self._path_of(drive)
        if self.sharing == "each" or (self.sharing == "centroid" and not path.has_lengths):
            means = '"centroid" or "mean"' if path.has_lengths else '"mean"'
            raise ValueError(
                f"sharing must be {means} for one load a pinion on a {type(path).__name__}, got {self.sharing!r}"
            )
        self.require(drive)
        if self.rate == "frozen" or mass == 0.0 or (self.sharing == "centroid" and not path.centroid_jumps):
            return
        ways = ['rate "frozen"']
        if self.sharing == "centroid":
            ways.insert(0, 'compliance "slice" or "plate", whose pairs take up their loads little by little')
        elif path.has_lengths and not path.centroid_jumps:
            ways.insert(0, 'sharing "centroid"')
        raise ValueError(
            f'load.mass must be 0 where a mean contact point is followed (rate "total", sharing "{self.sharing}") that '
            f"jumps as pairs take up and drop their loads, for no mass can; else take {', or '.join(ways)}; got "
            f"load.mass={mass!r}"
        )

    def places(self, drive: Drive) -> tuple[LoadPlace, ...]:
        """Place of each load against t/T0 for a pinion at angle 0, computed once for each drive.

        Parameters
        ----------
        drive : Drive

        Returns
        -------
        tuple of LoadPlace
            One load, or one for each tooth pair.
        """
        return _places(self.path, self.sharing, drive, self.contact_ratio)

    def coasting_places(self, drive: Drive) -> tuple[LoadPlace, ...]:
        """As :meth:`places`, for a pinion at angle 0 that is driven: on the other flanks of the teeth.

        Raises
        ------
        ValueError
            If the path does not say when a pair passes the pitch point.
        """
        passage = _path(self.path, drive, self.contact_ratio).pitch_passage
        return tuple(place.coasting(passage) for place in self.places(drive))

    def placed(self, places: Sequence[LoadPlace], angle: float, phase: float) -> tuple[LoadPlace, ...]:
        """Places of a pinion at an angle [rad], ahead by a phase [mesh periods], in the sense of `travel`."""
        there = (place.rotated(angle).shifted(phase) for place in places)
        return tuple(place.mirrored() for place in there) if self.sense < 0.0 else tuple(there)


CENTROID = Contact()
"""Contact as chapters 4 to 6 have it: at the centroid of the contact lines (3-21), frozen rate."""

SKEW_LINE = Contact(path=SkewLine, sharing="each", rate="total")
"""Contact as chapter 7 has it: each tooth pair on the skew line (3-22), total rate."""


@dataclass(frozen=True, eq=False)
class LoadPlace:
    """Where one load of a mesh is.

    Attributes
    ----------
    position : PiecewiseChebyshev
        r over the outer radius [-] and θ [rad] against t/T0; 0 while there is no load.
    in_contact : tuple of bool
        Whether there is a load, one for each piece.
    tolerances : ndarray, shape (pieces,)
        Relative errors that a fit along the path may have [-].
    weight : PiecewiseChebyshev, optional
        Stiffness of the load over that of a pair pressed over the whole face [-]; None: all of it.
    """

    position: PiecewiseChebyshev
    in_contact: tuple[bool, ...]
    tolerances: FloatArray
    weight: PiecewiseChebyshev | None = None

    def shape(self, vector: Callable[[FloatArray, FloatArray], FloatArray]) -> PiecewiseChebyshev:
        """Shape vector along the path, zero while there is no load.

        Parameters
        ----------
        vector : callable
            r over the outer radius (m,) and θ (m,) to the shape vector there, (m, n).

        Returns
        -------
        PiecewiseChebyshev
            n components, one series for each smooth piece of the period.
        """
        # Where there is no load the position means nothing.
        first = self.position(self.position.breakpoints[[self.in_contact.index(True)]])
        components = vector(*first.T).shape[-1]

        there = np.array(self.in_contact)

        def along(fractions: FloatArray, pieces: NDArray[np.intp]) -> FloatArray:
            found = np.zeros((*fractions.shape, components))
            on = there[pieces]
            vectors = vector(*self.position(fractions[on].ravel()).T)
            found[on] = vectors.reshape(*fractions[on].shape, components)
            return found

        return PiecewiseChebyshev.fit_together(along, self.position.breakpoints, tolerance=self.tolerances)

    def rotated(self, angle: float) -> LoadPlace:
        """Return the place ahead by a constant angle [rad]: that of a pinion elsewhere."""
        ahead = np.zeros_like(self.position.coefficients)
        ahead[:, 0, 1] = finite("angle", angle, "rad")
        moved = PiecewiseChebyshev(self.position.breakpoints, self.position.coefficients + ahead)
        return replace(self, position=moved)

    def mirrored(self) -> LoadPlace:
        """Return the place at the opposite angle: that of the other face, or of the other flank."""
        return replace(self, position=self.position.transformed(np.diag([1.0, -1.0])))

    def coasting(self, pitch_passage: float) -> LoadPlace:
        """Return the place on the other flank of the teeth, that of a pinion which is driven.

        Mirrored in the plane of both axes, which reverses the pinion, a mesh is one of the other flanks run backwards:
        r(τ) becomes r(Σ − τ). A pair of the other flanks passes the pitch point half a period away from one of these,
        since tooth and space are of one width there, so that Σ = 2τ_P + ½.

        Parameters
        ----------
        pitch_passage : float
            τ_P at which a pair passes the pitch point [mesh periods].
        """
        return self.mirrored().backwards().shifted(-(2.0 * pitch_passage + 0.5))

    def shifted(self, phase: float) -> LoadPlace:
        """Return the place ahead in time by a part of the mesh period: t ↦ t + phase T0."""
        return self._moved(lambda function: function.shift(phase))

    def backwards(self) -> LoadPlace:
        """Return the place run through in the opposite sense: t ↦ −t."""
        return self._moved(PiecewiseChebyshev.backwards)

    def _moved(self, change: Callable[[PiecewiseChebyshev], PiecewiseChebyshev]) -> LoadPlace:
        """Change the course of time, and take what is said of each piece along."""
        numbers = np.arange(len(self.in_contact), dtype=float)[:, np.newaxis, np.newaxis]
        moved = (
            change(PiecewiseChebyshev(self.position.breakpoints, numbers)).coefficients[:, 0, 0].astype(int)
        )
        return LoadPlace(
            change(self.position),
            tuple(self.in_contact[i] for i in moved),
            self.tolerances[moved],
            None if self.weight is None else change(self.weight),
        )


_Path = Callable[..., TimedPairs]


@lru_cache(maxsize=256)
def _path(kind: _Path, drive: Drive, contact_ratio: float | None) -> TimedPairs:
    return kind(drive, contact_ratio)


@lru_cache(maxsize=256)
def _places(
    kind: _Path, sharing: Sharing, drive: Drive, contact_ratio: float | None
) -> tuple[LoadPlace, ...]:
    path = _path(kind, drive, contact_ratio)
    edges = np.append(path.breakpoints, 1.0)
    middles = (edges[:-1] + edges[1:]) / 2.0
    each = sharing == "each"

    def place(load: int) -> LoadPlace:
        in_contact = tuple((middles + load < path.contact_ratio).tolist()) if each else (True,) * middles.size

        def position(fractions: FloatArray, pieces: NDArray[np.intp]) -> FloatArray:
            start, end = edges[pieces, np.newaxis], edges[pieces + 1, np.newaxis]
            local = (2.0 * fractions - start - end) / (end - start)
            states = path.pair_states_on_pieces(pieces, np.clip(local, -1.0, 1.0))
            if each:
                radius, angle = states.radius[load], states.angle[load]
                stiffness = None if states.stiffness is None else states.stiffness[load]
            else:
                stiffness = None if states.stiffness is None else states.stiffness.sum(axis=0)
                weight = states.length if sharing == "centroid" else states.in_contact.astype(float)
                weight = weight / weight.sum(axis=0)
                radius, angle = (weight * states.radius).sum(axis=0), (weight * states.angle).sum(axis=0)
            parts = [radius / drive.outer_radius, angle, *([] if stiffness is None else [stiffness])]
            return np.stack(parts, axis=-1)

        fitted = PiecewiseChebyshev.fit_together(position, path.breakpoints, tolerance=path.fit_tolerances)
        if fitted.components == 2:
            return LoadPlace(fitted, in_contact, path.fit_tolerances)
        place, weight = fitted.transformed(np.eye(3)[:2]), fitted.transformed(np.eye(3)[2:])
        return LoadPlace(place, in_contact, path.fit_tolerances, weight)

    return tuple(place(load) for load in range(path.pairs if each else 1))
