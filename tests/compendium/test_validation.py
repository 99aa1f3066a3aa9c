"""Values from outside beside the package's own: what a deviation is, and that anchors are counted as they are."""

import pytest

from compendium import validation
from compendium.reference import ReferenceMismatchError
from facegear.support import labelled
from tests.compendium.test_reference import figure


@pytest.fixture
def data(tmp_path):
    (tmp_path / "anchors").mkdir()
    return tmp_path


def store(data, name, *values, atol=1e-3):
    labelled.save(figure(), data / "reference" / f"{name}.nc")
    rows = [
        f"- {{variable: radius, at: {{speed: 2.0, pair: 1}}, value: {value}, atol: {atol}}}\n"
        for value in values
    ]
    (data / "anchors" / f"{name}.yaml").write_text(
        f"figure: {name}\nroute: by hand\nanchors:\n{''.join(rows)}"
    )


def test_deviation_is_relative_where_there_is_a_unit_and_absolute_for_small_numbers_without():
    assert validation.OutsideValue("x", "by hand", 200.0, 201.0, "Hz").deviation == pytest.approx(0.005)
    assert validation.OutsideValue("x", "by hand", 0.001, 0.002).deviation == pytest.approx(0.001)
    assert validation.OutsideValue("x", "by hand", -4.0, -2.0).deviation == pytest.approx(0.5)


def test_a_unit_stands_beside_the_quantity_once():
    values = [
        validation.OutsideValue("f", "by hand", 200.0, 201.0, "Hz"),
        validation.OutsideValue("x", "table", 2.0, 2.0),
    ]
    assert validation.as_markdown(values).splitlines()[2:] == [
        "| f [Hz] | by hand | 200 | 201 | 0.005 |",
        "| x | table | 2 | 2 | 0 |",
    ]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.034, "0.034"),
        (12.3, "12"),
        (456.7, "457"),
        (2e-5, r"$2.0\cdot10^{-5}$"),
        (3e4, r"$3.0\cdot10^{4}$"),
    ],
)
def test_numbers_are_written_as_readers_do(value, text):
    assert validation.readable(value) == text


def test_anchors_are_counted_by_chapter(data):
    largest = float(abs(figure()["radius"]).max())
    store(data, "ch03_first", 3.0, 3.0003)
    store(data, "ch03_second", 3.0001)
    store(data, "ch04_third", 3.0)
    third, fourth = validation.anchored(data)
    assert (third.number, third.figures, third.anchors, third.figure) == (3, 2, 3, "ch03_first")
    assert third.deviation == pytest.approx(0.0003 / largest)
    assert third.median == pytest.approx(0.0001 / largest)
    assert third.fraction == pytest.approx(0.3)
    assert (fourth.number, fourth.anchors, fourth.deviation) == (4, 1, 0.0)
    assert validation.chapters_as_markdown([third, fourth]).count("\n") == 3


def test_anchor_beyond_its_tolerance_is_refused(data):
    store(data, "ch03_first", 3.1)
    with pytest.raises(ReferenceMismatchError, match=r"ch03_first: .*independent route gives 3\.1"):
        validation.anchored(data)
