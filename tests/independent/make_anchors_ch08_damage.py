"""Compute the anchors of the chapter on damage: `python -m tests.independent.make_anchors_ch08_damage`.

Takes some minutes. Nothing of it is computed by the package, which gives the numbers of the gearbox only: exponents of
classical equations are closed forms or integrated in 30 digits, those of the gearbox come from
:mod:`tests.independent.torsional_switching`, motions over a revolution from DOP853 on the formulas of the text from one
switch of a tooth pair to the next, and hit rates are drawn from the law of the projections, not from noisy signals.
"""

import dataclasses
import math
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import yaml
from scipy.integrate import solve_ivp

import facegear as fg
from facegear.mechanics.gearboxes import FIGURES
from facegear.support.labelled import load
from tests.independent import torsional_switching as switching

DATA = Path(__file__).resolve().parents[2] / "data"
GEARBOX = fg.Torsional(FIGURES["7.12b"].gearbox.in_si)
NUMBERS = switching.numbers_of(GEARBOX)
NATURAL = GEARBOX.natural_frequencies()
SPEED_RPM = 500.0
LOSSES = np.array([0.05, 0.10, 0.20])
TORQUE, LOSS, SAMPLES, TOOTH = 800.0, 0.1, 16, 33
OMEGA, DAMPING, DEPTH = 1.3, 0.02, 0.4


# Classical equations, y'' + (1 − ϑ² + ε w) y = 0 with q = y e^{−ϑt}.
def from_trace(trace, decay):
    """Exponent with the largest imaginary part, of a system whose undamped multipliers have that sum."""
    period = 2 * mpmath.pi / OMEGA
    return complex(-decay + 1j * mpmath.acos(trace / 2) / period)


def by_taylor(wave, edges):
    """Trace of the transition matrix of y'' + (1 − ϑ² + ε w) y = 0, piece by piece, in 30 digits."""
    with mpmath.workdps(30):
        period = 2 * mpmath.pi / OMEGA
        columns = []
        for start in ([1, 0], [0, 1]):
            state = [mpmath.mpf(x) for x in start]
            for left, right in pairwise(edges):

                def rate(t, y, left=left):
                    stiffness = 1 - mpmath.mpf("0.0004") + mpmath.mpf("0.4") * wave(left + t / period, left)
                    return [y[1], -stiffness * y[0]]

                state = mpmath.odefun(rate, 0, state)((mpmath.mpf(right) - left) * period)
            columns.append(state)
        return from_trace(columns[0][0] + columns[1][1], mpmath.mpf("0.02"))


def mathieu():
    return by_taylor(lambda x, left: mpmath.cos(2 * mpmath.pi * x), [0, 1])


def tent():
    half = mpmath.mpf("0.5")
    return by_taylor(lambda x, left: 1 - 4 * (half - x if left == 0 else x - half), [0, half, 1])


def square():
    period = 2 * math.pi / OMEGA
    fast, slow = math.sqrt(1 - DAMPING**2 + DEPTH), math.sqrt(1 - DAMPING**2 - DEPTH)
    a, b = fast * 0.37 * period, slow * 0.63 * period
    trace = 2 * math.cos(a) * math.cos(b) - (fast / slow + slow / fast) * math.sin(a) * math.sin(b)
    return from_trace(trace, DAMPING)


def damped():
    """Return that of q̈ + (0.02 + 0.3 w) q̇ + q = 0, w = 1 for 0.37 of the period and else 0."""
    with mpmath.workdps(30):
        period, product = 2 * mpmath.pi / OMEGA, mpmath.eye(2)
        for part, damping in ((mpmath.mpf("0.37"), "0.32"), (mpmath.mpf("0.63"), "0.02")):
            product = (
                mpmath.expm(mpmath.matrix([[0, 1], [-1, -mpmath.mpf(damping)]]) * part * period) * product
            )
        values = mpmath.eig(product, left=False, right=False)
        exponents = [complex(mpmath.log(value) / period) for value in values]
    return max(exponents, key=lambda x: x.imag)


