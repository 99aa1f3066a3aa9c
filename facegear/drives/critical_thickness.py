"""Thickness of the body above which it is stable at all its speeds, or why there is none to be told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from facegear.drives.refusals import told
from facegear.maps.lobes import CriticalThickness, StableRangeError, UnstableTopError, highest_lobes
from facegear.maps.parallel import in_processes
from facegear.mechanics.pinions_on_disk import FaceGears
from facegear.mechanics.plate import THICKNESS_RATIO_RANGE
from facegear.support.parameters import rpm


class ThicknessVerdict(NamedTuple):
    """Critical thickness of a body, or why there is none to be told.

    Attributes
    ----------
    critical : CriticalThickness or None
    reason : str
        Empty, or what the search says.
    """

    critical: CriticalThickness | None
    reason: str


def thickness_verdict(
    model: FaceGears, speeds: tuple[float, float], *, widest: float = 2.5, tolerance: float = 1e-4
) -> ThicknessVerdict:
    """Thickness ratio above which the body is stable in its whole speed range.

    μ, ζ, τ and the power stay as they are, so that the bearing gets stiffer with the body, as in section 4.7.

    Parameters
    ----------
    model : FaceGears
        With the driving force and in the basis of the report.
    speeds : tuple of float
        Lowest and highest speed [rad/s].
    widest : float
        It is looked for between 1/`widest` and `widest` times the model's thickness.
    tolerance : float
        Of h/a.

    Returns
    -------
    ThicknessVerdict
    """
    gear = model.gear
    here = gear.body.thickness_ratio
    lowest, highest = THICKNESS_RATIO_RANGE
    searched = (max(lowest, here / widest), min(highest, here * widest))

    def model_at(thickness_ratio: float) -> FaceGears:
        return model.with_gear(replace(gear, body=replace(gear.body, thickness_ratio=thickness_ratio)))

    low, high = speeds
    try:
        (critical,) = highest_lobes(model_at, low, [high], searched, tolerance)
    except UnstableTopError as error:
        speed = f"{rpm(error.tongue.peak):.4g} rpm"
        return ThicknessVerdict(None, f"still unstable at h/a = {error.thickness_ratio:.4g}, at {speed}")
    except StableRangeError as error:
        return ThicknessVerdict(None, f"stable down to h/a = {error.thickness_ratio:.4g}")
    except ArithmeticError as error:
        return ThicknessVerdict(None, f"the search lost its way: {told(error)}")
    return ThicknessVerdict(critical, "")


def thickness_verdicts(
    models: Sequence[FaceGears], speeds: tuple[float, float], *, jobs: int = -1
) -> tuple[ThicknessVerdict, ...]:
    """Critical thickness of several models, in processes, in their order."""
    return tuple(in_processes(thickness_verdict, [(model, speeds) for model in models], jobs))
