"""Arrays of the report on a drive."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from facegear.drives import report_arrays, report_columns
from facegear.drives.basis import BasisStep, SettledTongues
from facegear.drives.drive_file import read_drive_file
from facegear.drives.verdict import Case
from facegear.maps.tracing import tongues
from facegear.support.parameters import rad_per_s, rpm
from tests.drives.drive_files import DRIVES

CASE_1 = read_drive_file(DRIVES / "case_1.yaml")
BOX = read_drive_file(DRIVES / "gearbox_table_7_1.yaml")
RANGE = (float(rad_per_s(500.0)), float(rad_per_s(720.0)))
FOUND = tongues(CASE_1.transverse, RANGE)


def test_tongues_and_windows_share_out_the_range():
    table = report_arrays.tongue_table(FOUND, "case 1")
    windows = report_arrays.safe_windows(table, RANGE)
    assert table["label"].values.tolist() == [tongue.label for tongue in FOUND]
    ends = np.sort(np.concatenate([part[side] for part in (table, windows) for side in ("lower", "upper")]))
    assert ends[[0, -1]] == pytest.approx([500.0, 720.0])
    np.testing.assert_allclose(ends[1:-1:2], ends[2:-1:2])
    widths = sum(float((part["upper"] - part["lower"]).sum()) for part in (table, windows))
    assert widths == pytest.approx(220.0)
    assert (windows["upper"] > windows["lower"]).all()


def test_a_name_that_netcdf_does_not_take_is_told_without_that_character():
    assert report_arrays.describe(replace(CASE_1, name="a\0b")).startswith("a\ufffdb: ")


def test_windows_of_a_stable_and_of_an_unstable_range():
    empty = report_arrays.tongue_table((), "none")
    (window,) = report_arrays.safe_windows(empty, RANGE)["lower"].values
    assert window == pytest.approx(500.0)
    inside = (FOUND[0].lower + 1e-3, FOUND[0].upper - 1e-3)
    assert report_arrays.safe_windows(
        report_arrays.tongue_table(tongues(CASE_1.transverse, inside), ""), inside
    ).sizes == {"window": 0}


def test_combinations_cross_the_mesh_frequency_in_their_tongues():
    speeds = np.linspace(500.0, 720.0, 23)
    chart = report_arrays.combinations(CASE_1.transverse, FOUND, speeds, "case 1")
    np.testing.assert_allclose(chart["mesh_frequency"], 130 * speeds / 60, rtol=1e-12)
    assert (np.diff(chart["natural_frequency"], axis=0) >= 0).all()
    for label, line in zip(chart["label"].values, chart["combination"], strict=True):
        (tongue,) = [tongue for tongue in FOUND if tongue.label == label]
        crossing = np.interp(0.0, chart["mesh_frequency"] - line, speeds)
        # The centre of the mean system lies in the tongue or, where the modulation is strong, near it.
        assert rpm(tongue.lower) - 15 < crossing < rpm(tongue.upper) + 15


def test_combinations_of_the_gearbox_has_its_natural_frequencies():
    chart = report_arrays.combinations(BOX.torsional, (), [10.0], "box")
    # All dampings are 10 µs times a stiffness: ω √(1 − (10 µs ω/2)²).
    free = BOX.torsional.natural_frequencies()
    damped = free * np.sqrt(1 - (1e-5 * free / 2) ** 2) / (2 * np.pi)
    np.testing.assert_allclose(chart["natural_frequency"][:, 0], damped, rtol=1e-4)
    assert chart.sizes["label"] == 0


def test_map_and_tongues_agree():
    table = report_arrays.tongue_table(FOUND, "")
    speeds = np.linspace(505.0, 715.0, 43)
    chart = report_arrays.growth_map(CASE_1.transverse, "stiffness", [0.5, 1.0], speeds, "case 1")
    inside = ((speeds[:, None] > table["lower"].values) & (speeds[:, None] < table["upper"].values)).any(
        axis=1
    )
    assert inside.any()
    assert (chart["growth_rate"].sel(stiffness=1.0) > 0).values.tolist() == inside.tolist()
    assert chart.attrs["parameters"] == "case 1, swept = stiffness"


def test_bases_of_all_cases_stand_in_one_table():
    steps = (BasisStep(1, 3, (), np.nan), BasisStep(2, 5, FOUND, 0.25))
    found = SettledTongues(CASE_1.transverse, RANGE, steps, settled=False)
    table = report_arrays.basis_table([Case("Tregold", "dead", found, 0.0)], "case 1")
    assert table["case_name"].values.tolist() == ["Tregold, force keeps its direction"] * 2
    assert table["unstable_share"].values == pytest.approx([0.0, found.unstable_share])
    assert report_columns.basis_columns(table)["nodal_diameters"] == [3, 5]


def test_provenance_tells_drives_apart():
    assert report_arrays.describe(CASE_1) != report_arrays.describe(BOX)
    assert isinstance(report_arrays.tongue_table(FOUND, "x"), xr.Dataset)
