"""Floquet multipliers of the disk in complex exponentials, (4-8) to (4-13), integrated by DOP853.

A slow second route for the transverse chapters. It shares no assembly with the package: of the body it takes
dimensions, material and the values of R_mn(r); radial derivatives, eigenvalues, all integrals and the
centrifugal stress are computed here in another way, the coordinates are the complex η_mn for n = -N, ..., N,
and the contact centroid comes in as a plain function of time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag

RadialFunction = Callable[[int, int, np.ndarray], np.ndarray]
Position = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

# Higher degrees only add the rounding of their second derivatives: 40 gives the eigenvalues to 5e-12.
DEGREE = 40


@dataclass(frozen=True, eq=False)
class ComplexDisk:
    """The disk: R(m, n, r) of unit norm ∫R²r dr, largest M and N, and SI dimensions and constants."""

    radial: RadialFunction
    M: int
    N: int
    a: float
    b: float
    h: float
    E: float
    rho: float
    nu: float
    xi: float

    @property
    def waves(self) -> list[int]:
        return list(range(-self.N, self.N + 1))

    @property
    def bending_stiffness(self) -> float:
        return self.E * self.h**3 / 12 / (1 - self.nu**2)

    def _series(self, m: int, n: int) -> chebyshev.Chebyshev:
        """R_mn as a function of s = ln r, in which it is entire."""
        ends = [np.log(self.b), np.log(self.a)]
        return chebyshev.Chebyshev.interpolate(lambda s: self.radial(m, n, np.exp(s)), DEGREE, ends)

    def _integral(self, values_of_s: Callable[[np.ndarray], np.ndarray]) -> float:
        """∫ f ds by Clenshaw-Curtis in s: fit, integrate the series."""
        ends = [np.log(self.b), np.log(self.a)]
        antiderivative = chebyshev.Chebyshev.interpolate(values_of_s, 2 * DEGREE, ends).integ(lbnd=ends[0])
        return float(antiderivative(ends[1]))

    def elastic(self, n: int) -> np.ndarray:
        """β_n of (4-9) as Rayleigh quotients 2U/(ρh ∫R²r dr), diagonal."""
        values = []
        for m in range(self.M + 1):
            R = self._series(m, n)
            R1, R2 = R.deriv(1), R.deriv(2)

            def energy(s: np.ndarray, R=R, R1=R1, R2=R2) -> np.ndarray:
                # with d/dr = (1/r) d/ds; curvatures times r²
                radial, hoop, twist = R2(s) - R1(s), R1(s) - n**2 * R(s), n * (R1(s) - R(s))
                density = radial**2 + hoop**2 + 2 * self.nu * radial * hoop + 2 * (1 - self.nu) * twist**2
                return density * np.exp(-2 * s)

            norm = self._integral(lambda s, R=R: R(s) ** 2 * np.exp(2 * s))
            values.append(self.bending_stiffness / (self.rho * self.h) * self._integral(energy) / norm)
        return np.diag(values)

    def centrifugal(self, n: int, speed: float) -> np.ndarray:
        """L_n of (4-9). The stress is found from the displacement u = A r + B/r - (1-ν²)ρΩ²r³/(8E)."""
        k = (1 - self.nu**2) * self.rho * speed**2 / (8 * self.E)
        # u(b) = 0 and σ_r(a) ∝ u' + ν u/r = 0
        A, B = np.linalg.solve(
            [[self.b, 1 / self.b], [1 + self.nu, -(1 - self.nu) / self.a**2]],
            [k * self.b**3, k * (3 + self.nu) * self.a**2],
        )
        modulus = self.E / (1 - self.nu**2)

        def stresses(r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            slope, ratio = A - B / r**2 - 3 * k * r**2, A + B / r**2 - k * r**2
            return modulus * (slope + self.nu * ratio), modulus * (ratio + self.nu * slope)

        matrix = np.empty((self.M + 1, self.M + 1))
        for m1 in range(self.M + 1):
            for m2 in range(self.M + 1):
                one, two = self._series(m1, n), self._series(m2, n)
                one_slope, two_slope = one.deriv(), two.deriv()

                def integrand(s: np.ndarray, f=one, g=two, df=one_slope, dg=two_slope) -> np.ndarray:
                    radial, hoop = stresses(np.exp(s))
                    return radial * df(s) * dg(s) + n**2 * hoop * f(s) * g(s)

                matrix[m1, m2] = self._integral(integrand) / self.rho
        return matrix

    @cached_property
    def _elastic(self) -> list[np.ndarray]:
        return [self.elastic(abs(n)) for n in self.waves]

    @cached_property
    def _centrifugal(self) -> list[np.ndarray]:
        return [self.centrifugal(abs(n), 1.0) for n in self.waves]

    def constant_matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M0, C0, K0 of (4-11)."""
        one = self.M + 1
        size = one * (2 * self.N + 1)
        M0, C0, K0 = (np.zeros((size, size), dtype=complex) for _ in range(3))
        for place, n in enumerate(self.waves):
            rows = slice(place * one, (place + 1) * one)
            beta_n = self._elastic[place]
            L_n = self._centrifugal[place] * speed**2
            M0[rows, rows] = np.eye(one)
            C0[rows, rows] = self.xi * beta_n + 2j * n * speed * np.eye(one)
            K0[rows, rows] = beta_n + L_n + 1j * n * self.xi * speed * beta_n - n**2 * speed**2 * np.eye(one)
        return M0, C0, K0

    def values(self, r: float, theta: float) -> np.ndarray:
        """R_mn(r) e^{inθ} in the order of the coordinates."""
        radial = [[self.radial(m, abs(n), np.asarray(r)) for m in range(self.M + 1)] for n in self.waves]
        return (np.array(radial, dtype=float) * np.exp(1j * np.array(self.waves) * theta)[:, None]).ravel()

    def stiffness_at(self, r: float, speed: float) -> float:
        """k_d by (4-14) to (4-16), with A_d in full."""
        M0, C0, K0 = self.constant_matrices(speed)
        zero, one = np.zeros_like(M0), np.eye(len(M0))
        A_d = np.block([[zero, one], [-np.linalg.solve(M0, K0), -np.linalg.solve(M0, C0)]])
        v = self.values(r, 0.3)
        B_d = np.concatenate([np.zeros(len(v)), v.conj() / (2 * np.pi * self.rho * self.h)])
        C_d = np.concatenate([v, np.zeros(len(v))])
        k_d = -1 / (C_d @ np.linalg.solve(A_d, B_d))
        assert abs(k_d.imag) < 1e-10 * abs(k_d.real), (
            "a real disk answers a real force with a real deflection"
        )
        return float(k_d.real)


