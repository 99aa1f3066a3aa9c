"""Flexible teeth of a drive file: springs between each pinion and the gear, on either face, and who carries the load.

Without them a pinion follows the disk on rigid teeth, as in chapters 4 to 6 of the dissertation; with them it has a
motion of its own (chapter 8).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from facegear.geometry.drive import Drive
from facegear.mechanics.contact import Contact
from facegear.mechanics.mesh_oscillator import MeshOscillator
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.sharing import RULES, shared_load

CENTROID, COMPLIANCE = "centroid", "compliance"
SHARING = (CENTROID, *RULES, COMPLIANCE)
"""How tooth pairs may share the load."""


@dataclass(frozen=True)
class FlexibleTeeth:
    """What a drive file says of flexible teeth.

    Attributes
    ----------
    stiffness : float
        k_m of a tooth pair along the line of action [N/m].
    damping : float
        ζ_m [s].
    sharing : str
        One of `SHARING`: one load at the centre of all pairs, or a load for each pair, stiff by a rule of
        :data:`facegear.mechanics.sharing.RULES` or as the load presses it.
    sides : sequence of int
        Face of the disk that each pinion meshes with, 1 or -1; empty for all the front.
    clocking : float
        Phase of the teeth of the back face [mesh periods].
    """

    stiffness: float
    damping: float
    sharing: str
    sides: Sequence[int]
    clocking: float

    def contact(self, contact: Contact, drive: Drive) -> Contact:
        """Return one of :func:`facegear.drives.contacts.transverse_contacts` as these teeth have it, total rate.

        Raises
        ------
        ValueError
            If the teeth of the drive cannot share their load so.
        """
        allowed = (CENTROID, *RULES) if drive.has_line_contact else (CENTROID, COMPLIANCE)
        if self.sharing not in allowed:
            where = (
                "along lines" if drive.has_line_contact else "at a point, where the load shares itself out"
            )
            raise ValueError(
                f"sharing must be {' or '.join(allowed)} for contact {where}, got {self.sharing!r}"
            )
        followed = replace(contact, rate="total")
        if self.sharing == CENTROID:
            return followed
        if self.sharing == COMPLIANCE:
            return replace(followed, sharing="each")
        return replace(followed, sharing="each", path=shared_load(self.sharing, contact.path))

    def under(
        self, body: Body, load: MeshLoad, pinion_angles: Sequence[float], contact: Contact
    ) -> MeshOscillator:
        """Return the model of a disk under pinions on these teeth, with one of the contacts that :meth:`contact` makes.

        Raises
        ------
        TypeError, ValueError
            As :class:`facegear.mechanics.mesh_oscillator.MeshOscillator`.
        """
        return MeshOscillator(
            body,
            load,
            pinion_angles,
            contact,
            mesh_stiffness=self.stiffness,
            mesh_damping=self.damping,
            sides=self.sides or None,
            clocking=self.clocking,
        )