def kicked():
    """Return that of a mass 0.3 on u = b(t) q: p = q̇ + 0.3 b d(bq)/dt, ṗ = −q − 0.02 q̇ + 0.3 ḃ d(bq)/dt."""
    period = 2 * math.pi / OMEGA
    state = np.eye(2).ravel()
    for start, sense in ((0.0, 1.0), (0.5, -1.0)):

        def rate(t, flat, start=start, sense=sense):
            q, p = flat.reshape(2, 2)
            x = t / period
            b = 0.5 + 2.0 * (x if start == 0.0 else 1.0 - x)
            slope = sense * 2.0 / period
            v = (p - 0.3 * b * slope * q) / (1.0 + 0.3 * b**2)
            u_rate = b * v + slope * q
            return np.concatenate([v, -q - 0.02 * v + 0.3 * slope * u_rate])

        done = solve_ivp(
            rate, (start * period, (start + 0.5) * period), state, "DOP853", rtol=1e-13, atol=1e-15
        )
        state = done.y[:, -1]
    exponents = np.log(np.linalg.eigvals(state.reshape(2, 2)).astype(complex)) / period
    return complex(exponents[np.argmax(exponents.imag)])


def hill(stored):
    for number, exponent in enumerate((mathieu(), tent(), square(), damped(), kicked())):
        for name, value in (("decay", exponent.real), ("frequency", exponent.imag)):
            yield {"variable": name, "at": {"system": number}, "value": float(value), "atol": 1e-11}


# Exponents of the gearbox.
def gearbox_exponents(losses, speed_rpm=SPEED_RPM):
    n = dataclasses.replace(
        NUMBERS,
        k1=NUMBERS.k1 * (1 - losses[0]),
        k2=NUMBERS.k2 * (1 - losses[1]),
        km=NUMBERS.km * (1 - losses[2]),
    )
    values = np.linalg.eigvals(switching.monodromy(n, speed_rpm)).astype(complex)
    return np.log(values) * NUMBERS.N2 * speed_rpm / 60.0


def followed(losses, speed_rpm=SPEED_RPM, steps=40):
    """Exponents with positive imaginary parts when nothing is lost, followed as losses grow, slowest decay first."""
    turn = 2.0 * np.pi * NUMBERS.N2 * speed_rpm / 60.0
    first = gearbox_exponents(np.zeros(3), speed_rpm)
    path = [x for x in first[np.argsort(-first.real)] if x.imag > 0.0]
    before = path
    for share in np.linspace(0.0, 1.0, steps + 1)[1:]:
        values = gearbox_exponents(share * np.asarray(losses), speed_rpm)
        images = (values[:, np.newaxis] + 1j * turn * np.arange(-1, 2)).ravel()
        guess = [2 * a - b for a, b in zip(path, before, strict=True)]
        before = path
        path = [images[np.abs(images - x).argmin()] for x in guess]
    return np.array(path)


def frequencies(stored):
    intact = followed(np.zeros(3), steps=1)
    turn = 2.0 * np.pi * NUMBERS.N2 * SPEED_RPM / 60.0
    for part in range(3):
        unit = np.eye(3)[part]
        step = 2e-4
        ends = [followed(s * step * unit, steps=1) for s in (-1.0, 1.0)]
        slopes = (ends[1] - ends[0]).imag / (2.0 * step)
        for loss in (0.05, 0.25):
            # Told apart by decay rates; of the images, the one to which the slope at the beginning leads.
            values = gearbox_exponents(loss * unit)
            values = values[np.argsort(-values.real)].reshape(3, 2)
            moved = []
            for pair, first, slope in zip(values, intact, slopes, strict=True):
                images = (pair[:, np.newaxis] + 1j * turn * np.arange(-1, 2)).ravel() - first
                moved.append(images[np.abs(images.imag - loss * slope).argmin()])
            for motion in range(3):
                at = {"part": part, "motion": motion + 1, "loss": loss}
                yield {
                    "variable": "frequency_change",
                    "at": at,
                    "value": float(moved[motion].imag),
                    "atol": 1e-3,
                }
                yield {"variable": "decay_change", "at": at, "value": float(moved[motion].real), "atol": 1e-3}
        for motion in range(3):
            at = {"part": part, "motion": motion + 1}
            yield {"variable": "frequency_slope", "at": at, "value": float(slopes[motion]), "atol": 0.05}


