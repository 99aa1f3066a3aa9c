"""Tongues: all intervals of speed in which a model is unstable, however narrow.

The speeds to look at come from :mod:`facegear.maps.scanning`; borders are roots of the growth between them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize.elementwise import find_root

from facegear.floquet.labels import Combination, Kind, growth_and_combination
from facegear.floquet.methods import Method
from facegear.floquet.models import Model, parameter_path, replace_parameter, require_model, system_at
from facegear.floquet.multiplier_curves import FrozenMotions, MultiplierCurve
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.rigid_motion import rigid_motions
from facegear.maps.parallel import computed, parts_of
from facegear.maps.peaks import largest_between
from facegear.maps.scanning import first_grid, scan_of
from facegear.maps.scans import SPEED_TOLERANCE, Scan
from facegear.support.parameters import ascending, finite_array, number_of_workers, within
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

_KINDS: tuple[Kind, ...] = get_args(Kind)

# A rigid-body motion drifts: its double multiplier 1 is known to the root of rounding at best.
_DRIFT = 1e-6
# Time of a search by points of its first grid and size d of the matrices, points · (least + factor · d^power) [s]:
# measured with gearboxes of 3 and 7 coordinates and disks of 5 to 84, at 200 to 600 and at 540 to 560 rpm. Pairs of
# multipliers that meet add samples, the more the larger d is.
_LEAST_SECONDS, _SECONDS, _POWER = 4e-4, 8e-8, 2.4

# Samples of speed closer than this, relative, are one where a maximum is looked for.
_APART = 1e-5


@dataclass(frozen=True)
class Tongue:
    """Interval of speed in which the growth rate is positive.

    Attributes
    ----------
    lower, upper : float
        Borders [rad/s], or ends of the range looked at.
    peak : float
        Speed of the largest growth rate [rad/s].
    growth_rate : float
        Growth rate there [1/s].
    combination : Combination
        Modes and order of the resonance at the peak.
    """

    lower: float
    upper: float
    peak: float
    growth_rate: float
    combination: Combination = field(repr=False)

    @property
    def label(self) -> str:
        """Modes and order, such as "(1+2)/1"; as :attr:`facegear.floquet.hsu.ResonanceBand.label`."""
        return self.combination.label

    @property
    def width(self) -> float:
        """Width [rad/s]."""
        return self.upper - self.lower


@dataclass(frozen=True, eq=False)
class Searched:
    """A range of speed that has been searched.

    Attributes
    ----------
    tongues : tuple of Tongue
        As :func:`tongues` has them.
    speeds, growth_rates : ndarray, shape (m,)
        Speeds looked at [rad/s], among them all at which two motions meet that could have made a tongue, and how fast
        the fastest motion grows or decays there [1/s].
    """

    tongues: tuple[Tongue, ...]
    speeds: FloatArray
    growth_rates: FloatArray

    def fastest_between(self, low: float, high: float) -> float:
        """Largest growth rate at the speeds looked at between two [1/s]; NaN if there is none."""
        inside = (self.speeds >= low) & (self.speeds <= high)
        return float(self.growth_rates[inside].max()) if inside.any() else np.nan


@dataclass(frozen=True)
class TongueSection:
    """Tongues at one value of a swept parameter."""

    value: float
    tongues: tuple[Tongue, ...]


def tongues(
    model: Model,
    speeds: ArrayLike,
    *,
    method: Method | None = None,
    threshold: float = 1e-8,
    hints: ArrayLike = (),
    progress: bool | None = None,
) -> tuple[Tongue, ...]:
    """All intervals of speed in which a model is unstable.

    Parameters
    ----------
    model : Model
        Anything with a method ``system(speed)``.
    speeds : (low, high)
        Range looked at [rad/s], as any two numbers.
    method : Method, optional
        Method of :mod:`facegear.floquet.methods`; see :func:`facegear.floquet.methods.with_method` if left out.
    threshold : float
        Growth in a period, max|λ| − 1, from which a speed counts as unstable [-]. Damping keeps stable multipliers
        clearly inside the unit circle; without damping they lie on it, and rounding alone must not look like growth.
    hints : array_like
        Further speeds [rad/s] around which to look.
    progress : bool, optional
        Show how many transition matrices have been looked at, and before that about how long it will take
        (:func:`search_seconds`); if left out, only on a terminal. An interruption (Ctrl-C) ends the search at once.

    Returns
    -------
    tuple of Tongue
        Ascending. Borders are where max|λ| − 1 passes the threshold, to a relative 1e-9 of the speed.

    Raises
    ------
    TypeError, ValueError
        If the range is empty or not positive, or a parameter is not valid, or the model has a rigid-body motion and
        the threshold is below what that leaves of a multiplier.
    ArithmeticError
        If transition matrices do not vary smoothly with speed, or are not known well enough for the threshold.

    Examples
    --------
    >>> import facegear as fg
    >>> body = fg.Body(fg.Drive(26, 130, 3.175e-3), thickness_ratio=0.03)
    >>> model = fg.Transverse(body, fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0))
    >>> for tongue in fg.tongues(model, fg.rad_per_s([545.0, 555.0])):
    ...     print(f"{tongue.label}: {fg.rpm(tongue.lower):.1f} to {fg.rpm(tongue.upper):.1f} rpm")
    (1+8)/1: 545.0 to 549.5 rpm
    """
    return searched(model, speeds, method=method, threshold=threshold, hints=hints, progress=progress).tongues


def searched(
    model: Model,
    speeds: ArrayLike,
    *,
    method: Method | None = None,
    threshold: float = 1e-8,
    hints: ArrayLike = (),
    progress: bool | None = None,
) -> Searched:
    """Search a range of speed as :func:`tongues` does, and tell how fast motions decay where there is none.

    Parameters
    ----------
    model, speeds, method, threshold, hints, progress
        As for :func:`tongues`.

    Returns
    -------
    Searched

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`tongues`.
    """
    require_model(model)
    low, high = ascending("speeds", speeds, "rad/s")
    threshold = within("threshold", threshold, 1e-12, 1e-2)
    further = finite_array("hints", hints, "rad/s")
    if further.ndim != 1:
        raise ValueError(f"hints must list speeds in rad/s, got {hints!r}")
    if threshold < _DRIFT:
        _refuse_rigid_motion(system_at(model, high))
    from tqdm.auto import tqdm

    # tqdm itself takes a notebook for a terminal.
    shown = sys.stderr.isatty() if progress is None else progress
    about = f"tongues, about {search_seconds(model, (low, high)):.0f} s" if shown else ""
    with (
        one_thread(),
        tqdm(desc=about, unit=" matrices", disable=not shown, leave=False) as bar,
    ):
        curve = MultiplierCurve.of(model, low, high, method, bar.update)
        if curve.error > threshold:
            raise ArithmeticError(
                f"multipliers are known to {curve.error:.2g} only, rounding counted, which is not enough for a "
                f"threshold of {threshold:.2g}: give a larger one, or for strong dampers a method such as "
                "facegear.floquet.radau.Radau"
            )
        scan = scan_of(curve.live, threshold, further.tolist())
        found = tuple(_tongue(model, curve.method, *run) for run in _runs(curve.live, scan, threshold))
        # The period is in inverse proportion to speed.
        periods = system_at(model, high).period * high / scan.speeds
    return Searched(found, scan.speeds, np.log(scan.radii) / periods)


def search_seconds(model: Model, speeds: ArrayLike) -> float:
    """Estimate how long :func:`tongues` takes for a model, without computing any of it.

    Parameters
    ----------
    model, speeds
        As for :func:`tongues`.

    Returns
    -------
    float
        [s] on one core of a processor of 2023; right within a factor of three or so. It goes with more than the
        square of the number of coordinates, and with the angle by which the fastest motion turns in a period.

    Examples
    --------
    >>> from facegear.mechanics.cases import FIGURES
    >>> from facegear.floquet.models import replace_parameter
    >>> small = FIGURES["4.4a"].model()
    >>> large = replace_parameter(small, "nodal_diameters", 8)
    >>> search_seconds(large, (50.0, 70.0)) > 4.0 * search_seconds(small, (50.0, 70.0))
    True
    """
    low, high = ascending("speeds", speeds, "rad/s")
    motions = FrozenMotions.of(model, 1.0 / high, 1.0 / low)
    size = 2 * system_at(model, high).size
    samples = first_grid(motions).size
    return float(samples * (_LEAST_SECONDS + _SECONDS * size**_POWER))


def _refuse_rigid_motion(system: PeriodicSystem) -> None:
    motions = rigid_motions(system)
    if motions.size == 0:
        return
    shown = "; ".join(
        ", ".join(f"{part:.3g}" for part in motion / np.abs(motion).max()) for motion in motions.T
    )
    raise ValueError(
        f"model has {motions.shape[1]} rigid-body motion(s), along ({shown}), that no spring, damper or load meets: "
        "its double multiplier 1 is known to 1e-8 at best; take it out with facegear.WithoutRigidMotion(model), which "
        "changes no other multiplier"
    )


def borders(
    model: Model,
    parameter: str,
    values: ArrayLike,
    speeds: ArrayLike,
    *,
    method: Method | None = None,
    threshold: float = 1e-8,
    jobs: int = -1,
    progress: bool | None = None,
    cache_directory: str | os.PathLike[str] | None = None,
) -> tuple[TongueSection, ...]:
    """Tongues at each of several values of a parameter, for drawing over a map.

    Parameters
    ----------
    model, speeds, method, threshold
        As for :func:`tongues`.
    parameter : str
        Name of the swept parameter, as for :func:`facegear.maps.stability_map.stability_map`.
    values : array_like, shape (V,)
        Values of the parameter.
    jobs, progress, cache_directory
        As for :func:`facegear.maps.stability_map.stability_map`; what is kept are the tongues of each value.

    Returns
    -------
    tuple of TongueSection
        One a value, in the order of `values`. Each value is searched on its own first. Tongues of its neighbours in
        `values` that it lacks are then looked for once more at their peaks.

    Raises
    ------
    TypeError, ValueError, ArithmeticError
        As :func:`tongues`, or for an unknown parameter.
    """
    array = finite_array("values", values)
    if array.ndim != 1 or array.size == 0:
        raise ValueError(f"values must list at least one value of the parameter, got shape {array.shape}")
    parameter_path(model, parameter)
    jobs = number_of_workers("jobs", jobs)
    low_high = ascending("speeds", speeds, "rad/s")
    searches = [
        _Search(replace_parameter(model, parameter, value), low_high, method, threshold)
        for value in array.tolist()
    ]

    def sections(tasks: Sequence[_Search]) -> list[tuple[Tongue, ...]]:
        tables = dict(computed(tasks, "tongue borders", jobs, progress, cache_directory))
        return [_from_table(tables[i]) for i in range(len(tasks))]

    found = sections(searches)
    missing = {i: peaks for i in range(array.size) if (peaks := _missing(found, i))}
    again = sections([replace(searches[i], hints=tuple(peaks)) for i, peaks in missing.items()])
    for i, part in zip(missing, again, strict=True):
        found[i] = part
    return tuple(TongueSection(value, part) for value, part in zip(array.tolist(), found, strict=True))


@dataclass(frozen=True)
class _Search:
    """Tongues of one model, as a task whose result is an array."""

    model: Model
    speeds: tuple[float, float]
    method: Method | None
    threshold: float
    hints: tuple[float, ...] = ()

    def content(self) -> Iterator[Any]:
        """Everything the result depends on: of the model's code, what it makes of both ends and the middle."""
        yield repr(self)
        low, high = self.speeds
        for speed in (low, (low + high) / 2.0, high):
            yield from parts_of(self.model.system(speed))

    def compute(self) -> FloatArray:
        """Borders, peak, growth rate, modes, kind and order, one row a tongue."""
        found = tongues(
            self.model,
            self.speeds,
            method=self.method,
            threshold=self.threshold,
            hints=self.hints,
            progress=False,
        )
        rows = [
            (t.lower, t.upper, t.peak, t.growth_rate, c.k, c.j, _KINDS.index(c.kind), c.order)
            for t in found
            for c in (t.combination,)
        ]
        return np.array(rows, dtype=float).reshape(-1, 8)


