"""Motions of a system that meet neither spring nor damper nor load, and what is left without them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from facegear.floquet.loads import ContactLoad
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.types import FloatArray

# Stiffness, damping and loads along a rigid-body motion, over their largest.
_RIGID = 1e-12


def rigid_motions(system: PeriodicSystem) -> FloatArray:
    """Rigid-body motions of a system: displacements r that meet neither spring nor damper nor load.

    Parameters
    ----------
    system : PeriodicSystem

    Returns
    -------
    array, shape (n, k)
        r with K r = 0, C r = 0 and φ(t)ᵀr = 0 for each load, orthonormal with the mass as weight; k = 0 for a system
        that hangs on something.
    """
    projection, root = _rigid_projection(system)
    count = round(float(np.trace(projection)))
    return np.asarray(root @ _columns(projection, count), dtype=float)


def without_rigid_motion(system: PeriodicSystem) -> PeriodicSystem:
    """Return what is left of a system when its rigid-body motions are taken out.

    With q = B y + r s, BᵀM r = 0, the equations of y hold no s, because K r, C r and φᵀr vanish: the multipliers of y
    are those of the system less two for each r, which are 1 with one eigenvector, since r s may drift. That double
    multiplier is known to the square root of rounding only, 1e-8, whatever the method. Exact for any system with
    constant mass M and loads without a mass of their own along r.

    Parameters
    ----------
    system : PeriodicSystem

    Returns
    -------
    PeriodicSystem
        Unit mass and n − k coordinates; the system itself if it has no such motion.

    Raises
    ------
    ValueError
        If nothing is left: no spring, damper or load at all; or if the state jumps.

    Examples
    --------
    >>> import numpy as np
    >>> from facegear.floquet.piecewise import PiecewiseChebyshev
    >>> spring = ContactLoad(PiecewiseChebyshev.constant([1.0, -1.0]), stiffness=3.0)
    >>> pair = PeriodicSystem(np.diag([1.0, 2.0]), np.zeros((2, 2)), np.zeros((2, 2)), (spring,), 1.0)
    >>> without_rigid_motion(pair).stiffness_matrix(0.0).round(12)
    array([[4.5]])
    """
    projection, root = _rigid_projection(system)
    count = round(float(np.trace(projection)))
    if count == 0:
        return system
    if system.jumps:
        raise ValueError(
            "system must have no jumps of the state: they need not leave a rigid-body motion alone"
        )
    if count == system.size:
        raise ValueError("system must have a spring, a damper or a load; got rigid-body motions only")
    basis = root @ _columns(np.eye(system.size) - projection, system.size - count)
    loads = tuple(replace(load, shape=load.shape.transformed(basis.T)) for load in system.loads)
    force = None if system.force is None else system.force.transformed(basis.T)
    damping, stiffness = (basis.T @ matrix @ basis for matrix in (system.damping, system.stiffness))
    unit = np.eye(basis.shape[1])
    return replace(system, mass=unit, damping=damping, stiffness=stiffness, loads=loads, force=force)


def _rigid_projection(system: PeriodicSystem) -> tuple[FloatArray, FloatArray]:
    """Projection on the rigid-body motions in coordinates Lᵀq, M = L Lᵀ, and L⁻ᵀ, which leads back to q."""
    root = np.linalg.inv(np.linalg.cholesky(system.mass)).T
    rows = [root.T @ system.stiffness @ root, root.T @ system.damping @ root]
    rows += [load.shape.coefficients.reshape(-1, system.size) @ root for load in system.loads if _acts(load)]
    sizes = [float(np.abs(row).max()) for row in rows]
    stacked = [row / size for row, size in zip(rows, sizes, strict=True) if size > 0.0]
    if not stacked:
        return np.eye(system.size), root
    _, values, vectors = np.linalg.svd(np.concatenate(stacked), full_matrices=True)
    values = np.append(values, np.zeros(system.size - values.size))
    null = vectors[values <= _RIGID * values[0]]
    return null.T @ null, root


def _acts(load: ContactLoad) -> bool:
    return load.stiffness > 0.0 or load.damping > 0.0 or load.mass > 0.0


def _columns(projection: FloatArray, count: int) -> FloatArray:
    """Orthonormal columns that span what a projection leaves, shape (n, count).

    They are taken from its own columns, the longest first, so that they change as smoothly as it does.
    """
    rest, found = projection.copy(), np.empty((len(projection), count))
    for number in range(count):
        # Rounding must not decide between columns of one length.
        lengths = np.linalg.norm(rest, axis=0).round(6)
        column = rest[:, int(lengths.argmax())]
        found[:, number] = column / np.linalg.norm(column)
        rest = rest - np.outer(found[:, number], found[:, number] @ rest)
    return found
