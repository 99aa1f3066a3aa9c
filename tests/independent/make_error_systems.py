"""Store the exact multipliers of the systems of :mod:`tests.independent.error_systems`; takes half an hour or so."""

import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from tests.independent import exact_multipliers
from tests.independent.error_systems import EACH, KINDS, STORED, checksum, system_of


def found(key: tuple[str, int]) -> tuple[int, np.ndarray]:
    """Checksum and multipliers of one system."""
    system = system_of(*key)
    return checksum(system), exact_multipliers.multipliers(system)


def main() -> None:
    """Compute all of them, two at a time."""
    keys = [(kind, number) for kind in KINDS for number in range(EACH)]
    with ProcessPoolExecutor(2) as pool:
        results = []
        for key, result in zip(keys, pool.map(found, keys, chunksize=5), strict=True):
            results.append(result)
            if key[1] == EACH - 1:
                sys.stdout.write(f"{key[0]}\n")
                sys.stdout.flush()
    sums, values = zip(*results, strict=True)
    np.savez_compressed(
        STORED,
        checksums=np.array(sums, dtype=np.uint32),
        ends=np.cumsum([x.size for x in values]),
        multipliers=np.concatenate(values),
    )


if __name__ == "__main__":
    main()