def _from_table(table: FloatArray) -> tuple[Tongue, ...]:
    found = []
    for *speeds, k, j, kind, order in table.tolist():
        lower, upper, peak, growth = speeds
        modes = Combination(int(k), int(j), _KINDS[int(kind)], int(order))
        found.append(Tongue(lower, upper, peak, growth, modes))
    return tuple(found)


def _missing(found: Sequence[tuple[Tongue, ...]], number: int) -> list[float]:
    """Peaks of a neighbour's tongues that have no counterpart of the same label."""
    own = {tongue.label for tongue in found[number]}
    neighbours = [found[i] for i in (number - 1, number + 1) if 0 <= i < len(found)]
    return [tongue.peak for part in neighbours for tongue in part if tongue.label not in own]


def _runs(curve: MultiplierCurve, scan: Scan, threshold: float) -> list[tuple[float, float, float]]:
    """Lower border, upper border and peak of every run of unstable samples."""
    unstable = np.concatenate([[False], scan.radii > 1.0 + threshold, [False]])
    # Samples with which runs begin, and those after their ends.
    edges = np.flatnonzero(unstable[1:] != unstable[:-1])
    speeds = np.where(edges == 0, curve.lowest_speed, curve.highest_speed)
    inner = (edges > 0) & (edges < scan.speeds.size)
    speeds[inner] = _borders(curve, scan, edges[inner], threshold)
    return [
        (lower, upper, _peak(curve, scan.some(slice(start, stop)), lower, upper))
        for (lower, upper), (start, stop) in zip(
            speeds.reshape(-1, 2).tolist(), edges.reshape(-1, 2).tolist(), strict=True
        )
    ]


