"""A key of a drive file: units there and back, what is valid in words, keys that say the same."""

import pytest

from facegear.drives.keys import OVER_SI, PER_SI, Key, Section

POWERS = (Key("power_kW", "power", unit="kW"), Key("power_hp", "power", unit="hp"))


@pytest.mark.parametrize("unit", ["", *PER_SI, *OVER_SI])
def test_a_value_comes_back_from_si(unit):
    key = Key("length", "how long", unit=unit)
    assert key.from_si(key.to_si(3.7)) == pytest.approx(3.7, rel=1e-15)


@pytest.mark.parametrize(
    ("unit", "value", "si"),
    [
        ("mm", 3.175, 3.175e-3),
        ("°", 180.0, 3.141592653589793),
        ("hp", 1.0, 745.69987),
        ("1/in", 8.0, 3.175e-3),
    ],
)
def test_values_in_si(unit, value, si):
    assert Key("any", "any", unit=unit).to_si(value) == pytest.approx(si, rel=1e-8)


@pytest.mark.parametrize(
    ("key", "valid"),
    [
        (Key("n", "", "integer", lowest=2, highest=9, or_zero=True), "0, or a whole number from 2 to 9"),
        (Key("t", "", "text"), "text of 1 to 80 characters"),
        (Key("s", "", "choices", default=(), choices=(1, -1)), "a list of 0 to 12 numbers, each 1 or -1"),
        (Key("a", "", "numbers", "°", 0, 90), "a list of 1 to 12 numbers, each from 0 to 90 °"),
    ],
)
def test_what_is_valid_in_words(key, valid):
    assert key.valid == valid


def test_keys_that_say_the_same_go_together():
    section = Section("", (*POWERS, Key("speed_rpm", "speed", unit="rpm")))
    assert [[key.name for key in keys] for keys in section.quantities()] == [
        ["power_kW", "power_hp"],
        ["speed_rpm"],
    ]
