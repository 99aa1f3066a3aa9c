"""Errors of alignment of a rigid pinion and face gear."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from facegear.support.parameters import finite, keep

# Errors of alignment that are taken for such: [m], [rad], and how far off a pivot may be [m].
LONGEST, WIDEST, _FARTHEST = 0.1, 0.1, 100.0


@dataclass(frozen=True)
class Misalignment:
    """Position of a rigid pinion and face gear against their nominal one.

    Parameters
    ----------
    offset : float
        ΔE, displacement of the pinion's axis square to both axes [m], towards +x; for the other flank it counts the
        other way.
    gear_axial : float
        Δq, displacement of the face gear along its axis [m], positive towards the pinion.
    pinion_axial : float
        Δb, displacement of the pinion along its axis [m]; an involute cylinder does not mind.
    shaft_angle : float
        Δγ by which the shafts stand further apart [rad]: positive opens the outer end of the teeth.
    pivot : float, optional
        z_v on the pinion's axis [m], about which Δγ turns it; None where the axes meet.

    Raises
    ------
    TypeError, ValueError
        If a value is not a finite number, a length more than 0.1 m (`pivot`: 100 m), or the angle more than 0.1 rad.

    Examples
    --------
    >>> import facegear as fg
    >>> drive = fg.Drive(26, 130, 3.175e-3, shaper_teeth=28)
    >>> nominal = fg.UnloadedContact(drive)
    >>> shifted = fg.UnloadedContact(drive, fg.Misalignment(gear_axial=2e-5))
    >>> bool(shifted.backlash < nominal.backlash)
    True
    """

    offset: float = 0.0
    gear_axial: float = 0.0
    pinion_axial: float = 0.0
    shaft_angle: float = 0.0
    pivot: float | None = None

    def __post_init__(self) -> None:
        for part in fields(self):
            value = getattr(self, part.name)
            if value is not None or part.name != "pivot":
                keep(self, **{part.name: _error(part.name, value)})


def _error(name: str, value: object) -> float:
    """Check one of the fields of :class:`Misalignment`."""
    unit, most, meant = ("rad", WIDEST, "degrees") if name == "shaft_angle" else ("m", LONGEST, "mm")
    if name == "pivot":
        most = _FARTHEST
    number = finite(name, value, unit)
    if abs(number) <= most:
        return number
    smaller = math.radians(number) if meant == "degrees" else 1e-3 * number
    hint = f" (in {meant}? {name}={smaller:.4g} would be valid)" if abs(smaller) <= most else ""
    kind = "" if name == "pivot" else ", as errors of alignment are"
    raise ValueError(f"{name} must be at most {most:g} {unit} either way{kind}; got {number!r} {unit}{hint}")


ALIGNED = Misalignment()
"""Both gears where they belong."""