def rows_of(motions, decays, speed_rpm=SPEED_RPM):
    """Return derivatives of what is measured over the deviations, by difference quotients."""
    centre, step = followed(LOSSES, speed_rpm), 2e-4
    columns = []
    for unit in step * np.eye(3):
        ends = []
        for s in (-1.0, 1.0):
            values = gearbox_exponents(LOSSES + s * unit, speed_rpm)
            turn = 2.0 * np.pi * NUMBERS.N2 * speed_rpm / 60.0
            images = (values[:, np.newaxis] + 1j * turn * np.arange(-1, 2)).ravel()
            ends.append(np.array([images[np.abs(images - x).argmin()] for x in centre]))
        change = ((ends[1] - ends[0]) / (2.0 * step))[list(motions)] / (1e-3 * NATURAL[list(motions)])
        columns.append(np.concatenate([change.imag, change.real / decays]))
    return np.array(columns).T


def cloud(stored):
    rows = rows_of((0, 1, 2), np.inf)
    bound = np.linalg.inv(rows.T @ rows)
    for i in range(3):
        for j in range(i, 3):
            at = {"part": i, "other_part": j}
            yield {"variable": "bound", "at": at, "value": float(bound[i, j]), "atol": 1e-9}


def bounds(stored):
    cases = {
        0: rows_of((0, 1, 2), np.inf),
        4: rows_of((0, 1), 1.0),
        7: np.concatenate([rows_of((0, 1), np.inf), rows_of((0, 1), np.inf, 700.0)]),
    }
    for case, rows in cases.items():
        deviations = np.sqrt(np.diag(np.linalg.inv(rows.T @ rows)))
        for part in range(3):
            value = float(deviations[part])
            at = {"survey": case, "part": part}
            yield {"variable": "deviation", "at": at, "value": value, "atol": 1e-3 * value}


# Motion over a revolution with one damaged pair.
def revolution(tooth, loss, per_period):
    """Elastic deviation of the face gear at equal steps over a revolution, per_period in each mesh period."""
    n = NUMBERS
    T0 = 60.0 / (n.N2 * SPEED_RPM)
    J = np.array([n.J1, n.J2, n.Jo])[:, None]
    radius = switching.skew_line(n)
    left = n.cr - 1.0
    grid = np.arange(per_period) / per_period

    def piece(start, stop, weak):
        """Columns of the state in (q, T0 q̇, 1) over one smooth piece: end, and values on the grid."""
        meshing = [pair for pair in range(2) if (start + stop) / 2 + pair < n.cr]
        middle = (start + stop) / 2

        def rate(x, flat):
            q, v = flat.reshape(2, 3, 7)
            C, K = switching.matrices(n, x, T0, meshing, radius, middle)
            if weak in meshing:
                own = switching.matrices(n, x, T0, [weak], radius, middle)
                none = switching.matrices(n, x, T0, [], radius, middle)
                C, K = C - loss * (own[0] - none[0]), K - loss * (own[1] - none[1])
            force = np.zeros((3, 7))
            force[2, 6] = -TORQUE
            return np.concatenate([v, T0 * (-C @ v + T0 * (force - K @ q)) / J]).ravel()

        inside = grid[(grid >= start) & (grid < stop)]
        done = solve_ivp(
            rate,
            (start, stop),
            np.eye(6, 7).ravel(),
            "DOP853",
            rtol=1e-12,
            atol=1e-15,
            t_eval=np.append(inside, stop),
        )
        states = done.y.T.reshape(-1, 6, 7)
        return states[:-1], states[-1]

    def affine(matrix):
        return np.concatenate([matrix, np.eye(1, 7, 6)])

    kinds = {}
    for weak in (None, 0, 1):
        first, end = piece(0.0, left, weak)
        second, stop = piece(left, 1.0, weak)
        values = [affine(x) for x in first] + [affine(x) @ affine(end) for x in second]
        kinds[weak] = values, affine(stop) @ affine(end)
    order = [{tooth: 0, (tooth + 1) % n.N2: 1}.get(number) for number in range(n.N2)]
    whole = np.eye(7)
    for kind in order:
        whole = kinds[kind][1] @ whole
    state = np.append(np.linalg.solve(np.eye(6) - whole[:6, :6], whole[:6, 6]), 1.0)
    found = []
    for kind in order:
        found += [matrix[1] @ state for matrix in kinds[kind][0]]
        state = kinds[kind][1] @ state
    return np.array(found).reshape(n.N2, per_period)


