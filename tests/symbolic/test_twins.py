"""The functions that computations use against the derivations that they were written from."""

import math

import mpmath
import numpy as np
import pytest
import sympy as sp

from facegear.symbolic import meshing, twins
from tools import write_twins

ALL = {twin.name: twin for twin in write_twins.twins()}
WRITTEN = {name for name, value in vars(twins).items() if getattr(value, "__module__", "") == twins.__name__}
DRAWS = 5


def test_the_derivations_are_those_that_the_twins_were_written_from():
    assert write_twins.digest() == twins.SOURCES, (
        "facegear/symbolic/twins.py is older than the derivations: run make twins"
    )
    assert set(ALL) == WRITTEN


def drawn(arguments, rng):
    """Values between 0.2 and 1.2, where every twin is defined; a shaft angle is one of those that drives have."""
    values = 0.2 + rng.random(len(arguments))
    return [
        value + 1.0 if symbol.name.startswith("gamma") else value
        for symbol, value in zip(arguments, values, strict=True)
    ]


@pytest.mark.parametrize("name", ALL)
def test_values_are_those_of_the_derivation(name):
    """Evaluated with 30 digits, which takes nothing of NumPy nor of how the twin is written."""
    twin, rng = ALL[name], np.random.default_rng(20)
    derived = twin.derivation()
    exactly = sp.lambdify(
        twin.arguments, list(derived) if isinstance(derived, sp.MatrixBase) else [derived], "mpmath"
    )
    compared = 0
    while compared < DRAWS:
        values = drawn(twin.arguments, rng)
        # The border exists where the excitation beats the damping.
        values = [*values[:2], 10.0 * values[2], values[3]] if name == "border_detunings" else values
        with mpmath.workdps(30):
            exact = [complex(value) for value in exactly(*map(mpmath.mpf, values))]
        if any(value.imag != 0.0 for value in exact):
            continue
        found = getattr(twins, name)(*values)
        found = found if isinstance(derived, sp.MatrixBase) else (found,)
        assert len(found) == len(exact)
        scale = max(map(abs, exact))
        assert [float(value) for value in found] == pytest.approx(
            [value.real for value in exact], rel=1e-12, abs=1e-14 * scale
        )
        compared += 1


@pytest.mark.parametrize("name", ALL)
def test_arrays_give_what_their_entries_give(name):
    twin, rng = ALL[name], np.random.default_rng(21)
    one, other = drawn(twin.arguments, rng), drawn(twin.arguments, rng)
    function = getattr(twins, name)
    with np.errstate(invalid="ignore"):
        together = function(*np.array([one, other]).T)
        apart = [function(*map(np.float64, values)) for values in (one, other)]
    together = together if isinstance(together, tuple) else (together,)
    apart = [value if isinstance(value, tuple) else (value,) for value in apart]
    for entry, component in enumerate(together):
        expected = [value[entry] for value in apart]
        np.testing.assert_allclose(np.broadcast_to(component, (2,)), expected, rtol=1e-14, atol=1e-14)


def test_missing_arguments_are_refused():
    twin = write_twins.Twin("f", "Equation of meshing.", meshing.equation_of_meshing, (meshing.u_s,))
    with pytest.raises(ValueError, match="must cover every symbol of f; missing"):
        write_twins.function_text(twin)


def test_what_is_written_is_python_that_computes():
    symbols = (meshing.theta_star, meshing.t)
    twin = write_twins.Twin("f", "Sum.", lambda: sp.Matrix([sp.sin(symbols[0]), 2 * symbols[1]]), symbols)
    text = write_twins.function_text(twin)
    assert text.startswith('def f(theta_star: Any, t: Any) -> Any:\n    """Sum."""\n')
    space = {"np": np, "Any": object}
    exec(text, space)
    assert space["f"](0.3, 2.0) == pytest.approx((math.sin(0.3), 4.0), rel=1e-15)