@dataclass(frozen=True, eq=False)
class Pinion:
    """Contact centroid (r, θ) as a function of t/T0, smooth between the instants (ascending in [0, 1))."""

    position: Position
    instants: Sequence[float]


def multipliers(
    disk: ComplexDisk,
    pinions: Sequence[Pinion],
    speed: float,
    period: float,
    *,
    m_p: float,
    c_b: float,
    k_b: float,
    tolerance: float = 1e-12,
) -> np.ndarray:
    """Eigenvalues of the transition matrix of (4-12), one smooth piece of the period after the other."""
    M0, C0, K0 = disk.constant_matrices(speed)
    size = len(M0)
    n = np.repeat(disk.waves, disk.M + 1)
    instants = np.unique([0.0, 1.0, *(instant for pinion in pinions for instant in pinion.instants)])
    # Rounding puts the same instant down twice.
    instants = np.concatenate([[0.0], instants[1:][np.diff(instants) > 1e-10]])
    instants[-1] = 1.0
    X = np.eye(2 * size, dtype=complex)
    frequency = np.sqrt(np.abs(K0).max())
    scale = np.concatenate([np.full(size, frequency), np.ones(size)])
    for start, end in pairwise(instants):
        tables = [_radial_tables(disk, pinion, start, end) for pinion in pinions]

        def rates(t: float, flat: np.ndarray, tables=tables) -> np.ndarray:
            M, C, K = M0.copy(), C0.copy(), K0.copy()
            for radial, angle in tables:
                R, theta = radial(t / period), float(angle(t / period))
                # H_nq e^{i(-n+q)θc}/(2πρh), (4-8) and (4-11)
                wave = np.exp(1j * theta * (-n[:, None] + n[None, :]))
                H = wave * np.outer(R, R) / (2 * np.pi * disk.rho * disk.h)
                M += H * m_p
                C += H * c_b
                K += H * k_b
            Y = flat.reshape(2 * size, 2 * size) / scale[:, None]
            acceleration = -np.linalg.solve(M, K @ Y[:size] + C @ Y[size:])
            return (np.concatenate([Y[size:], acceleration]) * scale[:, None]).ravel()

        solution = solve_ivp(
            rates,
            (start * period, end * period),
            (X * scale[:, None]).ravel(),
            method="DOP853",
            rtol=tolerance,
            atol=tolerance * frequency,
        )
        assert solution.success, solution.message
        X = solution.y[:, -1].reshape(2 * size, 2 * size) / scale[:, None]
    return np.linalg.eigvals(X * scale[:, None] / scale[None, :])


