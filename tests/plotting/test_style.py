"""The look of figures: a minus sign before each number that Matplotlib does not write itself."""

import pytest
from matplotlib.figure import Figure

from facegear.plotting.style import styled, with_minus_signs


@pytest.mark.parametrize(
    ("written", "shown"),
    [
        ("-0.25", "−0.25"),
        ("-.5 °", "−.5 °"),
        ("from -360 to -0.1", "from −360 to −0.1"),
        ("growth, -3 per cent", "growth, −3 per cent"),
        ("(-1, 2)", "(−1, 2)"),
        ("(17-1)/1", "(17-1)/1"),
        ("Fig. 4-4, E-5, 1e-05", "Fig. 4-4, E-5, 1e-05"),
        ("$x^{-2}$ and -2", "$x^{-2}$ and −2"),
        ("$-2$", "$-2$"),
        ("5 $ -2", "5 $ −2"),
        ("one-sided", "one-sided"),
    ],
)
def test_a_hyphen_before_a_number_becomes_a_minus_sign(written, shown):
    assert with_minus_signs(written) == shown


@styled
def drawn() -> Figure:
    figure = Figure()
    axes = figure.subplots()
    axes.plot([-1.0, 1.0], [-2.0, 2.0], label="at -2")
    axes.text(0.0, 0.0, "-1.50")
    axes.annotate("at -7", (0.5, 0.5))
    axes.set_title("from -1 to 1")
    axes.set_xticks([-1.0, 1.0], ["-1 h", "1 h"])
    above = axes.secondary_xaxis("top")
    above.set_xticks([-1.0, 1.0], ["-5", "5"])
    axes.legend()
    return figure


def test_all_texts_of_a_figure_have_them_and_so_have_ticks_with_names():
    figure = drawn()
    figure.canvas.draw()
    texts = {text.get_text() for text in figure.findobj(lambda part: hasattr(part, "get_text"))}
    assert {"at −2", "−1.50", "at −7", "from −1 to 1", "−1 h", "−5"} <= texts
    assert not any("-" in text for text in texts)
