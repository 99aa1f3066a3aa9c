"""The table of keys."""

from facegear.drives.drive_keys import SECTIONS


def test_names_tell_units():
    for section in SECTIONS.values():
        for key in section.keys:
            assert bool(key.unit) == (key.name != key.si_name), key.name
