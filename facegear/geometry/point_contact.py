"""Contact at a point: a face gear cut by a shaper with more teeth than the pinion, as long as nothing is loaded.

The path of contact is a straight line (:mod:`facegear.geometry.action_path`), and the gears turn in their exact ratio.
How the flanks part beside it and what errors of alignment do to it is here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from facegear.geometry.action_path import ActionPath
from facegear.geometry.drive import Drive
from facegear.geometry.hertz import Ellipse, contact_ellipse
from facegear.geometry.misalignment import LONGEST, WIDEST, Misalignment
from facegear.geometry.proportions import involute
from facegear.support.kinds import require_kinds
from facegear.support.parameters import finite_array, nonnegative, one_of, within
from facegear.support.types import FloatArray

# Halvings of a misalignment that leaves no contact, to say how much of it would, and digits of that.
_HALVINGS, _DIGITS = 20, 3
# What a coordinate along the face may miss its ends by, relative.
_ROUNDING = 1e-9


@dataclass(frozen=True)
class UnloadedContact(ActionPath):
    """Contact of a pinion and a face gear cut by a shaper with more teeth, without load.

    Parameters
    ----------
    drive : Drive
        Its `shaper_teeth` exceed `pinion_teeth`.
    misalignment : Misalignment
        Default: none.

    Raises
    ------
    TypeError, ValueError
        If contact is along lines, if the gears do not touch on their flanks anywhere, or only at an edge of the tooth,
        naming which.

    Examples
    --------
    >>> import facegear as fg
    >>> contact = fg.UnloadedContact(fg.Drive(26, 130, 3.175e-3, shaper_teeth=27))
    >>> round(1e3 * contact.position, 3), round(contact.contact_ratio, 6)
    (206.375, 1.557364)
    """

    def __post_init__(self) -> None:
        require_kinds(self, drive=Drive, misalignment=Misalignment)
        if self.drive.has_line_contact:
            raise ValueError(
                f"drive.shaper_teeth must exceed pinion_teeth={self.drive.pinion_teeth} for contact at a point; with "
                "as many teeth it is along lines"
            )
        fault = self.fault()
        if fault is None:
            return
        drive, aligned = self.drive, ActionPath(self.drive, self._share(0.0)).fault()
        if aligned is not None:
            raise ValueError(
                f"pinion_teeth={drive.pinion_teeth}, gear_teeth={drive.gear_teeth}, shaper_teeth={drive.shaper_teeth} "
                f"leave aligned gears no {aligned}; take other tooth numbers"
            )
        raise ValueError(f"misalignment leaves no {fault}; {self.misalignment!r}{self._hint()}")

    def _share(self, share: float) -> Misalignment:
        """Return so much of the misalignment, about the same pivot."""
        given = self.misalignment
        sizes = {
            part.name: share * getattr(given, part.name) for part in fields(given) if part.name != "pivot"
        }
        return Misalignment(**sizes, pivot=given.pivot)

    def _hint(self) -> str:
        """How much of the misalignment would leave contact, as an end of a message; none of it does."""
        possible, beyond = 0.0, 1.0
        for _ in range(_HALVINGS):
            share = 0.5 * (possible + beyond)
            touches = _touches(self.drive, self._share(share))
            possible, beyond = (share, beyond) if touches else (possible, share)
        if possible == 0.0:
            return ""
        # Downwards, so that who follows it has contact.
        digits = _DIGITS - 1 - math.floor(math.log10(possible))
        share = math.floor(possible * 10.0**digits) / 10.0**digits
        return (
            f" ({share:.{_DIGITS}g} of it would leave some)"
            if _touches(self.drive, self._share(share))
            else ""
        )

    def gap(self, position: ArrayLike) -> FloatArray:
        """Gap between the flanks along the normal, in slices along the face, the same at every rotation [m].

        Parameters
        ----------
        position : array_like
            u along the shaper's axis [m], between the ends of :attr:`face`.

        Returns
        -------
        ndarray
            Of the shape of `position`. 0 at :attr:`position`; a slice is what has one local pressure angle q.

        Raises
        ------
        TypeError, ValueError
            Not numeric, not finite, or beyond the face.
        """
        u, (low, high) = finite_array("position", position, "m"), self.face
        outside = (u < low * (1.0 - _ROUNDING)) | (u > high * (1.0 + _ROUNDING))
        if np.any(outside):
            bad = float(u[outside].flat[0])
            meant = 1e-3 * bad
            hint = f" (in mm? {meant:.6g} m would be valid)" if low <= meant <= high else ""
            raise ValueError(
                f"position must lie in [{low:.6g}, {high:.6g}] m, the coordinates u along the shaper's axis where the "
                f"flank has points; got {bad:.6g} m{hint}"
            )
        angles = np.arccos(float(self.drive.contact_region.position(0.0)) / u)
        return self.lines.offset(angles) - self.lines.offset(self.pressure_angle)

    @property
    def principal_curvatures(self) -> FloatArray:
        """Principal curvatures of the gap in the middle of the path, ascending, shape (2,) [1/m]."""
        return self.curvatures(0.5 * sum(self._rolls))

    def curvatures(self, roll: float) -> FloatArray:
        """Principal curvatures of the gap between pinion and gear about a point of the path, ascending [1/m].

        Parameters
        ----------
        roll : float
            θs of the shaper there [rad], between the two :attr:`rolls`.

        Returns
        -------
        ndarray, shape (2,)
            The smaller one is that along the face, nearly.

        Raises
        ------
        TypeError, ValueError
            `roll` is not a number, or not on the path.
        """
        roll = within("roll", roll, *self._rolls, "rad")
        return np.asarray(
            np.linalg.eigvalsh(self.lines.curvature_tensor(self.pressure_angle, roll)), dtype=float
        )

    def hertz(self, force: float, modulus: float) -> Ellipse:
        """Contact ellipse under a force, in the middle of the path.

        Parameters
        ----------
        force : float
            Along the normal [N].
        modulus : float
            E* [Pa]: 1/E* = (1 − ν1²)/E1 + (1 − ν2²)/E2.

        Returns
        -------
        Ellipse
            By Hertz: the gap is taken for a paraboloid, which hides that it is not symmetric; :meth:`marking_band`
            uses the true one.

        Raises
        ------
        TypeError, ValueError
            If an argument is not a number greater than 0, `force` is below 1e-12 N, `modulus` above 1e15 Pa, or the
            ellipse would be longer than the gear.
        """
        smaller, larger = self.principal_curvatures.tolist()
        ellipse = contact_ellipse(smaller, larger, force, modulus)
        if ellipse.long > self.drive.outer_radius:
            raise ValueError(
                f"modulus must be in Pa (some 1.1e11 for steel on steel) and force in N; with modulus={modulus!r} and "
                f"force={force!r} the contact ellipse would have a semi-axis of {ellipse.long:.3g} m, more than the "
                "gear's radius"
            )
        return ellipse

    def marking_band(self, depth: float) -> tuple[float, float]:
        """Find the band along the face where the gap is at most the thickness of marking compound.

        Parameters
        ----------
        depth : float
            Thickness [m], such as 6.35e-6.

        Returns
        -------
        inner, outer : float
            u [m], cut off at the edges of the flank as they are where the path of contact has its middle.

        Raises
        ------
        TypeError, ValueError
            If `depth` is not a number of 0 or more.
        """
        depth = nonnegative("depth", depth, "m")
        shaper, middle = self.drive.generating, self.pressure_angle
        roll = 0.5 * sum(self._rolls)
        here = float(self.lines.offset(middle))

        def excess(q: float) -> float:
            return float(self.lines.offset(q)) - here - depth

        ends = []
        for edge in (shaper.flank_start, shaper.outer_radius):
            q = self.drive.contact_region.edge_angle(edge, roll)
            ends.append(q if excess(q) <= 0.0 else float(brentq(excess, middle, q, xtol=1e-15)))
        return float(self.drive.contact_region.position(ends[0])), float(
            self.drive.contact_region.position(ends[1])
        )

    def window(self, error: str) -> tuple[float, float]:
        """Range of one error of alignment in which contact stays on the flank, all others as they are.

        Parameters
        ----------
        error : {"offset", "gear_axial", "shaft_angle"}
            Field of `misalignment` that is varied.

        Returns
        -------
        low, high : float
            Of the error, in its unit: beyond them an edge bears, or nothing. To 1e-9 of the module, or of a radian.

        Raises
        ------
        ValueError
            If there is no such error.

        Examples
        --------
        >>> low, high = UnloadedContact(Drive(26, 130, 3.175e-3, shaper_teeth=27)).window("offset")
        >>> round(1e6 * low, 1), round(1e6 * high, 1)
        (-1098.3, 265.5)
        """
        one_of("error", error, ("offset", "gear_axial", "shaft_angle"))
        start, module = getattr(self.misalignment, error), self.drive.module
        unit, most = (1.0, WIDEST) if error == "shaft_angle" else (module, min(10.0 * module, LONGEST))

        def holds(value: float) -> bool:
            return abs(value) <= most and _touches(self.drive, replace(self.misalignment, **{error: value}))

        ends = []
        for sense in (-1.0, 1.0):
            inside, outside = 0.0, 1e-6 * unit
            while holds(start + sense * outside) and outside < most:
                inside, outside = outside, 2.0 * outside
            while outside - inside > 1e-9 * unit:
                middle = 0.5 * (inside + outside)
                inside, outside = (middle, outside) if holds(start + sense * middle) else (inside, middle)
            ends.append(start + sense * inside)
        return ends[0], ends[1]

    @property
    def backlash(self) -> float:
        """Play of the teeth along the pitch circle that misalignment opens [m]; less than none if they bind.

        j = 2C (inv α − inv α'), C² = ΔE² + (B + Δq sin γ)², cos α' = B cos α/C: standard teeth have none at C = B.
        Thinning a tooth by s on the pitch circle adds s C/B. Errors of angle are left out.
        """
        offset, alpha = self.drive.axis_offset, self.drive.pressure_angle
        centre = math.hypot(
            self.misalignment.offset,
            offset + self.misalignment.gear_axial * math.sin(self.drive.shaft_angle),
        )
        working = math.acos(offset * math.cos(alpha) / centre)
        return 2.0 * centre * (involute(alpha) - involute(working))


def _touches(drive: Drive, misalignment: Misalignment) -> bool:
    """Whether a misalignment leaves contact, without the message that says why it does not."""
    return ActionPath(drive, misalignment).fault() is None
