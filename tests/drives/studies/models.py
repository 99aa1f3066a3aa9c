"""A drive that studies start from."""

from facegear.mechanics import cases
from facegear.mechanics.contact import Contact
from facegear.mechanics.edge_stiffness import DrivingForce
from facegear.mechanics.plate import Body
from facegear.mechanics.properties import MeshLoad
from facegear.mechanics.spreads import PitchPoint
from facegear.mechanics.transverse import Transverse

THREE = Transverse(
    Body(cases.CASE_2.drive, 0.05),
    MeshLoad(0.3, 2e-6, 0.7),
    pinion_angles=(0.0, 2.0, 4.0),
    contact=Contact(contact_ratio=cases.CASE_2.drive.geometric_contact_ratio),
    force=DrivingForce(3e5, 500.0, "dead", spread=PitchPoint()),
)
