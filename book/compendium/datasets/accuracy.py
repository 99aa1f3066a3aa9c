"""Arrays of chapter 2's figures on the accuracy of transition matrices, with their tolerances."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from facegear.floquet import error_estimates
from facegear.floquet import multipliers as floquet
from facegear.floquet.methods import AlignedStepwise, Collocation, Magnus, Method, Stepwise
from facegear.floquet.periodic import PeriodicSystem
from facegear.support.labelled import text, variable
from facegear.support.types import FloatArray

_error = partial(variable, units="1", rtol=1e-5, atol=1e-11)


def integrated_transition_matrix(system: PeriodicSystem) -> FloatArray:
    """Transition matrix by numerical integration (2-6): SciPy's DOP853 from breakpoint to breakpoint.

    Parameters
    ----------
    system : PeriodicSystem
        Without velocity kicks.

    Returns
    -------
    array, shape (2n, 2n)
        In the state (q, q̇), to about 1e-12.
    """
    size = 2 * system.size
    matrix = np.eye(size)
    edges = np.append(system.breakpoints, 1.0)
    for start, stop in pairwise(edges):
        # The instants asked for are inside the piece; at its ends the limit from inside is meant.
        low, high = start + 1e-12, stop - 2e-12

        def rate(fraction: float, flat: FloatArray, low: float = low, high: float = high) -> FloatArray:
            state_matrix = system.state_matrix(np.clip(fraction, low, high))
            return np.asarray((system.period * state_matrix @ flat.reshape(size, size)).ravel())

        solution = solve_ivp(
            rate, (start, stop), matrix.ravel(), method="DOP853", rtol=1e-13, atol=1e-14, max_step=0.05
        )
        matrix = solution.y[:, -1].reshape(size, size)
    return matrix


def convergence(system: PeriodicSystem, sub_intervals: Sequence[int], description: str) -> xr.Dataset:
    """Errors of the transition matrix by each method, the truth being a numerical integration.

    Parameters
    ----------
    system : PeriodicSystem
    sub_intervals : sequence of int
        Q.
    description : str
        Parameters of the system, for the provenance.

    Returns
    -------
    xarray.Dataset
        ``uniform``, ``aligned``, ``magnus`` over ``sub_intervals``, and ``collocation``: largest error of an entry
        of Φ over the largest entry.
    """
    truth = integrated_transition_matrix(system)

    def error(method: Method) -> float:
        wrong = floquet.transition_matrix(system, method) - truth
        return float(np.abs(wrong).max() / np.abs(truth).max())

    methods: dict[str, tuple[Callable[[int], Method], str]] = {
        "uniform": (Stepwise, "Stepwise, equal sub-intervals (2-11)"),
        "aligned": (AlignedStepwise, "Stepwise, aligned sub-intervals"),
        "magnus": (Magnus, "Magnus, aligned sub-intervals"),
    }
    arrays = {
        name: _error("sub_intervals", [error(method(int(q))) for q in sub_intervals], sentence)
        for name, (method, sentence) in methods.items()
    }
    arrays["collocation"] = _error((), error(Collocation()), "Contact-force collocation")
    return xr.Dataset(
        arrays, coords={"sub_intervals": list(sub_intervals)}, attrs={"parameters": description}
    )


def doubling(system: PeriodicSystem, first: int, doublings: int, description: str) -> xr.Dataset:
    """Compute what a user sees who doubles the number of equal sub-intervals, and what the error really is.

    Parameters
    ----------
    system : PeriodicSystem
    first : int
        Smallest Q.
    doublings : int
        How often it is doubled.
    description : str
        Parameters of the system, for the provenance.

    Returns
    -------
    xarray.Dataset
        ``error`` over ``sub_intervals``; ``change`` from half as many, NaN for the first; both as in
        :func:`convergence`. ``aligned_error`` with aligned sub-intervals.
    """
    truth = integrated_transition_matrix(system)
    size = np.abs(truth).max()
    counts = [first * 2**k for k in range(doublings + 1)]
    matrices = np.array([floquet.transition_matrix(system, Stepwise(q)) for q in counts])
    aligned = np.array([floquet.transition_matrix(system, AlignedStepwise(q)) for q in counts])
    change = np.abs(np.diff(matrices, axis=0)).max(axis=(1, 2)) / size
    return xr.Dataset(
        {
            "error": _error("sub_intervals", np.abs(matrices - truth).max(axis=(1, 2)) / size, "True error"),
            "change": _error("sub_intervals", np.append(np.nan, change), "Change from half as many"),
            "aligned_error": _error(
                "sub_intervals", np.abs(aligned - truth).max(axis=(1, 2)) / size, "True error, aligned"
            ),
        },
        coords={"sub_intervals": counts},
        attrs={"parameters": description},
    )


def estimates(system: PeriodicSystem, methods: Sequence[tuple[str, Method]], description: str) -> xr.Dataset:
    """Error estimate of the spectral radius beside its true error, for several methods.

    Parameters
    ----------
    system : PeriodicSystem
    methods : sequence of (str, Method)
        Label and method; a label may occur several times.
    description : str
        Parameters of the system, for the provenance.

    Returns
    -------
    xarray.Dataset
        ``estimate`` and ``error`` over ``case``; the labels are in the coordinate ``method``.
    """
    truth = np.linalg.eigvals(integrated_transition_matrix(system))
    radius = np.abs(truth).max()
    found = [np.abs(floquet.multipliers(system, method)[0]) for _, method in methods]
    return xr.Dataset(
        {
            "estimate": _error(
                "case",
                [error_estimates.error_estimate(system, method) for _, method in methods],
                "Error estimate",
            ),
            "error": _error("case", np.abs(np.array(found) - radius), "True error of the spectral radius"),
        },
        coords={
            "case": np.arange(len(methods)),
            "method": text("case", [label for label, _ in methods], "Label of the method"),
        },
        attrs={"parameters": description},
    )