def total_rate_multipliers(
    disk: ComplexDisk,
    pinion: Pinion,
    speed: float,
    period: float,
    *,
    m_p: float,
    c_b: float,
    k_b: float,
    tolerance: float = 1e-12,
) -> np.ndarray:
    """Eigenvalues of the transition matrix when the pinion follows u = w(r_c(t), θ_c(t), t) itself.

    With φ = R_mn(r_c) e^{inθc} and all loads over 2πρh the momentum p = η' + conj(φ) m u', u' = φη' + φ'η, obeys
    p' = -C0 η' - K0 η - conj(φ) (c u' + k u) + conj(φ') m u'. It stays continuous where φ' jumps: no kicks.
    """
    _, C0, K0 = disk.constant_matrices(speed)
    size = len(K0)
    m, c, k = (load / (2 * np.pi * disk.rho * disk.h) for load in (m_p, c_b, k_b))
    frequency = np.sqrt(np.abs(K0).max())
    scale = np.concatenate([np.full(size, frequency), np.ones(size)])
    X = np.eye(2 * size, dtype=complex) / scale[:, None]
    for start, end in pairwise([*pinion.instants, 1.0]):
        phi, slope = _shape_series(disk, pinion, start, end)

        def rates(t: float, flat: np.ndarray, phi=phi, slope=slope) -> np.ndarray:
            Y = flat.reshape(2 * size, 2 * size) / scale[:, None]
            eta, p = Y[:size], Y[size:]
            f, f_dot = phi(t / period), slope(t / period) / period
            moved = f_dot @ eta
            # (1 + m conj(φ) φ) η' = p - m conj(φ) φ'η, inverted after Sherman and Morrison.
            right = p - m * np.outer(f.conj(), moved)
            velocity = right - np.outer(f.conj(), m * (f @ right) / (1 + m * (f @ f.conj()).real))
            u, u_dot = f @ eta, f @ velocity + moved
            force = np.outer(f.conj(), c * u_dot + k * u) - np.outer(f_dot.conj(), m * u_dot)
            return (np.concatenate([velocity, -C0 @ velocity - K0 @ eta - force]) * scale[:, None]).ravel()

        solution = solve_ivp(
            rates,
            (start * period, end * period),
            (X * scale[:, None]).ravel(),
            method="DOP853",
            rtol=tolerance,
            atol=tolerance,
        )
        assert solution.success, solution.message
        X = solution.y[:, -1].reshape(2 * size, 2 * size) / scale[:, None]
    return np.linalg.eigvals(X * scale[:, None])


@dataclass(frozen=True, eq=False)
class Spring:
    """Teeth between a disk and one pinion: where they press, and what part of k_z and c_z they then have."""

    place: Pinion
    weight: Callable[[np.ndarray], np.ndarray]
    pinion: int = 0
    disk: int = 0


