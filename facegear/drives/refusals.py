"""What a model refuses or cannot compute, told under the names and in the units that a drive file has."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import TypeVar

from facegear.drives.drive_keys import SECTIONS
from facegear.drives.file_values import FileValues
from facegear.drives.keys import OVER_SI, Key
from facegear.support.parameters import rpm

T = TypeVar("T")

# What models call following the contact where they refuse teeth that do not allow it.
_TOTAL_RATE = "rate = 'total'"
_NUMBER = r"-?\d[\d.]*(?:e[-+]?\d+)?"
# A value out of its range, as facegear.support.parameters.within tells it.
_OUT_OF_RANGE = re.compile(
    rf"(?<![\w.])(?:\w+\.)*(?P<name>\w+) must lie in \[(?P<low>{_NUMBER}), (?P<high>{_NUMBER})\]"
    rf"( in (?P<unit>[^,]+))?, got (?P<got>{_NUMBER})(?: (?P=unit))?(?: \([^()]*\))?"
)
# Torque of pinion or gear, as contacts under load and play refuse it.
_TORQUE = re.compile(
    rf"(?<![\w.])torque must (?P<limits>lie in \[{_NUMBER}, {_NUMBER}\]|be at most {_NUMBER}) N m(?P<why>.*?)"
    rf"got (?P<got>{_NUMBER}) N m(?: \([^()]*\))?",
    re.DOTALL,
)
# A parameter of a model, with or without the parts that it is in, where a sentence is about it.
_PARAMETER = re.compile(
    r"(?<![\w.])(?:\w+\.)*(?P<name>\w+)(?==\d| must | = \d+ is too )|(?<=\()(?P<alone>\w+)(?=\))"
)
_RADIANS = re.compile(rf"got (?P<got>{_NUMBER}) rad(?!/)")
_SPEEDS = re.compile(
    rf"(?P<before>\b(?:at|near|speed,) |\bbetween (?P<low>{_NUMBER}) and )(?P<high>{_NUMBER}) rad/s"
)
# Advice to programmers, and names that only they know, against what stands for them.
_OF_PROGRAMS = (
    (
        rf"multipliers are known to ({_NUMBER}) only, rounding counted, which is not enough for a threshold of "
        rf"({_NUMBER}): give a larger one.*Radau",
        r"multipliers are known to \1 only, and \2 is needed to tell what grows from what dies, as where dampers or "
        "forces are very strong",
    ),
    (r"; allow_unstable=True finds the motion that any disturbance would leave", ""),
    (r"; take it out with facegear\.WithoutRigidMotion\(model\), which changes no other multiplier", ""),
    (r", which facegear\.WithoutRigidMotion\(model\) takes out,", ""),
    (r' \(rate "total", sharing "\w+"\)', ""),
    (r"; else take .*?; got ", "; got "),
    (_TOTAL_RATE, "a model that follows the moving contact"),
    (r"\bload\.(mass|stiffness|damping)=", r"pinions.\1 = "),
    (r"\bload\.(?=(mass|stiffness|damping)\b)", "pinions."),
)


def told(problem: Exception) -> str:
    """Tell somebody who knows the drive file, not the package, what a model refuses or cannot compute.

    Parameters
    ----------
    problem : Exception

    Returns
    -------
    str
        Its words, without advice to programmers, with values and limits of keys in the units of the file, and speeds
        in rpm.

    Examples
    --------
    >>> told(ValueError("bore_radius must lie in [0.0115, 0.2085] in m, got 0.01 m"))
    'body.bore_radius_mm must lie in [11.5, 208.5] in mm, got 10 mm'
    """
    text = str(problem)
    for pattern, instead in _OF_PROGRAMS:
        text = re.sub(pattern, instead, text, flags=re.DOTALL)
    return _SPEEDS.sub(_in_rpm, _OUT_OF_RANGE.sub(_in_units_of_the_file, text))


def told_of_a_model(problem: Exception) -> str:
    """Tell, as :func:`told`, what a model refuses that no file gave: its parameters by the names of their keys.

    Examples
    --------
    >>> told_of_a_model(ValueError("gear.body.drive.shaft_angle must be a right angle, got 1.0472 rad"))
    'gears.shaft_angle_deg must be a right angle, got 60.0001°'
    """
    text = _PARAMETER.sub(_by_its_key, told(problem))
    return _RADIANS.sub(lambda found: f"got {math.degrees(float(found['got'])):.6g}°", text)


def _by_its_key(found: re.Match[str]) -> str:
    known = _NAMES.get(found["name"] or found["alone"])
    return found[0] if known is None else known


def _in_rpm(found: re.Match[str]) -> str:
    before = found["before"] if found["low"] is None else f"between {rpm(float(found['low'])):.6g} and "
    return f"{before}{rpm(float(found['high'])):.6g} rpm"


def _in_units_of_the_file(found: re.Match[str]) -> str:
    """Give a value out of its range, and the range, the name and unit of its key, if a model's value has one."""
    if found["unit"] == "rad/s" and found["name"] == "speed":
        # Models have standstill, too; nothing that is asked for in rpm does.
        high, got = (f"{float(rpm(float(found[which]))):.6g} rpm" for which in ("high", "got"))
        return f"the speed of the face gear must be greater than 0 and at most {high}, got {got}"
    if (known := _KEYS.get(found["name"])) is None:
        return found[0]
    section, key = known
    path, factor = f"{section}.{key.name}", key.from_si(1.0)
    if factor == 1.0:
        return found[0].replace(found["name"], path)
    return _ranged(path, found, factor, key.unit)


