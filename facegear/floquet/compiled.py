"""Code that Numba compiles, where it can."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, wraps
from types import ModuleType

#: Matrices that compiled code takes in lockstep; a batch of one more costs as much as one of twice as many.
LANES = 32


def where_compiled(load: Callable[[], ModuleType]) -> Callable[[], ModuleType | None]:
    """Let a function that imports compiled code return None where that cannot be had; it is called once.

    There may be no Numba for this NumPy, one that is told not to compile, or no place to keep its work.
    """

    @cache
    @wraps(load)
    def loaded() -> ModuleType | None:
        try:
            return load()
        except (ImportError, RuntimeError):
            return None

    return loaded
