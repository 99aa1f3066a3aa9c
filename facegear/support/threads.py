"""How many threads linear algebra takes."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController


@contextmanager
def one_thread() -> Iterator[None]:
    """Let libraries of linear algebra work on one thread, in a ``with`` block or, as a decorator, in a function.

    Matrices of a drive are too small to be shared: with work going on beside, threads that wait for each other make
    thousands of them twenty times slower. As a decorator it is for functions that return, not for generators.

    Examples
    --------
    >>> import numpy as np
    >>> with one_thread():
    ...     float(np.linalg.eigvalsh(np.eye(3)).max())
    1.0
    """
    with _libraries(len(sys.modules)).limit(limits=1):
        yield


@lru_cache(maxsize=1)
def _libraries(_modules: int) -> ThreadpoolController:
    """Libraries with threads, looked for only after further modules: that takes as long as a small task."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
