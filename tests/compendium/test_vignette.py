"""The picture on the title page."""

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

from compendium.plotting.vignette import DARK, LIGHT, vignette

GROWTH = np.where(np.arange(20).reshape(4, 5) % 3 == 0, 2.0, -1.0)
CHART = xr.Dataset(
    {"growth_rate": (("stiffness", "speed_rpm"), GROWTH)},
    {"stiffness": np.linspace(0.5, 2.0, 4), "speed_rpm": np.linspace(10.0, 1000.0, 5)},
)
# The backgrounds of the theme.
PAGES = {"light": (LIGHT, "#ffffff"), "dark": (DARK, "#14181e")}


def luminance(colours):
    colours = np.asarray(colours)[..., :3]
    linear = np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


@pytest.mark.parametrize("theme", PAGES)
def test_unstable_cells_are_coloured_and_stable_ones_left_open(theme):
    figure = vignette(CHART, PAGES[theme][0])
    figure.canvas.draw()
    (mesh,) = figure.axes[0].collections
    shown = mesh.get_array().reshape(GROWTH.shape)
    assert np.ma.getmaskarray(shown).tolist() == (GROWTH <= 0).tolist()
    assert figure.patch.get_alpha() == figure.axes[0].patch.get_alpha() == 0.0


@pytest.mark.parametrize("theme", PAGES)
def test_colours_stand_off_the_page_and_go_one_way(theme):
    look, page = PAGES[theme]
    paper = luminance(mpl.colors.to_rgb(page))
    row = luminance(look.growth(np.linspace(0, 1, 64)))
    steps = np.diff(row)
    assert (steps < 1e-3).all() or (steps > -1e-3).all()
    contrast = (np.maximum(row, paper) + 0.05) / (np.minimum(row, paper) + 0.05)
    assert contrast.min() > 1.3
    ink = luminance(mpl.colors.to_rgb(look.ink))
    assert (max(ink, paper) + 0.05) / (min(ink, paper) + 0.05) > 7