def oscillator_multipliers(
    disk: ComplexDisk,
    springs: Sequence[Spring],
    speed: float | Sequence[float],
    period: float,
    *,
    m_p: float,
    c_b: float,
    k_b: float,
    c_z: float,
    k_z: float,
    tolerance: float = 1e-12,
) -> np.ndarray:
    """Eigenvalues of the transition matrix when pinions m_p w'' + c_b w' + k_b w = F hang on springs of the teeth.

    F = s (c_z u' + k_z u) with u = w(r_c(t), θ_c(t), t) - w_m and u' its whole derivative presses on the disk with the
    opposite sign. State: η, η' and, in metres, w_m and w_m'. With several speeds there are as many disks alike.
    """
    turning = [disk.constant_matrices(each) for each in np.atleast_1d(speed)]
    C0, K0 = (block_diag(*(matrices[k] for matrices in turning)) for k in (1, 2))
    n, count = len(K0), 1 + max(spring.pinion for spring in springs)
    modal_mass = 2 * np.pi * disk.rho * disk.h
    frequency = np.sqrt(np.abs(K0).max())
    # w_m in units in which it weighs as much as a mode.
    unit = np.concatenate([np.ones(n), np.full(count, np.sqrt(modal_mass / m_p))])
    scale = np.concatenate([frequency / unit, 1 / unit])
    instants = np.unique([0.0, 1.0, *(x for spring in springs for x in spring.place.instants)])
    instants = np.concatenate([[0.0], instants[1:][np.diff(instants) > 1e-10]])
    instants[-1] = 1.0
    X = np.eye(2 * (n + count), dtype=complex)
    for start, end in pairwise(instants):
        tables = []
        for spring in springs:
            if np.any(spring.weight(np.array([(start + end) / 2])) != 0.0):
                weight = chebyshev.Chebyshev.interpolate(
                    lambda x, spring=spring: spring.weight(np.clip(x, start + 1e-15, end - 1e-15)),  # noqa: B023
                    80,
                    [start, end],
                )
                own = slice(*(n // len(turning) * np.array([spring.disk, spring.disk + 1])))
                share = _summed(weight.coef, start, end)
                tables.append((spring.pinion, own, share, *_shape_series(disk, spring.place, start, end)))

        def rates(t: float, flat: np.ndarray, tables=tables) -> np.ndarray:
            Y = flat.reshape(2 * (n + count), -1) / scale[:, None]
            eta, w, eta_t, w_t = np.split(Y, [n, n + count, 2 * n + count])
            disk_force = -C0 @ eta_t - K0 @ eta
            pinion_force = -c_b * w_t - k_b * w
            for number, own, weight, phi, slope in tables:
                f, f_dot = phi(t / period), slope(t / period) / period
                u, u_dot = f @ eta[own] - w[number], f @ eta_t[own] + f_dot @ eta[own] - w_t[number]
                force = weight(t / period) * (c_z * u_dot + k_z * u)
                disk_force[own] -= np.outer(f.conj(), force) / modal_mass
                pinion_force[number] += force
            return (np.concatenate([eta_t, w_t, disk_force, pinion_force / m_p]) * scale[:, None]).ravel()

        solution = solve_ivp(
            rates,
            (start * period, end * period),
            (X * scale[:, None]).ravel(),
            method="DOP853",
            rtol=tolerance,
            atol=tolerance * frequency,
        )
        assert solution.success, solution.message
        X = solution.y[:, -1].reshape(X.shape) / scale[:, None]
    return np.linalg.eigvals(X * scale[:, None] / scale[None, :])


def _shape_series(disk: ComplexDisk, pinion: Pinion, start: float, end: float):
    """Series of R_mn(r_c) e^{inθc} in t/T0 on one smooth piece, and its derivative by t/T0."""
    n = np.repeat(disk.waves, disk.M + 1)
    points = chebyshev.chebpts1(81)
    r, theta = pinion.position((start + end) / 2 + (end - start) / 2 * points)
    radial = np.array([disk.radial(m, abs(q), r) for q in disk.waves for m in range(disk.M + 1)]).T
    values = radial * np.exp(1j * np.outer(theta, n))
    series = np.linalg.solve(chebyshev.chebvander(points, 80), values)
    assert np.abs(series[-4:]).max() < 1e-12 * np.abs(series).max(), "the shape is not smooth on a piece"
    slopes = chebyshev.chebder(series) * 2 / (end - start)
    return _summed(series, start, end), _summed(slopes, start, end)


def _summed(coefficients: np.ndarray, start: float, end: float) -> Callable[[float], np.ndarray]:
    """Σ c_k T_k at one t/T0, by T_k = cos(k arccos x): the usual recurrence of eighty steps takes ten times as long."""
    degrees = np.arange(len(coefficients))

    def at(fraction: float) -> np.ndarray:
        local = min(1.0, max(-1.0, (2 * fraction - start - end) / (end - start)))
        return np.cos(degrees * math.acos(local)) @ coefficients

    return at


def first_order_growth(
    disk: ComplexDisk,
    pinion: Pinion,
    speed: float,
    period: float,
    pair: tuple[int, int],
    order: int,
    *,
    m_p: float,
    c_b: float,
    k_b: float,
) -> float:
    """Growth rate of one sum resonance after Hsu: the pair (k, j) of the mean system alone, averaged to first order.

    In the modes of the mean system, a_k' = λ_k a_k + c_kj e^{isωt} b, b' = conj(λ_j) b + c_jk e^{-isωt} a_k, where
    b belongs to the conjugate of mode j and c holds the s-th Fourier coefficients of the periodic matrices.
    """
    M, C, K = disk.constant_matrices(speed)
    n = np.repeat(disk.waves, disk.M + 1)
    coefficients = {s: np.zeros_like(M) for s in (0, order, -order)}
    points, weights = np.polynomial.legendre.leggauss(60)
    for start, end in pairwise([*pinion.instants, 1.0]):
        x = (start + end) / 2 + (end - start) / 2 * points
        r, theta = pinion.position(x)
        R = np.array([disk.radial(m, abs(q), r) for q in disk.waves for m in range(disk.M + 1)])
        phi = R * np.exp(1j * np.outer(n, theta))
        for s, total in coefficients.items():
            weight = (end - start) / 2 * weights * np.exp(-2j * np.pi * s * x)
            total += (phi.conj() * weight) @ phi.T / (2 * np.pi * disk.rho * disk.h)
    M, C, K = M + coefficients[0] * m_p, C + coefficients[0] * c_b, K + coefficients[0] * k_b
    size = len(M)
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros_like(M), np.eye(size)], [-inverse @ K, -inverse @ C]])
    values, vectors = np.linalg.eig(A)
    left = np.linalg.inv(vectors)
    ascending = sorted(np.flatnonzero(values.imag > 0), key=lambda i: values[i].imag)
    first = ascending[pair[0] - 1]
    second = int(np.argmin(np.abs(values - values[ascending[pair[1] - 1]].conj())))

    def coupling(i: int, j: int, s: int) -> complex:
        load = m_p * values[j] ** 2 + c_b * values[j] + k_b
        return complex(-left[i, size:] @ inverse @ (coefficients[s] * load) @ vectors[:size, j])

    turning = 2j * np.pi * order / period
    block = [
        [values[first], coupling(first, second, order)],
        [coupling(second, first, -order), values[second] + turning],
    ]
    return float(np.linalg.eigvals(block).real.max())


