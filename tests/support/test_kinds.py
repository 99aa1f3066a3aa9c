"""What is of another kind than wanted is refused with what it is."""

from dataclasses import dataclass

import pytest

from facegear.support.kinds import require_kind, require_kinds


@dataclass(frozen=True)
class Axle:
    length: float = 1.0


@dataclass(frozen=True)
class Wheel:
    axle: object
    rim: object = Axle()


@pytest.mark.parametrize(
    ("value", "kinds", "message"),
    [
        ("x", (Axle,), "^part must be an Axle, got 'x'$"),
        (None, (Wheel,), "^part must be a Wheel, got None$"),
        (Axle(), (Wheel,), "^part must be a Wheel, got an Axle$"),
        (Axle, (Axle,), "^part must be an Axle, got the class Axle$"),
        (2.0, (Axle, Wheel), "^part must be an Axle or a Wheel, got 2.0$"),
    ],
)
def test_another_kind_is_refused(value, kinds, message):
    with pytest.raises(TypeError, match=message):
        require_kind("part", value, *kinds)


def test_words_after_the_kinds_and_fields_of_a_dataclass():
    with pytest.raises(TypeError, match="part must be an Axle for this study, got 3"):
        require_kind("part", 3, Axle, why="for this study")
    require_kinds(Wheel(Axle()), axle=Axle, rim=Axle)
    with pytest.raises(TypeError, match="rim must be an Axle, got 4"):
        require_kinds(Wheel(Axle(), 4), axle=Axle, rim=Axle)
