"""Compute the anchors of chapter 2 and write them to data/anchors: `python -m tests.independent.make_anchors_ch02`.

Takes some minutes; nothing here imports facegear.
"""

from pathlib import Path

import numpy as np
import yaml
from tqdm import tqdm

from tests.independent import classical as independent

FOLDER = Path(__file__).resolve().parents[2] / "data" / "anchors"
ROUTE = (
    "tests/independent/classical.py: equations written out anew, DOP853 from jump to jump, exponentials by "
    "scipy.linalg.expm, exact borders by shooting in 20 digits, Hsu's borders from (2-26) to (2-28)"
)
GROWTH, ERROR, FREQUENCY = 1e-7, 1e-10, 1e-10
# Chart cells of either kind.
CELLS = 8


def anchor(variable, value, atol, **at):
    place = {name: float(coordinate) for name, coordinate in at.items()}
    return {"variable": variable, "at": place, "value": float(value), "atol": atol}


def chart(system_at, second, values, frequencies, **fixed):
    """Cells drawn at random until there are enough stable and unstable ones."""
    generator = np.random.default_rng(2)
    missing = {True: CELLS, False: CELLS}
    seen = set()
    while any(missing.values()):
        cell = int(generator.integers(len(values))), int(generator.integers(len(frequencies)))
        value, frequency = values[cell[0]], frequencies[cell[1]]
        if cell in seen:
            continue
        seen.add(cell)
        rate = independent.growth_rate(system_at(frequency, value))
        unstable = rate > 1e-4
        if missing[unstable]:
            missing[unstable] -= 1
            yield anchor("growth_rate", rate, GROWTH, **{second: value}, frequency=frequency, **fixed)


FREQUENCIES, DEPTHS = np.linspace(0.35, 2.65, 185), np.linspace(0.0, 0.9, 151)
HSU_DEPTHS = np.linspace(0.01, 0.9, 45)


def swing():
    for frequency in (1.4, 1.6, 1.9, 2.0, 2.1, 2.5):
        grid = np.linspace(1.4, 2.6, 121)
        frequency = grid[np.abs(grid - frequency).argmin()]
        pair = np.linalg.eigvals(independent.transition_matrix(independent.mathieu(frequency, 0.3)))
        first = pair[np.argmax(np.abs(pair) + 1e-6 * pair.imag)]
        yield anchor("multiplier_real", first.real, GROWTH, frequency=frequency, number=1)
        yield anchor("multiplier_imag", first.imag, GROWTH, frequency=frequency, number=1)
    for shown in (2.0, 1.5):
        matrix = independent.transition_matrix(independent.mathieu(shown, 0.3))
        for periods in (1, 5, 12):
            moved = np.linalg.matrix_power(matrix, periods)[0, 0]
            yield anchor("motion", moved, 1e-6, shown=shown, time=periods)


CONVERGENCE = {
    "smooth": independent.mathieu(1.1, 0.6, 0.02),
    "kinks": independent.gear_pair(1.1, 1.563, 1.0, 0.02),
    "jumps": independent.gear_pair(1.1, 1.563, 0.4, 0.02),
}


def convergence(name):
    system = CONVERGENCE[name]
    truth = independent.transition_matrix(system)
    counts = np.unique(np.geomspace(8, 2048, 33).round().astype(int))
    for count in counts[[0, 4, 9, 14, 20, 26]]:
        wrong = independent.held(system, independent.equal_edges(count))
        yield anchor("uniform", independent.relative_error(wrong, truth), ERROR, sub_intervals=count)
        # Each smooth piece gets its share, rounded up.
        pieces = list(zip(system[1][:-1], system[1][1:], strict=True))
        edges = [0.0]
        for start, stop in pieces:
            share = int(np.ceil((stop - start) * count - 1e-9))
            edges += [start + (stop - start) * p / share for p in range(1, share + 1)]
        wrong = independent.held(system, edges)
        yield anchor("aligned", independent.relative_error(wrong, truth), ERROR, sub_intervals=count)
    yield anchor("collocation", 0.0, ERROR)


def doubling():
    system = CONVERGENCE["jumps"]
    truth = independent.transition_matrix(system)
    before = None
    for count in (16, 32, 64, 128, 256, 512, 1024):
        matrix = independent.held(system, independent.equal_edges(count))
        yield anchor("error", independent.relative_error(matrix, truth), ERROR, sub_intervals=count)
        if before is not None:
            change = np.abs(matrix - before).max() / np.abs(truth).max()
            yield anchor("change", change, ERROR, sub_intervals=count)
        before = matrix


def estimates():
    system = CONVERGENCE["jumps"]
    radius = np.abs(np.linalg.eigvals(independent.transition_matrix(system))).max()
    for case, count in enumerate((16, 32, 64, 128, 256, 512)):
        matrix = independent.held(system, independent.equal_edges(count))
        found = np.abs(np.linalg.eigvals(matrix)).max()
        yield anchor("error", abs(found - radius), ERROR, case=case)
    for case in (18, 19, 20):
        yield anchor("error", 0.0, ERROR, case=case)


