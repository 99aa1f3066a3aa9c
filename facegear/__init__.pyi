from .design.body import critical_thickness as critical_thickness
from .drives.assess import assess as assess
from .drives.drive_file import read_drive_file as read_drive_file
from .drives.drive_text import write_drive_file as write_drive_file
from .floquet.error_estimates import error_estimate as error_estimate
from .floquet.hsu import resonance_bands as resonance_bands
from .floquet.loads import ContactLoad as ContactLoad
from .floquet.loads import StateJump as StateJump
from .floquet.models import replace_parameter as replace_parameter
from .floquet.modified_models import Excited as Excited
from .floquet.modified_models import WithoutRigidMotion as WithoutRigidMotion
from .floquet.multipliers import growth_rate as growth_rate
from .floquet.multipliers import multipliers as multipliers
from .floquet.multipliers import transition_matrix as transition_matrix
from .floquet.periodic import PeriodicSystem as PeriodicSystem
from .floquet.piecewise import PiecewiseChebyshev as PiecewiseChebyshev
from .floquet.response import steady_response as steady_response
from .geometry.drive import Drive as Drive
from .geometry.kinematics import ContactPath as ContactPath
from .geometry.misalignment import Misalignment as Misalignment
from .geometry.phases import phase_split as phase_split
from .geometry.point_contact import UnloadedContact as UnloadedContact
from .geometry.skew_line import SkewLine as SkewLine
from .maps.campbell import campbell as campbell
from .maps.campbell import mode_shapes as mode_shapes
from .maps.response_map import frequency_response as frequency_response
from .maps.response_map import response_map as response_map
from .maps.stability_map import stability_map as stability_map
from .maps.tracing import tongues as tongues
from .mechanics.contact import Contact as Contact
from .mechanics.edge_stiffness import DrivingForce as DrivingForce
from .mechanics.inplane import EdgeLoadStress as EdgeLoadStress
from .mechanics.loaded_contact import LoadedContact as LoadedContact
from .mechanics.mesh_oscillator import MeshOscillator as MeshOscillator
from .mechanics.paths import line_contact as line_contact
from .mechanics.paths import loaded_contact as loaded_contact
from .mechanics.paths import point_contact as point_contact
from .mechanics.plate import Body as Body
from .mechanics.properties import STEEL as STEEL
from .mechanics.properties import MeshLoad as MeshLoad
from .mechanics.sharing import shared_load as shared_load
from .mechanics.tooth_stiffness import mesh_stiffness as mesh_stiffness
from .mechanics.torsional import Gearbox as Gearbox
from .mechanics.torsional import Torsional as Torsional
from .mechanics.transverse import Transverse as Transverse
from .mechanics.two_gears import TwoGears as TwoGears
from .support.parameters import rad_per_s as rad_per_s
from .support.parameters import rpm as rpm
from .support.parameters import watt as watt

__version__: str

__all__ = [
    "STEEL",
    "Body",
    "Contact",
    "ContactLoad",
    "ContactPath",
    "Drive",
    "DrivingForce",
    "EdgeLoadStress",
    "Excited",
    "Gearbox",
    "LoadedContact",
    "MeshLoad",
    "MeshOscillator",
    "Misalignment",
    "PeriodicSystem",
    "PiecewiseChebyshev",
    "SkewLine",
    "StateJump",
    "Torsional",
    "Transverse",
    "TwoGears",
    "UnloadedContact",
    "WithoutRigidMotion",
    "assess",
    "campbell",
    "critical_thickness",
    "error_estimate",
    "frequency_response",
    "growth_rate",
    "line_contact",
    "loaded_contact",
    "mesh_stiffness",
    "mode_shapes",
    "multipliers",
    "phase_split",
    "point_contact",
    "rad_per_s",
    "read_drive_file",
    "replace_parameter",
    "resonance_bands",
    "response_map",
    "rpm",
    "shared_load",
    "stability_map",
    "steady_response",
    "tongues",
    "transition_matrix",
    "watt",
    "write_drive_file",
]