def sidebands(stored):
    for tooth in (0, 33, 80):
        signal = revolution(tooth, LOSS, 96).ravel()
        lines = 2.0 * np.fft.fft(signal) / signal.size
        for harmonic in (1, 17, 32, 33, 75, 107, 139, 214, 300):
            for name, value in (
                ("amplitude_real", lines[harmonic].real),
                ("amplitude_imaginary", lines[harmonic].imag),
            ):
                at = {"tooth": tooth, "harmonic": harmonic}
                yield {"variable": name, "at": at, "value": float(value), "atol": 1e-10}
    signal = revolution(0, 0.0, 96).ravel()
    lines = 2.0 * np.fft.fft(signal) / signal.size
    for harmonic in (107, 214):
        at = {"harmonic": harmonic}
        yield {"variable": "intact", "at": at, "value": float(abs(lines[harmonic])), "atol": 1e-10}


def hits(stored):
    """Draw projections from their normal law: means and covariances are overlaps of the traces."""
    pattern = revolution(0, LOSS, SAMPLES)
    pattern = pattern - pattern.mean(axis=0)
    shifted = np.array([np.roll(pattern, k, axis=0).ravel() for k in range(len(pattern))])
    overlaps = shifted @ shifted.T
    size = np.sqrt(overlaps[0, 0] / pattern.size)
    values, vectors = np.linalg.eigh(overlaps)
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    rng, trials, drawn = np.random.default_rng(11), int(stored.attrs["trials"]), 40000
    for level in stored.noise.values.tolist():
        scores = overlaps[TOOTH] + level * size * rng.normal(size=(drawn, len(root))) @ root.T
        share = float((scores.argmax(axis=1) == TOOTH).mean())
        spread = max(share * (1.0 - share), 1.0 / trials)
        atol = 4.0 * math.sqrt(spread * (1.0 / trials + 1.0 / drawn))
        yield {"variable": "hits", "at": {"noise": level}, "value": share, "atol": float(atol)}
        bound = float(level * size / np.sqrt(overlaps[0, 0]))
        yield {"variable": "bound", "at": {"noise": level}, "value": bound, "atol": 1e-6}
        scatter = 4.0 * bound / math.sqrt(2.0 * trials)
        yield {"variable": "scatter", "at": {"noise": level}, "value": bound, "atol": float(scatter)}


JOBS = {
    "hill": (hill, "closed forms, Taylor series in 30 digits (mpmath), DOP853 in momenta"),
    "frequencies": (
        frequencies,
        "tests/independent/torsional_switching.py: DOP853 from switch to switch, motions told apart by decay rates",
    ),
    "cloud": (cloud, "difference quotients of exponents by DOP853"),
    "bounds": (bounds, "difference quotients of exponents by DOP853"),
    "sidebands": (
        sidebands,
        "DOP853 over a revolution on the formulas of the text, and a discrete Fourier transform",
    ),
    "hits": (hits, "traces by DOP853 on the formulas of the text; projections drawn from their normal law"),
}


def main() -> None:
    """Write the anchors."""
    for name, (compute, route) in JOBS.items():
        figure = f"ch08_damage_{name}"
        content = {
            "figure": figure,
            "route": route,
            "anchors": list(compute(load(DATA / "reference" / f"{figure}.nc"))),
        }
        (DATA / "anchors" / f"{figure}.yaml").write_text(
            yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
        )


if __name__ == "__main__":
    main()
