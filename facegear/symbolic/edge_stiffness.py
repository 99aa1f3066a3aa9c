"""Stiffness of a disk against bending in the plane stress of a rim force, derived in SymPy (6-23, 6-26, 6-27).

Every derivation runs on first use and is cached; nothing is derived at import.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import sympy as sp

r = sp.Symbol("r", positive=True)
theta = sp.Symbol("theta", real=True)
n, q = sp.symbols("n n'", integer=True)  # nodal diameters of test and trial function
kappa = sp.Symbol("kappa", integer=True, nonzero=True)  # n′ - n
sign = sp.Symbol("s", real=True)  # (n′ - n)/k, 1 or -1
S_k, T_k, H_k = (sp.Function(name)(r) for name in ("S", "T", "H"))
R_m, R_l = sp.Function("R_m")(r), sp.Function("R_l")(r)


class StiffnessEntry(NamedTuple):
    """Entry of K_f^(k) for test function R_m e^{inθ} and trial function R_l e^{iqθ}, times ρ (6-27).

    The operator (6-23) is multiplied by the test function and integrated; derivatives of the stresses go to the test
    function by parts.
    """

    integrand: Any
    """Of ∫ dr over the disk."""
    boundary: Any
    """Taken at the rim; zero for a dead force."""


@cache
def mean_stiffness_entry() -> StiffnessEntry:
    """Entry of K_f^(0), n′ = n: the mean shear T alone."""
    return _stiffness_entry((sp.S.Zero, T_k, sp.S.Zero), sp.S.One)


@cache
def harmonic_stiffness_entry() -> StiffnessEntry:
    """Entry of K_f^(k), k ≥ 1, n′ - n = κ = sk with s = 1 or -1; all others of the harmonic vanish."""
    # sin kθ = s sin κθ, cos kθ = cos κθ
    sine, cosine = sign * sp.sin(kappa * theta), sp.cos(kappa * theta)
    return _stiffness_entry((S_k * sine, T_k * cosine, H_k * sine), sp.exp(sp.I * kappa * theta))


def _stiffness_entry(sigma: tuple[Any, Any, Any], wave: Any) -> StiffnessEntry:
    """Put a trial function into the operator (6-23), take the mean round the disk with a test function.

    Parameters
    ----------
    sigma : tuple of three expressions
        σ_rr, σ_rθ, σ_θθ.
    wave : expression
        e^{i(n′-n)θ} of the entry.
    """
    z = sp.Symbol("z", positive=True)
    trial, test = R_l * sp.exp(sp.I * q * theta), R_m * sp.exp(-sp.I * n * theta)

    def mean(expression: Any) -> Any:
        """Average round the disk: of the powers of e^{iκθ} that are left, the one without any."""
        bare = sp.expand(expression * sp.exp(-sp.I * (q - n) * theta), power_exp=False)
        powers = sp.expand(sp.powsimp(bare) * wave).rewrite(sp.exp)
        powers = sp.expand(powers).replace(sp.exp, lambda power: z ** (power / (sp.I * kappa * theta)))
        return sp.simplify(sp.expand(sp.powsimp(sp.expand(powers))).coeff(z, 0))

    slope_r, slope_theta = sp.diff(trial, r), sp.diff(trial, theta)
    flux_r = r * sigma[0] * slope_r + sigma[1] * slope_theta
    flux_theta = sigma[1] * slope_r + sigma[2] * slope_theta / r
    # -∫∫ test [∂_r flux_r + ∂_θ flux_θ] dr dθ = ∫∫ [test_r flux_r + test_θ flux_θ] dr dθ - ∫[test flux_r]_rim dθ
    bulk = sp.diff(test, r) * flux_r + sp.diff(test, theta) * flux_theta
    strong = -test * (sp.diff(flux_r, r) + sp.diff(flux_theta, theta))
    total = sp.diff(test * flux_r, r) + sp.diff(test * flux_theta, theta)
    if sp.expand(bulk - total - strong) != 0:
        raise ArithmeticError("integration by parts of (6-23) leaves a remainder")
    # No radial stress at the rim under a tangential load
    return StiffnessEntry(mean(bulk), mean((-test * flux_r).subs(S_k, 0)))
