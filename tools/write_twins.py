"""Write `facegear/symbolic/twins.py`: the derivations that computations need, as NumPy functions.

Deriving takes SymPy and seconds, in every process; what comes out depends on the text of the derivations alone. So the
functions are kept in the package, with a digest of that text. A test says when they are to be written anew, and
compares them with what is derived.
"""

import hashlib
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import sympy as sp
from sympy.printing.numpy import NumPyPrinter

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from facegear.symbolic import hsu  # noqa: E402
from facegear.symbolic import meshing as m  # noqa: E402

SYMBOLIC = ROOT / "facegear" / "symbolic"
TARGET = SYMBOLIC / "twins.py"
SOURCES = (SYMBOLIC / "hsu.py", SYMBOLIC / "meshing.py", Path(__file__))
HEADER = '''"""NumPy twins of the derivations; written by `make twins`, not by hand.

Each takes numbers or arrays that broadcast, and returns a value for an expression and a tuple of values, row by row,
for a vector or a matrix. Nothing here needs SymPy.
"""

from typing import Any

import numpy as np

SOURCES = "{digest}"
"""Digest of the derivations that this was written from."""
'''


class Twin(NamedTuple):
    """A derivation whose result is wanted as a NumPy function of some symbols, in this order."""

    name: str
    says: str
    derivation: Callable[[], Any]
    arguments: tuple[sp.Symbol, ...]


def _meshing() -> Iterator[Twin]:
    """Twins that drives are computed with (chapter 3)."""
    at_point = (m.alpha, m.theta_s, m.r_bs, m.m_2s, m.gamma)
    table = {
        m.space_half_angle: (m.N_s, m.alpha_c),
        m.shaper_surface: (m.u_s, m.theta_s, m.theta_0s, m.r_bs),
        m.shaper_normal: (m.theta_s, m.theta_0s),
        m.rotation_2s: (m.phi_s, m.phi_2, m.gamma_m),
        m.rotation_2p: (m.phi_2,),
        m.undercut_condition: (m.t, m.p, m.q, m.theta_star),
        m.undercut_coefficients: (m.p, m.q, m.theta_star),
        m.inner_limit: (m.t, m.p, m.q, m.r_bs, m.r_ds, m.gamma),
        m.pointing_cone_angle_cotangent: (m.m_2s, m.gamma),
        m.pointing_condition: (m.alpha, m.theta_0s, m.r_top, m.r_bs),
        m.outer_limit: (m.alpha, m.r_bs, m.r_top, m.m_2s, m.gamma),
        m.contact_point: at_point,
        m.returned_point: (m.alpha, m.theta_s, m.delta, m.r_bs, m.m_2s, m.gamma),
        m.contact_line_speed: at_point,
    }
    for derivation, arguments in table.items():
        yield Twin(derivation.__name__, (derivation.__doc__ or "").split("\n")[0], derivation, arguments)


def _hsu() -> Iterator[Twin]:
    """Twins of Hsu's criterion (chapter 2)."""
    for kind, number in {"sum": "2-27", "difference": "2-28", "single": "2-27"}.items():
        says = f"Growth rate σ of Hsu's method [1/s] (2-26, {number})."
        yield Twin(f"growth_rate_{kind}", says, lambda k=kind: hsu.derive(k).growth_rate, hsu.arguments(kind))
    says = "Lower and upper detuning Λ at which the growth rate vanishes [rad/s]; NaN if stable."
    symbols = (hsu.DAMPING["k"], hsu.DAMPING["j"], hsu.PRODUCT_REAL, hsu.PRODUCT_IMAG)
    yield Twin("border_detunings", says, lambda: sp.Matrix(hsu.border_detunings()), symbols)


def twins() -> tuple[Twin, ...]:
    """Return all that is written, in order."""
    return (*_meshing(), *_hsu())


def argument_name(symbol: sp.Symbol) -> str:
    """Name of a symbol in Python: `theta_star` for theta_s__*, `f0_kk` for f^0_kk."""
    return re.sub(r"\W", "", symbol.name.replace("_s__*", "_star"))


def function_text(twin: Twin) -> str:
    """Return the text of one function, with common parts computed once.

    Raises
    ------
    ValueError
        If the result of the derivation has other symbols than the arguments.
    """
    result = twin.derivation()
    unknown = result.free_symbols - set(twin.arguments)
    if unknown:
        raise ValueError(f"arguments must cover every symbol of {twin.name}; missing {unknown}")
    names = {symbol: sp.Symbol(argument_name(symbol), **symbol.assumptions0) for symbol in twin.arguments}
    printer = NumPyPrinter({"fully_qualified_modules": True})

    def printed(expression: Any) -> str:
        text: str = printer.doprint(expression.xreplace(names))
        return text.replace("numpy.", "np.")

    is_matrix = isinstance(result, sp.MatrixBase)
    parts, components = sp.cse(list(result) if is_matrix else [result], list=False)
    lines = [f"{printed(name)} = {printed(part)}" for name, part in parts]
    values = ", ".join(map(printed, components))
    lines.append(f"return ({values})" if is_matrix else f"return {values}")
    arguments = ", ".join(f"{name}: Any" for name in names.values())
    body = "\n".join(f"    {line}" for line in lines)
    return f'def {twin.name}({arguments}) -> Any:\n    """{twin.says}"""\n{body}\n'


def digest() -> str:
    """SHA-256 of the text of the derivations, whatever the ends of lines of a checkout."""
    text = "\0".join(path.read_text(encoding="utf-8") for path in SOURCES)
    return hashlib.sha256(text.encode()).hexdigest()


def module_text() -> str:
    """Return the text of the module."""
    functions = "\n\n".join(function_text(twin) for twin in twins())
    raw = f"{HEADER.format(digest=digest())}\n\n{functions}"
    command = [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(TARGET), "-"]
    return subprocess.run(
        command, input=raw, capture_output=True, text=True, encoding="utf-8", check=True
    ).stdout


if __name__ == "__main__":
    TARGET.write_text(module_text(), encoding="utf-8", newline="\n")