def _radial_tables(
    disk: ComplexDisk, pinion: Pinion, start: float, end: float
) -> tuple[Callable[[float], np.ndarray], Callable[[float], np.ndarray]]:
    """R_mn(r_c) in the order of the coordinates, and θ_c, as Chebyshev series in t/T0 on one smooth piece."""

    def radial(x: np.ndarray) -> np.ndarray:
        r, _ = pinion.position(x)
        return np.array([disk.radial(m, n, r) for n in range(disk.N + 1) for m in range(disk.M + 1)]).T

    degree, one = 80, disk.M + 1
    points = chebyshev.chebpts1(degree + 1)
    x = (start + end) / 2 + (end - start) / 2 * points
    coefficients = np.linalg.solve(chebyshev.chebvander(points, degree), radial(x))
    order = np.concatenate([np.arange(abs(n) * one, (abs(n) + 1) * one) for n in disk.waves])

    at = _summed(coefficients[:, order], start, end)
    angle = chebyshev.Chebyshev.interpolate(lambda y: pinion.position(y)[1], degree, [start, end])
    check = start + (end - start) * np.array([0.111, 0.537, 0.923])
    for fraction, exact in zip(check, radial(check), strict=True):
        error = np.abs(at(fraction) - exact[order]).max() / np.abs(exact).max()
        assert error < 1e-11, f"R(r_c) is not smooth between {start} and {end} of the period: {error:.1e}"
    return at, _summed(angle.coef, start, end)