def _ranged(name: str, found: re.Match[str], factor: float, unit: str) -> str:
    low, high, got = (f"{factor * float(found[which]):.6g}" for which in ("low", "high", "got"))
    within, measured = (f" in {unit}", f" {unit}") if unit else ("", "")
    return f"{name} must lie in [{low}, {high}]{within}, got {got}{measured}"


def _keys_of_models() -> Mapping[str, tuple[str, Key]]:
    """Keys whose values are a model's own, with their sections, by its name for them: tolerances are none."""
    found: dict[str, tuple[str, Key]] = {}
    # Damping of a gearbox is a time in the file and a coefficient in the model.
    others = {key.si_name for key in SECTIONS["gearbox"].keys if "damping" in key.name}
    for name, section in SECTIONS.items():
        for key in section.keys if name != "tolerances" else ():
            if key.kind == "number" and key.unit not in OVER_SI and key.si_name not in others:
                found.setdefault(key.si_name, (name, key))
    return found


_KEYS = _keys_of_models()
_NAMES = {
    key.si_name: f"{name}.{key.name}"
    for name, section in reversed(tuple(SECTIONS.items()))
    for key in reversed(section.keys)
    if name != "tolerances"
}


def built(found: FileValues, section: str, build: Callable[[], T]) -> T:
    """Build a part; what it refuses is told under the names of the file."""
    try:
        return build()
    except (TypeError, ValueError, ArithmeticError) as error:
        text = told(error)
        if (refused := _TORQUE.search(text)) is not None:
            raise ValueError(_of_power(found, refused)) from error
        for quantity, key in found.keys.get(section, {}).items():
            path = found.key(section, quantity)
            text = re.sub(rf"(?<![\w.]){quantity}(?!\w)", path, text)
            if key.or_zero:
                pattern = rf"(?<={re.escape(path)} must )(be )?(?=an integer from|lie in)"
                text = re.sub(pattern, "be 0, or ", text)
        raise ValueError(text if f"{section}." in text else f"{section}: {text}") from error


def _of_power(found: FileValues, refused: re.Match[str]) -> str:
    """Tell of a torque that is refused under the names of what gives it: power, at the speed of the pinion."""
    key = found.keys["operation"]["power"]
    power = key.from_si(found.values["operation"]["power"])
    # Limits are to power as the torque that is refused is to the power of the file.
    limits = re.sub(
        _NUMBER, lambda number: f"{float(number[0]) / float(refused['got']) * power:.3g}", refused["limits"]
    )
    why = refused["why"].replace("correction_factor", "stiffness of teeth")
    return (
        f"{found.key('operation', 'power')} must {limits} {key.unit} at {found.key('operation', 'pinion_speed')} = "
        f"{found.shown('operation', 'pinion_speed')}{why}got {power:.6g} {key.unit}"
    )


def built_following(found: FileValues, section: str, build: Callable[[], T]) -> T:
    """Build, as `built`, a model that follows the moving contact; a file has no key for that."""

    def tried() -> T:
        try:
            return build()
        except ValueError as error:
            text = str(error)
            if _TOTAL_RATE not in text:
                raise
            text = text.replace(_TOTAL_RATE, f"a section {section}, whose model follows the moving contact")
            raise ValueError(re.sub(r"\b(?=(pinion|gear)_teeth\b)", "gears.", text)) from error

    return built(found, section, tried)
