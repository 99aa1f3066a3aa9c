"""What a key of a drive file is: its name with its unit, what it means, what is valid, its value in SI."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal
from unicodedata import lookup

from facegear.support.parameters import WATT_PER_HORSEPOWER

Kind = Literal["integer", "number", "text", "choice", "numbers", "choices"]
LONGEST_TEXT = 80
MOST_PINIONS = 12
# Along each side of a map.
MOST_CELLS = 1000
# Value in SI is value in the file divided by this.
PER_SI: Mapping[str, float] = MappingProxyType(
    {
        "mm": 1e3,
        "µm": 1e6,
        "°": 180 / math.pi,
        "µs": 1e6,
        "rpm": 30 / math.pi,
        "kW": 1e-3,
        "hp": 1 / WATT_PER_HORSEPOWER,
        "GPa": 1e-9,
        "MPa": 1e-6,
        "%": 100.0,
    }
)
# Value in SI is this divided by the value in the file.
OVER_SI: Mapping[str, float] = MappingProxyType({"1/in": 25.4e-3})
_UNIT_IN_NAME = re.compile(
    r"_(mm|um|deg|us|rpm|kW|hp|GPa|MPa|per_inch|kg_per_m3|kg_m2|N_per_m|Nm_per_rad|percent)$"
)


def plain(meaning: str) -> str:
    r"""Give documentation without its marks, Greek letters as such.

    Examples
    --------
    >>> plain(r"$\mu$, as `gearbox` has it")
    'μ, as gearbox has it'
    """
    return re.sub(
        r"\\([a-z]+)",
        lambda found: lookup(f"GREEK SMALL LETTER {found[1].upper()}"),
        re.sub(r"[$`]", "", meaning),
    )


@dataclass(frozen=True)
class Key:
    """One key of a drive file.

    Attributes
    ----------
    name : str
        Name in the file, with its unit.
    meaning : str
        What it is, for the documentation.
    kind : {"number", "integer", "text", "choice", "numbers", "choices"}
        "numbers" is a list of any numbers, "choices" one of certain words or numbers.
    unit : str
        Unit of the value in the file.
    lowest, highest : float
        Ends of the valid interval, both allowed.
    or_zero : bool
        Whether 0 is valid although it lies outside the interval.
    default : object
        Value if the key is left out; None for a key that must be there.
    choices : tuple of str or int
        Valid words of a "choice"; valid entries of "choices".
    quantity : str
        Name of the package's own parameter, where it is not that of the key without its unit. Keys of a section with
        the same quantity say the same in different units: a file has exactly one of them.
    no_unit : str
        What a ratio without a unit is mistaken for.
    hint : str
        What is said of a value outside the interval, in place of a guess at its unit.
    """

    name: str
    meaning: str
    kind: Kind = "number"
    unit: str = ""
    lowest: float = -math.inf
    highest: float = math.inf
    or_zero: bool = False
    default: Any = None
    choices: tuple[str | int, ...] = ()
    quantity: str = ""
    no_unit: str = ""
    hint: str = ""

    @property
    def si_name(self) -> str:
        """Name of the package's own parameter."""
        return self.quantity or _UNIT_IN_NAME.sub("", self.name)

    def allows(self, value: float) -> bool:
        """Whether a number is valid, in the file's unit."""
        return self.lowest <= value <= self.highest or (self.or_zero and value == 0)

    def to_si(self, value: float) -> float:
        """Value in SI of a value in the file."""
        return OVER_SI[self.unit] / value if self.unit in OVER_SI else value / PER_SI.get(self.unit, 1.0)

    def from_si(self, value: float) -> float:
        """Value in the file of a value in SI."""
        return OVER_SI[self.unit] / value if self.unit in OVER_SI else value * PER_SI.get(self.unit, 1.0)

    @property
    def plain_meaning(self) -> str:
        """Meaning without marks, Greek letters as such."""
        return plain(self.meaning)

    @property
    def fewest(self) -> int:
        """How many entries a list has at least."""
        return 0 if self.default == () else 1

    @property
    def valid(self) -> str:
        """What is valid, in words."""
        many = f"a list of {self.fewest} to {MOST_PINIONS}"
        if self.kind == "choices":
            what = "words" if isinstance(self.choices[0], str) else "numbers"
            return f"{many} {what}, each {self.valid_entry}"
        if self.kind == "numbers":
            return f"{many} numbers, each {self.valid_entry.removeprefix('a number ')}"
        return self.valid_entry

    @property
    def valid_entry(self) -> str:
        """What is valid for one entry of a list, or for a key without a list."""
        if self.choices:
            return " or ".join(map(str, self.choices))
        if self.kind == "text":
            return f"text of 1 to {LONGEST_TEXT} characters"
        interval = f"{self.lowest:g} to {self.highest:g}{f' {self.unit}' if self.unit else ''}"
        what = "a whole number" if self.kind == "integer" else "a number"
        return f"{'0, or ' if self.or_zero else ''}{what} from {interval}"


@dataclass(frozen=True)
class Section:
    """A group of keys.

    Attributes
    ----------
    meaning : str
        What it describes.
    keys : tuple of Key
    required : bool
        Whether a file must have it.
    assumed : bool
        Whether a file without it is taken to have it, with the values that keys have if they are left out.
    """

    meaning: str
    keys: tuple[Key, ...]
    required: bool = True
    assumed: bool = False

    def quantities(self) -> Iterator[tuple[Key, ...]]:
        """Keys that say the same in different units, together; most stand alone."""
        for name in dict.fromkeys(key.si_name for key in self.keys):
            yield tuple(key for key in self.keys if key.si_name == name)
