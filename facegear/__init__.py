"""Parametric stability of face-gear drives: meshing kinematics, Floquet maps, stability-based design.

Public names are loaded on first use (PEP 562), so that `import facegear` itself costs next to nothing.
"""

from importlib import import_module
from typing import Any

# Public name -> module that defines it.
_PUBLIC = {
    # parameters
    "STEEL": "parameters",
    "Material": "parameters",
    "MeshLoad": "parameters",
    "rad_per_s": "parameters",
    "rpm": "parameters",
    "watt": "parameters",
    # geometry
    "ContactLines": "flanks",
    "Drive": "geometry",
    "PinionFlank": "flanks",
    "ToothFlank": "flanks",
    # kinematics
    "ContactPath": "kinematics",
    "SkewLine": "kinematics",
    "mesh_period": "kinematics",
    "PhaseSplit": "phases",
    "phase_split": "phases",
    # models and maps
    "WithoutRigidMotion": "models",
    "replace_parameter": "models",
    "stability_map": "maps",
    "Tongue": "tracing",
    "borders": "tracing",
    "search_seconds": "tracing",
    "tongues": "tracing",
    # plate, inplane, transverse
    "Body": "plate",
    "EdgeLoadStress": "inplane",
    "Transverse": "transverse",
    # torsional
    "Gearbox": "torsional",
    "Torsional": "torsional",
    "natural_speed": "torsional",
    # periodic, floquet
    "ContactLoad": "periodic",
    "PeriodicSystem": "periodic",
    "rigid_motions": "periodic",
    "without_rigid_motion": "periodic",
    "error_estimate": "floquet",
    "growth_rate": "floquet",
    "multiplier_errors": "floquet",
    "multipliers": "floquet",
    "transition_matrix": "floquet",
    # hsu
    "ResonanceBand": "hsu",
    "band_speeds": "hsu",
    "resonance_bands": "hsu",
    # drives of one's own
    "DriveFile": "drive_file",
    "DriveFileError": "drive_file",
    "read_drive_file": "drive_file",
    # design
    "critical_thickness": "design",
    "design_body": "design",
    "root_stress": "tooth_design",
}

__all__ = sorted(_PUBLIC)


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_PUBLIC[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_PUBLIC})
