"""A gearbox one of whose teeth is softer than the others, as a cracked one is (section 8.2).

Every time the tooth is in mesh, once a revolution of its wheel, the pair that it belongs to carries with less stiffness
and damping: the period of the equations of motion is a revolution, N2 mesh periods for a tooth of the face gear, N1 for
one of the pinion. All mesh periods but those few in which the pair is in mesh are alike, so that the transition matrix
of a revolution is a product of N matrices of which few differ. Another tooth is another place of these in the product,
which is cyclic: products that differ by that are similar matrices, with the same multipliers.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.methods import Method
from facegear.floquet.models import Coordinate
from facegear.floquet.multipliers import transition_matrices
from facegear.floquet.periodic import PeriodicSystem
from facegear.floquet.piecewise import PiecewiseChebyshev, merge_breakpoints
from facegear.mechanics.torsional import Torsional
from facegear.support.kinds import require_kind
from facegear.support.parameters import finite, integer_within, keep, nonnegative, one_of
from facegear.support.types import FloatArray

Wheel = Literal["face gear", "pinion"]

# Part of the arm by which a pair may move as its load is handed on to that of an older pair.
_HANDED_ON = 1e-9
# Less loss is not told from rounding.
_LEAST_LOSS = 1e-9


@dataclass(frozen=True)
class DamagedTooth:
    """A gearbox with a loss of stiffness of one tooth pair, once a revolution of the wheel with the damaged tooth.

    Parameters
    ----------
    torsional : Torsional
        The intact gearbox, with one load a tooth pair.
    loss : float
        Part of stiffness and damping that the pair has lost [-], at least 1e-9 and below 1.
    tooth : int
        Which tooth, from 0 to N − 1: that of the pair which comes into mesh at the start of this mesh period.
    wheel : {"face gear", "pinion"}
        Whose tooth it is.
    torque : float
        Constant torque T_o of the load, which presses the flanks [N m], 0 or greater.

    Raises
    ------
    TypeError, ValueError
        If a parameter is of the wrong kind or outside its range, or the contact does not have one load a tooth pair
        that comes into mesh as the mesh period begins.

    Examples
    --------
    >>> from facegear.mechanics.gearboxes import FIGURES
    >>> cracked = DamagedTooth(FIGURES["7.12b"].model(), loss=0.2, tooth=5)
    >>> cracked.teeth, cracked.system(70.0).period / cracked.torsional.system(70.0).period
    (107, 107.0)
    """

    torsional: Torsional
    loss: float
    tooth: int = 0
    wheel: Wheel = "face gear"
    torque: float = 0.0

    def __post_init__(self) -> None:
        require_kind("torsional", self.torsional, Torsional)
        one_of("wheel", self.wheel, ("face gear", "pinion"))
        keep(
            self,
            loss=_checked_loss(self.loss),
            tooth=integer_within("tooth", self.tooth, 0, self.teeth - 1),
            torque=nonnegative("torque", self.torque, "N m"),
        )
        self._require_pairs()

    def _require_pairs(self) -> None:
        """Refuse loads that are not handed on from pair to pair at the ends of the mesh period."""
        contact, shapes = self.torsional.contact, self.torsional.shapes
        if contact.sharing != "each":
            raise ValueError(
                f'torsional.contact must have sharing "each", one load a tooth pair, got {contact.sharing!r}'
            )
        for younger, older in pairwise(shapes):
            if np.abs(younger(0.0, "left") - older(0.0)).max() > _HANDED_ON * younger.largest:
                raise ValueError(
                    "torsional.contact must have pairs that come into mesh at the start of the mesh period, got a path "
                    "on another clock"
                )

    @property
    def teeth(self) -> int:
        """Mesh periods in a revolution of the wheel, N2 or N1."""
        drive = self.torsional.drive
        return int(drive.gear_teeth if self.wheel == "face gear" else drive.pinion_teeth)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Elastic deviation angles χ1, χ2, χo (7-9)."""
        return self.torsional.coordinates

    @property
    def damaged_periods(self) -> tuple[int, ...]:
        """Mesh periods of the revolution in which the damaged pair is in mesh."""
        return tuple((self.tooth + age) % self.teeth for age in range(len(self.torsional.shapes)))

    def pressed(self, speed: float) -> PeriodicSystem:
        """Equations of the intact gearbox under the torque, with the mesh period, at a speed [rad/s]."""
        return self.torsional.under(self.torque, speed)

    def mesh_periods(self, speed: float) -> tuple[PeriodicSystem, ...]:
        """Equations of the kinds of mesh periods: intact, then with the damaged pair youngest, next, and so on."""
        intact = self.pressed(speed)
        kinds = [intact]
        for age in range(len(intact.loads)):
            left = np.ones(len(intact.loads))
            left[age] -= self.loss
            stiffness = left * [load.stiffness for load in intact.loads]
            damping = left * [load.damping for load in intact.loads]
            kinds.append(intact.replace_loads(stiffness=stiffness, damping=damping))
        return tuple(kinds)

    def transition_matrix(self, speed: float, method: Method | None = None) -> FloatArray:
        """Transition matrix of a revolution, from those of the kinds of mesh periods, shape (6, 6).

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s].
        method : Method, optional
            As for :func:`facegear.floquet.multipliers.transition_matrices`.
        """
        intact, *damaged = transition_matrices(self.mesh_periods(speed), method)
        kinds = dict(zip(self.damaged_periods, damaged, strict=True))
        whole = np.eye(len(intact))
        for number in range(self.teeth):
            whole = kinds.get(number, intact) @ whole
        return whole

    def system(self, speed: float) -> PeriodicSystem:
        """Equations of motion over a revolution of the wheel, at a constant speed.

        Parameters
        ----------
        speed : float
            Ω2 of the face gear [rad/s], greater than 0.

        Returns
        -------
        PeriodicSystem
            Three coordinates; two loads a tooth pair of one age, the intact ones and the damaged one.

        Raises
        ------
        TypeError, ValueError
            If `speed` is not a finite number greater than 0.
        """
        whole = self.pressed(speed).repeated(self.teeth)
        loads: list[ContactLoad] = []
        for number, load in zip(self.damaged_periods, whole.loads, strict=True):
            there = _window(number, self.teeth)
            intact = PiecewiseChebyshev(there.breakpoints, 1.0 - there.coefficients)
            weights = [_product(load.weight, x) for x in (intact, there)]
            left = 1.0 - self.loss
            loads.append(dataclasses.replace(load, weight=weights[0]))
            loads.append(
                dataclasses.replace(
                    load, weight=weights[1], stiffness=left * load.stiffness, damping=left * load.damping
                )
            )
        return dataclasses.replace(whole, loads=tuple(loads))


def _checked_loss(value: object) -> float:
    loss = finite("loss", value)
    if not _LEAST_LOSS <= loss < 1.0:
        raise ValueError(
            f"loss must be at least {_LEAST_LOSS:g} and below 1, got {value!r} (a part of the stiffness of the pair; "
            "the intact gearbox is the Torsional itself)"
        )
    return loss


def _window(number: int, periods: int) -> PiecewiseChebyshev:
    """1 in one of the mesh periods of a revolution, 0 in all others."""
    starts = np.array([number, (number + 1) % periods]) / periods
    order = np.argsort(starts)
    return PiecewiseChebyshev(starts[order], np.array([1.0, 0.0])[order][:, None, None])


def _product(weight: PiecewiseChebyshev | None, window: PiecewiseChebyshev) -> PiecewiseChebyshev:
    """Weight of a load where a window is 1."""
    if weight is None:
        return window
    edges = merge_breakpoints([weight.breakpoints, window.breakpoints])
    return PiecewiseChebyshev.fit(lambda x, piece: weight(x) * window(x), edges)
