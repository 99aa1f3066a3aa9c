"""The page of a report: everything shown is text, nothing is fetched, what fails says so."""

import html.parser
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from facegear.drives.page import (
    Listing,
    Paragraph,
    Picture,
    Section,
    Table,
    as_html,
    attempted,
    page,
)

HOSTILE = """<img src=x onerror="window.p=1"> $x^2$ {ref}`a` [l](javascript:0)
# B | c"""


class Reader(html.parser.HTMLParser):
    """Reads a piece of HTML: its elements, their attributes and its text."""

    def __init__(self, page):
        super().__init__()
        self.elements, self.attributes, self.text = [], [], ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append(tag)
        self.attributes += attributes

    def handle_data(self, data):
        self.text += data


@given(st.text(min_size=1, max_size=80))
def test_text_of_a_file_stays_text(words):
    read = Reader(as_html(words))
    assert read.elements == ["span"]
    assert len(read.text) == len(words)
    assert all(shown in (given_, " ") for shown, given_ in zip(read.text, words, strict=True))
    assert "\n" not in read.text


def picture(caption, alt):
    figure = Figure()
    figure.subplots().plot([0, 1], [0, 1])
    return Picture(figure, caption, alt)


EVERYWHERE = Section(
    HOSTILE,
    (
        Paragraph(HOSTILE, "bad", strong=True),
        Listing((HOSTILE,)),
        Table((HOSTILE,), ((HOSTILE,),), HOSTILE),
        picture(HOSTILE, HOSTILE),
    ),
)


def test_hostile_text_is_text_wherever_it_stands():
    made = page(HOSTILE, [EVERYWHERE])
    read = Reader(made)
    assert read.elements.count("img") == 1
    assert not {"script", "iframe", "object", "embed", "link"} & set(read.elements)
    assert not [name for name, _ in read.attributes if name.startswith("on")]
    (source,) = [value for name, value in read.attributes if name == "src"]
    assert source.startswith("data:image/svg+xml;base64,")
    one_line = HOSTILE.replace("\n", " ")
    # Title, heading, contents, heading of the section, paragraph, cell and its heading, caption; not in the list, where
    # what is in backticks is code.
    assert read.text.count(one_line) == 8
    assert ("alt", one_line) in read.attributes
    assert all(value.startswith("#") for name, value in read.attributes if name == "href")


def test_the_page_forbids_itself_scripts_and_the_network():
    read = Reader(page("A", [EVERYWHERE]))
    policy, _ = (value for name, value in read.attributes if name == "content")
    assert policy == "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
    assert re.search(r"Made by facegear \d+\.\d+\.\d+", read.text)


def test_a_picture_is_the_same_each_time():
    assert picture("a", "b").as_html() == picture("a", "b").as_html()


def test_a_file_name_in_backticks_is_code():
    read = Reader(Listing(("`a.csv` (2 kB)",)).as_html())
    assert read.elements == ["ul", "li", "code", "span"]
    assert read.text == "a.csv (2 kB)"


@pytest.mark.parametrize("problem", [ArithmeticError("x < y"), ValueError("x < y"), OSError("x < y")])
def test_a_section_that_fails_says_why(problem):
    def fails():
        raise problem

    section = attempted("Maps", fails)
    assert section.title == "Maps"
    assert "the others could: x < y" in Reader(section.as_html()).text
    assert attempted("Maps", lambda: EVERYWHERE) is EVERYWHERE


def test_a_mistake_of_ours_is_no_section():
    def fails():
        raise KeyError("x")

    with pytest.raises(KeyError):
        attempted("Maps", fails)


def test_a_table_shows_the_sign_of_a_negative_number_and_keeps_hyphens():
    shown = Table(("change", "width"), (("half-way", "-3.02"), ("(2-1)/1", "4")), "Changes").as_html()
    assert "\N{MINUS SIGN}3.02" in shown
    assert "half-way" in shown
    assert "(2-1)/1" in shown
