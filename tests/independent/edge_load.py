"""Stress under a force at the rim, and K_f, written from (6-2), (6-3), (6-26) and (6-27) without the package.

The field of a harmonic comes from the two equations of second order in the displacements, shot from the bore by
DOP853, or, at rest, from their power solutions x^p by mpmath. K_f is that of the text, entry by entry, in complex
exponentials.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import mpmath
import numpy as np
from scipy.integrate import solve_ivp

from tests.independent.complex_galerkin import ComplexDisk


def shot(
    k: int, spin: float, nu: float, c: float, x: np.ndarray, load: tuple[float, float] = (0.0, 1.0)
) -> np.ndarray:
    """S, T, H at radii x, shape (3, len(x)), for S and T at the rim; steady part of (6-2), (6-3)."""

    def rates(r: float, y: np.ndarray) -> np.ndarray:
        U, V, dU, dV = y
        inertia_r = spin**2 * (-(k**2) * U + 2 * k * V - U)
        inertia_t = spin**2 * (-(k**2) * V + 2 * k * U - V)
        ddU = (1 - nu**2) * inertia_r - (
            dU / r
            - U / r**2
            - (1 - nu) / 2 * k**2 * U / r**2
            - (1 + nu) / 2 * k * dV / r
            + (3 - nu) / 2 * k * V / r**2
        )
        ddV = (1 - nu**2) * inertia_t - (
            (1 + nu) / 2 * k * dU / r
            + (3 - nu) / 2 * k * U / r**2
            + (1 - nu) / 2 * (dV / r - V / r**2)
            - k**2 * V / r**2
        )
        return np.array([dU, dV, ddU, ddV / ((1 - nu) / 2)])

    def stresses(r: np.ndarray, y: np.ndarray) -> np.ndarray:
        U, V, dU, dV = y
        hoop = (U - k * V) / r
        return np.array(
            [
                (dU + nu * hoop) / (1 - nu**2),
                (k * U / r + dV - V / r) / (2 * (1 + nu)),
                (hoop + nu * dU) / (1 - nu**2),
            ]
        )

    places = np.unique(np.append(x, 1.0))
    runs = []
    for start in ((0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)):
        run = solve_ivp(rates, (c, 1.0), start, method="DOP853", rtol=1e-13, atol=1e-13, t_eval=places)
        assert run.success, run.message
        runs.append(stresses(places, run.y))
    at_rim = np.array([[run[0, -1] for run in runs], [run[1, -1] for run in runs]])
    factors = np.linalg.solve(at_rim, load)
    total = factors[0] * runs[0] + factors[1] * runs[1]
    return total[:, np.searchsorted(places, x)]


@cache
def _at_rest(k: int, nu: float, c: float, load: tuple[int, int]) -> tuple:
    """Exponents, displacements and factors of the power solutions for k of 2 or more; load is (S, T) at the rim."""
    mpmath.mp.dps = 60 + 2 * k
    nu, c = mpmath.mpf(nu), mpmath.mpf(c)
    terms = []
    for p in (k + 1, k - 1, -k - 1, -k + 1):
        # First equation on (u, v) x^p
        u = -(-(1 + nu) / 2 * k * p + (3 - nu) / 2 * k)
        v = mpmath.mpf(p * p - 1) - (1 - nu) / 2 * k * k
        second = (1 + nu) / 2 * k * p * u + (3 - nu) / 2 * k * u + (1 - nu) / 2 * (p * p - 1) * v - k * k * v
        assert abs(second) < mpmath.mpf(10) ** -45 * k**4, "x^p must solve both equations"
        terms.append((p, u, v))

    def parts(x, p, u, v):
        hoop, slope = (u - k * v), p * u
        scale = x ** (p - 1)
        return (
            u * x**p,
            v * x**p,
            scale * (slope + nu * hoop) / (1 - nu**2),
            scale * (k * u + (p - 1) * v) / (2 * (1 + nu)),
            scale * (hoop + nu * slope) / (1 - nu**2),
        )

    bore, rim = [parts(c, *term) for term in terms], [parts(mpmath.mpf(1), *term) for term in terms]
    matrix = mpmath.matrix(
        [[b[0] for b in bore], [b[1] for b in bore], [q[2] for q in rim], [q[3] for q in rim]]
    )
    factors = mpmath.lu_solve(matrix, mpmath.matrix([0, 0, *load]))
    return terms, factors, parts


def at_rest(k: int, nu: float, c: float, x: float, load: tuple[int, int] = (0, 1)) -> np.ndarray:
    """S, T, H at one radius at rest, k of 2 or more, for unit σ_rr (1, 0) or σ_rθ (0, 1) at the rim."""
    terms, factors, parts = _at_rest(k, nu, c, load)
    mpmath.mp.dps = 60 + 2 * k
    values = [parts(mpmath.mpf(x), *term) for term in terms]
    return np.array(
        [float(sum(f * v[2 + i] for f, v in zip(factors, values, strict=True))) for i in range(3)]
    )


@dataclass(frozen=True, eq=False)
class LoadedDisk(ComplexDisk):
    """The disk with a tangential follower force [N] at θ = 0 of the rim, harmonics k = 0 ... K."""

    force: float = 0.0
    harmonics: int = 5

    def _field(self, speed: float, r: np.ndarray) -> list[np.ndarray]:
        """σ^(k) [Pa] at radii, the rim last."""
        spin = speed * self.a * np.sqrt(self.rho / self.E)
        x = np.append(r, self.a) / self.a
        mean = self.force / (2 * np.pi * self.a * self.h)
        order = np.argsort(x)
        found = []
        for k in range(self.harmonics + 1):
            values = np.empty((3, x.size))
            values[:, order] = shot(k, spin, self.nu, self.b / self.a, x[order])
            found.append(values * mean * (2 if k else 1))
        return found

    def load_stiffness(self, speed: float) -> np.ndarray:
        """K_f of (6-26), (6-27)."""
        nodes, weights = np.polynomial.legendre.leggauss(60)
        r = (self.a + self.b) / 2 + (self.a - self.b) / 2 * nodes
        weights = (self.a - self.b) / 2 * weights
        stress = self._field(speed, r)
        s = np.log(r)
        R, dR, rim = {}, {}, {}
        for n in range(self.N + 1):
            for m in range(self.M + 1):
                series = self._series(m, n)
                R[m, n], dR[m, n] = series(s), series.deriv()(s) / r
                rim[m, n] = float(series(np.log(self.a)))
        pairs = [(m, n) for n in self.waves for m in range(self.M + 1)]
        K = np.zeros((len(pairs), len(pairs)), dtype=complex)
        for i, (m1, n) in enumerate(pairs):
            for j, (m2, q) in enumerate(pairs):
                k = abs(q - n)
                if k > self.harmonics:
                    continue
                S, T, H = (part[:-1] for part in stress[k])
                T_a = stress[k][1, -1]
                f, df, f_a = R[m1, abs(n)], dR[m1, abs(n)], rim[m1, abs(n)]
                g, dg, g_a = R[m2, abs(q)], dR[m2, abs(q)], rim[m2, abs(q)]
                shear = q * T * df * g - n * T * f * dg
                if k == 0:
                    K[i, j] = -1j * q * T_a * f_a * g_a + 1j * np.sum(weights * shear)
                else:
                    sign = (q - n) / k
                    others = sign * r * S * df * dg + sign * n * q / r * H * f * g
                    K[i, j] = -0.5j * q * T_a * f_a * g_a + 0.5j * np.sum(weights * (shear + others))
        return K / self.rho

    def constant_matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M0, C0 and K0 + K_f of (6-25)."""
        M0, C0, K0 = super().constant_matrices(speed)
        return M0, C0, K0 + self.load_stiffness(speed)

    def growth_alone(self, speed: float) -> float:
        """Largest real part of the eigenvalues of the disk without a pinion."""
        M0, C0, K0 = self.constant_matrices(speed)
        zero, one = np.zeros_like(M0), np.eye(len(M0))
        return float(np.linalg.eigvals(np.block([[zero, one], [-K0, -C0]])).real.max())
