"""Where measurements are kept: ``build/benchmarks/<name>.json``, with the machine they were made on."""

from __future__ import annotations

import json
import os
import platform
import resource
import sys
from pathlib import Path
from typing import Any

import numpy as np

FOLDER = Path("build/benchmarks")


def processor_name() -> str:
    """Model name of the processor, as the operating system gives it."""
    cpuinfo = Path("/proc/cpuinfo")
    if cpuinfo.exists():
        for line in cpuinfo.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def peak_memory() -> float:
    """Largest resident size of this process or one of its children [MB]."""
    unit = 1e6 if sys.platform == "darwin" else 1e3
    return (
        max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
        / unit
    )


def write_record(name: str, **measured: Any) -> None:
    """Write what was measured; `data/benchmarks` holds copies of such files."""
    record = {
        "processor": processor_name(),
        "cores": os.cpu_count(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "peak_memory_mb": peak_memory(),
    }
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / f"{name}.json").write_text(json.dumps(record | measured, indent=2) + "\n")
