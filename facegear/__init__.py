"""Parametric stability of face-gear drives: meshing kinematics, Floquet maps, stability-based design.

From a drive to its stability: teeth, body and mesh make a model, a model is a periodic system at each speed, and maps
and tongues say where that is unstable.

>>> import numpy as np
>>> import facegear as fg
>>> drive = fg.Drive(pinion_teeth=26, gear_teeth=130, module=3.175e-3)  # SI units inside
>>> body = fg.Body(drive, thickness_ratio=0.03)
>>> model = fg.Transverse(body, fg.MeshLoad(stiffness=0.6, damping=3e-6, mass=1.0))

The growth rate [1/s] at one speed of the face gear; negative is stable.

>>> bool(fg.growth_rate(model.system(fg.rad_per_s(600.0))) < 0.0)
True

A map over speed and the stiffness of the pinion's bearing, and all intervals of speed where the drive is unstable.

>>> speeds, stiffnesses = fg.rad_per_s(np.linspace(500.0, 600.0, 5)), [0.3, 0.6]
>>> chart = fg.stability_map(model, speeds, "stiffness", stiffnesses, jobs=1)
>>> chart.sizes["stiffness"], chart.sizes["speed"]
(2, 5)
>>> for tongue in fg.tongues(model, fg.rad_per_s(np.array([500.0, 600.0]))):
...     print(f"{tongue.label}: {fg.rpm(tongue.lower):.1f} to {fg.rpm(tongue.upper):.1f} rpm")
(1+8)/1: 518.6 to 549.5 rpm
(1+9)/1: 561.5 to 592.6 rpm

What is public stands in `__init__.pyi`, for editors and type checkers; it is loaded on first use (PEP 562), so that
`import facegear` itself costs next to nothing. Which package has what is said in each one's own docstring.
"""

from importlib.metadata import version

import lazy_loader

__version__ = version("facegear")

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
