"""Figures of an assessment: what a reader needs to read a number off an axis."""

import numpy as np
import pytest
import xarray as xr

from facegear.plotting.assessment import dynamic_load


def response(largest, peak):
    """Make forces of two pairs [N] at three speeds, unstable at one, and one peak."""
    low, high = np.full((3, 2), -100.0), np.full((3, 2), largest)
    low[1], high[1] = np.nan, np.nan
    arrays = {"force_lowest": (("speed", "load"), low), "force_highest": (("speed", "load"), high)}
    peaks = {"speed": [31.0], "force_lowest": [-200.0], "force_highest": [peak]}
    arrays |= {f"peak_{name}": ("peak", values) for name, values in peaks.items()}
    return xr.Dataset(arrays, {"speed": [30.0, 32.0, 34.0]})


@pytest.mark.parametrize(
    ("largest", "peak", "scale"),
    [(3e3, 5e3, "linear"), (9e3, 1.2e4, "linear"), (3e3, 4e5, "symlog"), (9e5, 3e3, "symlog")],
)
def test_forces_can_be_read_off_their_axis(largest, peak, scale):
    """Beside zero there are at least two labels in sight, whatever the size of the forces."""
    figure = dynamic_load(response(largest, peak), static=2.6e3)
    figure.canvas.draw()
    (axes,) = figure.axes
    assert axes.get_yscale() == scale
    low, high = axes.get_ylim()
    ticks = [t for t in axes.get_yticks() if low <= t <= high and t != 0.0]
    assert len(ticks) >= 2
    assert high >= max(largest, peak) / 1e3