def mathieu_curves():
    for family in range(4):
        for number in (1, 2):
            for depth in (0.2, 0.6):
                border = independent.mathieu_border(family, number, depth)
                yield anchor("border", border, FREQUENCY, family=family, number=number, depth=depth)


def single_bands(damping_ratio):
    for depth in HSU_DEPTHS[[10, 20, 40]]:
        low, high = independent.hsu_single_damped(depth, damping_ratio)
        yield anchor("lower", low, FREQUENCY, band=1, depth=depth)
        yield anchor("upper", high, FREQUENCY, band=1, depth=depth)


def meissner_bands():
    for depth in HSU_DEPTHS[[5, 20, 40]]:
        # Square wave of duty one half: harmonics 4/(πs), s odd.
        for band, s in ((1, 5), (2, 3), (3, 1)):
            half_width = depth * 4.0 / (np.pi * s) / 2.0
            yield anchor("lower", (2.0 - half_width) / s, FREQUENCY, band=band, depth=depth)
            yield anchor("upper", (2.0 + half_width) / s, FREQUENCY, band=band, depth=depth)


COUPLED = {"sum": (0.8, 0.0), "difference": (0.0, 0.8)}


def pair_chart(kind):
    def system_at(frequency, depth):
        return independent.coupled_pair(frequency, depth, *COUPLED[kind], 0.02)

    return chart(system_at, "depth", np.linspace(0.0, 0.9, 101), np.linspace(0.3, 3.9, 181))


def pair_bands(kind):
    # Ascending by centre, the sum lies between the single frequencies, the difference below them.
    band = {"sum": 2, "difference": 1}[kind]
    for depth in np.linspace(0.02, 0.9, 45)[[15, 25, 35]]:
        centre, low, high = independent.hsu_pair(depth, *COUPLED[kind], 0.02)
        yield anchor("centre", centre, FREQUENCY, band=band, depth=depth)
        yield anchor("lower", low, FREQUENCY, band=band, depth=depth)
        yield anchor("upper", high, FREQUENCY, band=band, depth=depth)


def damping():
    frequencies, depths = np.linspace(0.35, 2.65, 116), np.linspace(0.0, 0.9, 91)
    for ratio in (0.01, 0.05):
        yield from chart(
            lambda w, eps, ratio=ratio: independent.mathieu(w, eps, ratio),
            "depth",
            depths,
            frequencies,
            damping_ratio=ratio,
        )


def hsu_errors():
    for depth in np.geomspace(0.01, 0.6, 16)[[4, 9, 13]]:
        low, high = (independent.mathieu_border(family, 1, depth) for family in (3, 2))
        hsu = independent.hsu_single_damped(depth, 0.0)
        yield anchor("width", high - low, FREQUENCY, depth=depth)
        yield anchor("error", max(abs(hsu[0] - low), abs(hsu[1] - high)), FREQUENCY, depth=depth)
        second = [independent.mathieu_border(family, 1, depth) for family in (0, 1)]
        yield anchor("second_width", second[1] - second[0], FREQUENCY, depth=depth)


def mathieu():
    return chart(independent.mathieu, "depth", DEPTHS, FREQUENCIES)


def meissner():
    return chart(lambda w, eps: independent.meissner(w, eps, 0.5), "depth", DEPTHS, FREQUENCIES)


def meissner_borders():
    for family in range(4):
        for number in (1, 2):
            for depth in (0.2, 0.6):
                border = independent.meissner_border(family, number, depth)
                yield anchor("border", border, FREQUENCY, family=family, number=number, depth=depth)


def duty():
    return chart(
        lambda w, share: independent.meissner(w, 0.4, share), "duty", np.linspace(0.02, 0.98, 97), FREQUENCIES
    )


FIGURES = {
    "ch02_swing": swing,
    **{f"ch02_convergence_{name}": lambda name=name: convergence(name) for name in CONVERGENCE},
    "ch02_doubling": doubling,
    "ch02_estimates": estimates,
    "ch02_mathieu": mathieu,
    "ch02_mathieu_curves": mathieu_curves,
    "ch02_mathieu_bands": lambda: single_bands(0.0),
    "ch02_meissner": meissner,
    "ch02_meissner_borders": meissner_borders,
    "ch02_meissner_bands": meissner_bands,
    "ch02_duty": duty,
    "ch02_damping": damping,
    "ch02_damping_bands": lambda: single_bands(0.05),
    **{f"ch02_pair_{kind}": lambda kind=kind: pair_chart(kind) for kind in COUPLED},
    **{f"ch02_pair_{kind}_bands": lambda kind=kind: pair_bands(kind) for kind in COUPLED},
    "ch02_hsu_errors": hsu_errors,
}


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, make in tqdm(FIGURES.items()):
        content = {"figure": name, "route": ROUTE, "anchors": list(make())}
        text = yaml.safe_dump(content, sort_keys=False, width=110)
        (FOLDER / f"{name}.yaml").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
