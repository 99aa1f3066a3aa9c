"""How many threads linear algebra takes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def one_thread() -> Iterator[None]:
    """Let BLAS work on one thread, in a ``with`` block or, as a decorator, in a function.

    Matrices of a drive are too small to be shared: with work going on beside, threads that wait for each other make
    thousands of them twenty times slower. Looking for the libraries takes some milliseconds, as much as a growth rate:
    it is for functions that take longer.

    Examples
    --------
    >>> import numpy as np
    >>> with one_thread():
    ...     float(np.linalg.eigvalsh(np.eye(3)).max())
    1.0
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        yield
