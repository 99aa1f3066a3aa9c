"""Stiffness of a tooth as a cantilever, and of a pair of teeth (7-1, 7-2)."""

from __future__ import annotations

import math

from facegear.geometry.drive import Drive
from facegear.mechanics.properties import STEEL, Material
from facegear.support.parameters import within

# Least c_f of (7-2) that is taken for one.
_LEAST_FACTOR = 1e-6

DEDENDUM = 1.25
"""Dedendum H over addendum a_g in the model of the tooth as a cantilever (7-1)."""


def tooth_stiffness(drive: Drive, material: Material = STEEL) -> float:
    """Stiffness k_t of a tooth along the line of action, as a cantilever loaded at its tip (7-1).

    Parameters
    ----------
    drive : Drive
        Its circular pitch π m_d, addendum m_d, face width L and pressure angle.
    material : Material, optional

    Returns
    -------
    float
        E c_p³ L/(32 (a_g + H)³ cos α_c), H = 1.25 a_g [N/m].
    """
    height = (1.0 + DEDENDUM) * drive.module
    pitch = math.pi * drive.module
    modulus = material.youngs_modulus
    return modulus * pitch**3 * drive.face_width / (32.0 * height**3 * math.cos(drive.pressure_angle))


def mesh_stiffness(drive: Drive, correction_factor: float, material: Material = STEEL) -> float:
    """Average mesh stiffness k_m of a tooth pair, two teeth in series (7-2).

    Parameters
    ----------
    drive : Drive
    correction_factor : float
        c_f, from 1e-6 to 1: what gear bodies and bearings leave of the stiffness of the teeth.
    material : Material, optional

    Returns
    -------
    float
        c_f k_t/2 [N/m].

    Raises
    ------
    TypeError, ValueError
        If the factor is not a number in that range.

    Examples
    --------
    >>> import facegear as fg
    >>> f"{fg.mesh_stiffness(fg.Drive(31, 107, 3.175e-3), 0.5):.3g}"
    '1.58e+08'
    """
    return checked_factor(correction_factor) * tooth_stiffness(drive, material) / 2.0


def checked_factor(correction_factor: float) -> float:
    """Return c_f of :func:`mesh_stiffness`; errors as there."""
    hint = "what gear bodies and bearings leave of the stiffness of the teeth"
    return within("correction_factor", correction_factor, _LEAST_FACTOR, 1.0, hint=hint)
