"""Results of two computations that should be the same, compared as rounding allows."""

from dataclasses import fields, is_dataclass

import pytest


def agree(result, expected, rel):
    """Whether two results agree: numbers to a relative tolerance, all else exactly, inside tuples and dataclasses too.

    Two ways through a computation may batch their matrices in another way, or run on another number of threads; their
    last digits then depend on the processor.
    """
    if is_dataclass(expected):
        parts = [field.name for field in fields(expected)]
        return type(result) is type(expected) and all(
            agree(getattr(result, part), getattr(expected, part), rel) for part in parts
        )
    if isinstance(expected, tuple | list):
        return len(result) == len(expected) and all(map(agree, result, expected, [rel] * len(expected)))
    if isinstance(expected, float):
        return result == pytest.approx(expected, rel=rel, abs=0.0, nan_ok=True)
    return result == expected
