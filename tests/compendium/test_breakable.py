"""Names in code may be broken where their words end; nothing else is changed."""

from compendium.breakable import breakable


def test_only_code_gets_places_to_break_at():
    found = breakable("a_b of `ch08_maps_1` in `f(x)`")
    assert found.replace("\N{ZERO WIDTH SPACE}", "") == "a_b of `ch08_maps_1` in `f(x)`"
    assert found.split(" ")[0] == "a_b"
    assert [len(part) for part in found.split(" ")[2].split("\N{ZERO WIDTH SPACE}")] == [6, 5, 2]
