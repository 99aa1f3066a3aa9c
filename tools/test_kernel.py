"""Run the tests as on another processor: another kernel of OpenBLAS, and NumPy without its wider instructions.

`python tools/test_kernel.py [pytest options]`. Last digits differ from processor to processor; a test that hangs on
them fails here. Nothing runs unless a process started like the tests reports the other kernel as its own.
"""

import json
import os
import platform
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import scipy.linalg  # noqa: F401 - SciPy has an OpenBLAS of its own
from threadpoolctl import threadpool_info

ROOT = Path(__file__).resolve().parents[1]
# Old enough for every processor of its kind to run, and to have no fused multiply-add where new ones do.
KERNELS = {"x86_64": "Nehalem", "AMD64": "Nehalem", "aarch64": "ARMV8"}


def in_use() -> dict[str, list[str]]:
    """Return what this process computes with: OpenBLAS's kernels, and what NumPy found beyond its baseline."""
    blas = {library.get("architecture", library["user_api"]) for library in threadpool_info()}
    return {"blas": sorted(blas), "numpy": np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])}


def switched(kernel: str, extensions: Sequence[str]) -> dict[str, str]:
    """Return the settings that give a process another kernel and take some extensions from it.

    NumPy warns of extensions that the processor does not have, so that only those it has may be named.
    """
    return {"OPENBLAS_CORETYPE": kernel, "NPY_DISABLE_CPU_FEATURES": " ".join(extensions)}


def problem(kernel: str, here: dict[str, list[str]], there: dict[str, list[str]]) -> str | None:
    """Return why a process that should have another kernel does not stand for another processor, or None."""
    if there["blas"] != [kernel] or there["numpy"]:
        return f"asked for the kernel {kernel} alone, got {there['blas']} and {there['numpy'] or 'no extensions'}"
    if there == here:
        return (
            f"{kernel} without extensions is what this processor has anyway; this run would show nothing new"
        )
    return None


def main(options: list[str]) -> int:
    """Switch, see that it took effect, test; return the exit code."""
    kernel = KERNELS.get(platform.machine())
    if kernel is None:
        sys.stderr.write(f"no other kernel is known for {platform.machine()}\n")
        return 1
    here = in_use()
    environment = os.environ | switched(kernel, here["numpy"])
    probe = [sys.executable, "-W", "error", __file__, "--in-use"]
    there = json.loads(subprocess.run(probe, env=environment, stdout=subprocess.PIPE, check=True).stdout)
    message = problem(kernel, here, there)
    if message:
        sys.stderr.write(f"{message}\n")
        return 1
    sys.stdout.write(
        f"OpenBLAS {kernel} instead of {', '.join(here['blas'])}; NumPy without {here['numpy']}\n"
    )
    sys.stdout.flush()
    tests = [sys.executable, "-m", "pytest", *options]
    return subprocess.run(tests, cwd=ROOT, env=environment, check=False).returncode


if __name__ == "__main__":
    if sys.argv[1:] == ["--in-use"]:
        sys.stdout.write(json.dumps(in_use()))
    else:
        sys.exit(main(sys.argv[1:]))
