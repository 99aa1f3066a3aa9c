"""What a model refuses, told under the names that a drive file has."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeVar

from facegear.drives.file_values import FileValues

T = TypeVar("T")

# What models call following the contact where they refuse teeth that do not allow it.
_TOTAL_RATE = "rate = 'total'"


def built(found: FileValues, section: str, build: Callable[[], T]) -> T:
    """Build a part; what it refuses is told under the names of the file."""
    try:
        return build()
    except (TypeError, ValueError, ArithmeticError) as error:
        text = str(error)
        for quantity in found.keys.get(section, {}):
            text = re.sub(rf"(?<![\w.]){quantity}(?!\w)", found.key(section, quantity), text)
        raise ValueError(text if f"{section}." in text else f"{section}: {text}") from error


def built_following(found: FileValues, section: str, build: Callable[[], T]) -> T:
    """Build, as `built`, a model that follows the moving contact; a file has no key for that."""

    def told() -> T:
        try:
            return build()
        except ValueError as error:
            text = str(error)
            if _TOTAL_RATE not in text:
                raise
            text = text.replace(_TOTAL_RATE, f"a section {section}, whose model follows the moving contact")
            raise ValueError(re.sub(r"\b(?=(pinion|gear)_teeth\b)", "gears.", text)) from error

    return built(found, section, told)
