"""Vectors as three components, numbers or arrays of one shape: stacked, they would take longer to stack than to use."""

from __future__ import annotations

from typing import Any

import numpy as np

from facegear.support.types import FloatArray

Vector = tuple[Any, Any, Any]
"""Components x, y, z."""


def dot(one: Vector, other: Vector) -> Any:
    """Product of two vectors that is a number."""
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def cross(one: Vector, other: Vector) -> Vector:
    """Product of two vectors that is square to both."""
    (a, b, c), (x, y, z) = one, other
    return b * z - c * y, c * x - a * z, a * y - b * x


def rotated(vector: Vector, axis: Vector, angle: FloatArray) -> Vector:
    """Rotate a vector about a unit axis (Rodrigues)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    along = dot(vector, axis) * (1.0 - cosine)
    x, y, z = (
        own * cosine + square * sine + along * part
        for own, square, part in zip(vector, cross(axis, vector), axis, strict=True)
    )
    return x, y, z
