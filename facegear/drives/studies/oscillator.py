"""Mathieu's and Meissner's equation with damping."""

from __future__ import annotations

from facegear.drives.studies.study import Choice, Quantity, Settings, Study
from facegear.floquet.models import Model
from facegear.mechanics.classical import Mathieu, Meissner

COSINE, SQUARE = "cosine (Mathieu)", "square (Meissner)"


def oscillator_study() -> Study:
    """Mathieu's and Meissner's equation with damping, over parametric frequency and depth."""
    controls = (
        Choice("wave", "stiffness", (COSINE, SQUARE), COSINE),
        Quantity("depth", "depth of modulation ε", 0.0, 0.95, 0.4, 0.01, parameter="depth"),
        Quantity("damping_ratio", "damping ratio ϑ", 0.0, 0.2, 0.02, 0.002, parameter="damping_ratio"),
        Quantity("duty", "duty of the square wave", 0.05, 0.95, 0.5, 0.01, when=("wave", SQUARE)),
    )
    speed = Quantity("highest_speed", "parametric frequency ω/ω₀", 0.5, 5.0, 2.6, 0.1)

    def build(settings: Settings) -> Model:
        depth, damping_ratio = settings["depth"], settings["damping_ratio"]
        if settings["wave"] == SQUARE:
            return Meissner(depth, settings["duty"], damping_ratio)
        return Mathieu(depth, damping_ratio)

    return Study(
        controls,
        build,
        "depth",
        speed,
    )
