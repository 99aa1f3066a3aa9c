"""Stress under forces inside a disk, and K_f, written from (6-2), (6-3) and (6-23) without the package.

The field of a harmonic comes from the two equations of second order in the displacements with a body force, in complex
amplitudes, shot from the bore by DOP853: a particular solution and two of the equations without force. K_f is the work
of these stresses on the slopes, and of the tilting body force on the deflection.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from tests.independent.edge_load import LoadedDisk

ACROSS = np.polynomial.legendre.leggauss(7)


@dataclass(frozen=True)
class Press:
    """Forces whose moment is that of 1 N at the rim: shares of it at angles, on a strip or on circles.

    Attributes
    ----------
    angles, shares : arrays
        Of the teeth, from the pinion's axis.
    strip : tuple of float
        Ends x1, x2 of the face, over which a tooth presses with the same moment everywhere; or x0 twice for a circle.
    thickness : float
        Of a root, over a.
    """

    angles: tuple[float, ...] = (0.0,)
    shares: tuple[float, ...] = (1.0,)
    strip: tuple[float, float] = (1.0, 1.0)
    thickness: float = 0.0

    def waves(self, k: int, x: float) -> tuple[complex, complex]:
        """Mean over teeth and root of e^{-ikθ} and i tan θ e^{-ikθ}."""
        nodes, weights = ACROSS if self.thickness else (np.zeros(1), 2 * np.ones(1))
        theta = np.add.outer(np.array(self.angles), self.thickness / (2 * x) * nodes)
        mean = np.multiply.outer(np.array(self.shares), weights / 2)
        turned = np.exp(-1j * k * theta)
        return complex((mean * turned).sum()), complex((1j * np.tan(theta) * mean * turned).sum())

    def density(self, k: int, x: float) -> tuple[complex, complex]:
        """Amplitudes of f_θ and, for sin, of f_r, over 1 N/(πa²): dϖ/(x² dx) each."""
        tangential, radial = self.waves(k, x)
        scale = (1.0 if k else 0.5) / (x**2 * (self.strip[1] - self.strip[0]))
        return tangential * scale, radial * scale


def stresses(k: int, spin: float, nu: float, c: float, press: Press, x: np.ndarray) -> np.ndarray:
    """S, T, H at ascending radii over 1 N/(πah), complex amplitudes of -i e^{ikθ}, e^{ikθ}, -i e^{ikθ}; (3, len(x))."""
    low, high = press.strip
    circle = low == high

    def rates(r, y, loaded):
        U, V, dU, dV = y
        tangential, radial = press.density(k, r) if loaded else (0.0, 0.0)
        inertia_r = spin**2 * (-(k**2) * U + 2 * k * V - U) - radial
        inertia_t = spin**2 * (-(k**2) * V + 2 * k * U - V) - tangential
        in_r = dU / r - U / r**2 - (1 - nu) / 2 * k**2 * U / r**2 - (1 + nu) / 2 * k * dV / r
        in_t = (1 + nu) / 2 * k * dU / r + (3 - nu) / 2 * k * U / r**2 + (1 - nu) / 2 * (dV / r - V / r**2)
        ddU = (1 - nu**2) * inertia_r - in_r - (3 - nu) / 2 * k * V / r**2
        ddV = ((1 - nu**2) * inertia_t - in_t + k**2 * V / r**2) / ((1 - nu) / 2)
        return np.array([dU, dV, ddU, ddV])

    def parts(r, y):
        U, V, dU, dV = y
        hoop = (U - k * V) / r
        return np.array(
            [
                (dU + nu * hoop) / (1 - nu**2),
                (k * U / r + dV - V / r) / (2 * (1 + nu)),
                (hoop + nu * dU) / (1 - nu**2),
            ]
        )

    def run(start, force):
        y, found = np.array(start, dtype=complex), []
        for part, (begin, end) in enumerate(((c, low), (low, high), (high, 1.0))):
            loaded = force and part == 1
            if circle and loaded:
                tangential, radial = press.waves(k, low)
                scale = (1.0 if k else 0.5) / low**2
                y = y - scale * np.array([0, 0, (1 - nu**2) * radial, 2 * (1 + nu) * tangential])
            if begin == end:
                continue
            here = x[(x > begin) & (x <= end)]
            places = np.unique(np.append(here, end))
            step = solve_ivp(rates, (begin, end), y, "DOP853", places, rtol=1e-11, atol=1e-12, args=(loaded,))
            assert step.success, step.message
            found.append(parts(here, step.y[:, np.searchsorted(places, here)]))
            y = step.y[:, -1]
        return np.concatenate(found, axis=1), parts(1.0, y)[:2]

    forced, first, second = (
        run((0, 0, 0, 0), True),
        run((0, 0, 1, 0), False),
        run((0, 0, 0, 1), False),
    )
    factors = np.linalg.solve(np.stack([first[1], second[1]], axis=1), -forced[1])
    return forced[0] + factors[0] * first[0] + factors[1] * second[0]


@dataclass(frozen=True, eq=False)
class PressedDisk(LoadedDisk):
    """The disk with forces inside; `force` [N] is that at the rim with their moment."""

    press: Press = field(default_factory=Press)

    def load_stiffness(self, speed: float) -> np.ndarray:
        """K_f of a following force."""
        return self.parts(speed)[1]

    def parts(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """K_f of a dead and of a following force: work of the stresses on the slopes, and of the tilted force."""
        a, low, high = self.a, *self.press.strip
        nodes, weights = np.polynomial.legendre.leggauss(40)
        edges = np.unique([self.b / a, low, high, 1.0])
        x, w = np.concatenate(
            [((p + q) / 2 + (q - p) / 2 * nodes, (q - p) / 2 * weights) for p, q in pairwise(edges)], axis=1
        )
        loaded = (x > low) & (x < high)
        spin = speed * a * np.sqrt(self.rho / self.E)
        scale = self.force / (np.pi * a * self.h)
        field = [
            scale * stresses(k, spin, self.nu, self.b / a, self.press, x) for k in range(self.harmonics + 1)
        ]
        s = np.log(a * x)
        R, dR, at = {}, {}, {}
        for n in range(self.N + 1):
            for m in range(self.M + 1):
                series = self._series(m, n)
                R[m, n], dR[m, n] = series(s), series.deriv()(s) / x  # over x, not r
                at[m, n] = (float(series(np.log(a * low))), float(series.deriv()(np.log(a * low))) / low)
        pairs = [(m, n) for n in self.waves for m in range(self.M + 1)]
        K, tilt = (np.zeros((len(pairs), len(pairs)), dtype=complex) for _ in range(2))
        for i, (m1, n) in enumerate(pairs):
            for j, (m2, q) in enumerate(pairs):
                k = abs(q - n)
                if k > self.harmonics:
                    continue

                # What e^{i(q-n)θ} leaves of Re(A e^{ikθ})
                def left(value, k=k, rises=q > n):
                    return value.real if k == 0 else (np.conj(value) if rises else value) / 2

                S, T, H = (left(part) for part in (-1j * field[k][0], field[k][1], -1j * field[k][2]))
                f, df, g, dg = R[m1, abs(n)], dR[m1, abs(n)], R[m2, abs(q)], dR[m2, abs(q)]
                bulk = df * (x * S * dg + T * 1j * q * g) - 1j * n * f * (T * dg + H * 1j * q * g / x)
                K[i, j] = np.sum(w * bulk)

                def tilted(radius, forces, f, g, dg, q=q, left=left):
                    tangential, radial = left(forces[0]), left(-1j * forces[1])
                    return radius * f * (radial * dg + tangential * 1j * q * g / radius)

                if low == high:
                    size = (1.0 if k else 0.5) / low**2
                    forces = [np.asarray(size * part) for part in self.press.waves(k, low)]
                    push = tilted(low, forces, at[m1, abs(n)][0], *at[m2, abs(q)])
                else:
                    forces = np.array([self.press.density(k, r) for r in x[loaded]]).T
                    push = np.sum(w[loaded] * tilted(x[loaded], forces, f[loaded], g[loaded], dg[loaded]))
                tilt[i, j] = -scale * push
        return K / self.rho, (K + tilt) / self.rho