def _borders(curve: MultiplierCurve, scan: Scan, places: NDArray[np.intp], threshold: float) -> FloatArray:
    """Speeds where growth passes the threshold between samples with some numbers and those before them."""
    if places.size == 0:
        return np.empty(0)
    found = find_root(
        lambda speeds: curve.spectral_radii(speeds) - 1.0 - threshold,
        (scan.speeds[places - 1], scan.speeds[places]),
        tolerances={"xatol": SPEED_TOLERANCE * curve.lowest_speed},
    )
    if not found.success.all():
        raise ArithmeticError(f"no border was found near {scan.speeds[places[~found.success]]} rad/s")
    return np.asarray(found.x, dtype=float)


def _peak(curve: MultiplierCurve, inside: Scan, lower: float, upper: float) -> float:
    """Speed of the largest growth rate of a tongue, of whose samples the tangents say where it may be."""

    def growth(speed: float) -> float:
        return float(np.log(curve.spectral_radii(np.array([speed]))[0])) * speed

    # Samples that all but coincide, apart by rounding, do not bracket a maximum.
    inside = inside.apart(_APART)
    rates = np.log(inside.radii) * inside.speeds
    best, largest = float(inside.speeds[rates.argmax()]), float(rates.max())
    ends = np.concatenate([[lower], inside.speeds, [upper]])
    bounds = _bounds(inside, ends)
    for place in np.argsort(-bounds, kind="stable").tolist():
        low, high = ends[place : place + 2].tolist()
        if bounds[place] <= largest or low >= high:
            continue
        speed, value = largest_between(growth, low, high, 1e-9 * high)
        if value > largest:
            best, largest = speed, value
    return best


def _bounds(inside: Scan, ends: FloatArray) -> FloatArray:
    """Largest growth rate, of a period of 1 rad, that tangents at samples allow between them and the ends."""
    level, step = np.log(inside.radii), np.diff(1.0 / ends)
    # From a sample towards the next one and the one before.
    ahead, back = inside.slopes * step[1:], -inside.slopes * step[:-1]
    beyond = [level[0] + max(back[0], 0.0)], [level[-1] + max(ahead[-1], 0.0)]
    left, right, rise, fall = level[:-1], level[1:], ahead[:-1], back[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        meeting = left + rise * (right + fall - left) / (rise + fall)
    # Where it rises all the way, or falls, one end is the largest.
    between = np.where(
        fall <= 0.0, right, np.where(rise <= 0.0, left, np.fmax(meeting, np.maximum(left, right)))
    )
    bounds = np.concatenate([beyond[0], between, beyond[1]])
    return np.asarray(np.nan_to_num(bounds, nan=np.inf) * ends[1:], dtype=float)


def _tongue(model: Model, method: Method, lower: float, upper: float, peak: float) -> Tongue:
    return Tongue(lower, upper, peak, *growth_and_combination(model.system(peak), method))
