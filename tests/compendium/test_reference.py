"""Stored arrays: what is saved comes back, and nothing damaged, edited or out of tolerance is accepted."""

import shutil
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from compendium import reference
from facegear.support import labelled

STORED = Path(__file__).resolve().parents[2] / "data" / "reference"


def figure(offset=0.0):
    return xr.Dataset(
        {
            "radius": labelled.variable(
                ("speed", "pair"), np.arange(6.0).reshape(3, 2) + offset, "Radius", "m", 0, 1e-9
            ),
            "teeth": labelled.variable("pair", np.array([25, 26]), "Teeth", "1"),
        },
        coords={"speed": [1.0, 2.0, 3.0], "pair": [0, 1]},
        attrs={"parameters": "pinion_teeth = 26"},
    )


def test_round_trip_is_exact(tmp_path):
    stored = labelled.load(labelled.save(figure(), tmp_path / "fig.nc"))
    assert all(row.agrees and row.largest_absolute == 0.0 for row in reference.difference(figure(), stored))
    assert stored["radius"].attrs["units"] == "m"


def table_of(names):
    count = np.arange(len(names))
    return xr.Dataset(
        {
            "lower": labelled.variable("tongue", 1.0 * count, "Lower border", "rpm", 0, 1e-3),
            "many": labelled.variable(("tongue", "speed"), np.ones((len(names), 2)), "Many", "1", 0, 1e-3),
            "number": labelled.variable("tongue", count, "Number", "1"),
            "mesh": labelled.variable("speed", [3.0, 4.0], "Mesh frequency", "Hz", 0, 1e-3),
        },
        coords={
            "tongue": count,
            "speed": [1.0, 2.0],
            "label": labelled.text("tongue", names, "Label"),
            "empty": labelled.text("speed", ["", ""], "Nothing"),
        },
        attrs={"parameters": "", "note": "=1+1; <b>\n° µ 齿轮"},
    )


NAMES = ["mean 2", "(1+1)/1", "", " a; b\n", "ζ° 齿轮", "<img src=x>", "=1+1"]


@pytest.mark.parametrize("names", [[], [""], NAMES], ids=["none", "one empty", "any text"])
def test_tables_and_their_text_come_back(tmp_path, names):
    table = table_of(names)
    path = labelled.save(table, tmp_path / "table.nc")
    stored = labelled.load(path)
    assert all(row.agrees and row.largest_absolute == 0.0 for row in reference.compare(table, stored))
    assert stored["label"].values.tolist() == names
    assert stored.sizes == table.sizes
    assert set(stored.coords) == set(table.coords)
    assert stored.attrs["note"] == table.attrs["note"]
    assert not any(name.startswith("length_of_") for name in stored.attrs)
    # Other readers take a dimension of length 0 for the one that can grow.
    with xr.open_dataset(path, engine="scipy") as raw:
        assert min(raw.sizes.values()) > 0
        assert ("length_of_tongue" in raw.attrs) == (not names)


@pytest.mark.parametrize("names", [[], ["(1+1)/1", "mean 2"]], ids=["none", "two"])
def test_an_axis_of_text_comes_back(tmp_path, names):
    chart = xr.Dataset(
        {"line": labelled.variable(("label", "speed"), np.ones((len(names), 2)), "Line", "Hz", 0, 1e-3)},
        coords={"label": labelled.text("label", names, "Label"), "speed": [1.0, 2.0]},
        attrs={"parameters": "none"},
    )
    stored = labelled.load(labelled.save(chart, tmp_path / "chart.nc"))
    reference.compare(chart, stored)
    assert stored["label"].values.tolist() == names
    assert stored["line"].shape == (len(names), 2)


@pytest.mark.parametrize("wrong", ["a\x00", "\x00b", "a\ud800"])
def test_text_that_would_not_come_back_is_refused(tmp_path, wrong):
    for table, place in (
        (table_of(["x"]).assign_attrs(parameters=wrong), "attribute 'parameters' = "),
        (table_of([f"{wrong}."]), "coordinate 'label' = "),
        (with_attribute("mesh", long_name=wrong)(table_of(["x"])), "attribute 'long_name' of 'mesh' = "),
    ):
        with pytest.raises(ValueError, match=place):
            labelled.save(table, tmp_path / "table.nc")
    assert list(tmp_path.iterdir()) == []


def test_nan_is_a_value_that_agrees_with_itself_only(tmp_path):
    with_gap = figure()
    with_gap["radius"][0, 0] = np.nan
    stored = labelled.load(labelled.save(with_gap, tmp_path / "fig.nc"))
    reference.compare(with_gap, stored)
    with pytest.raises(reference.ReferenceMismatchError, match=r"'radius' is inf off at speed = 1, pair = 0"):
        reference.compare(figure(), stored)


@pytest.mark.parametrize("offset", [2e-9, -1.0, np.nan])
def test_beyond_tolerance_is_refused(tmp_path, offset):
    stored = labelled.load(labelled.save(figure(), tmp_path / "fig.nc"))
    with pytest.raises(reference.ReferenceMismatchError, match="fig: 1 of 4 arrays disagree; 'radius'"):
        reference.compare(figure(offset), stored, "fig")


def test_within_tolerance_is_accepted(tmp_path):
    stored = labelled.load(labelled.save(figure(), tmp_path / "fig.nc"))
    (row,) = [row for row in reference.compare(figure(5e-10), stored) if row.name == "radius"]
    assert row.exceedance == pytest.approx(0.5, rel=1e-6)


def test_new_removed_and_reshaped_variables_are_named(tmp_path):
    stored = labelled.load(labelled.save(figure(), tmp_path / "fig.nc"))
    computed = figure().isel(speed=slice(2)).rename(teeth="tooth_count")
    changes = {row.name: row.change for row in reference.difference(computed, stored)}
    assert changes == {
        "pair": "compared",
        "radius": "reshaped",
        "speed": "reshaped",
        "teeth": "removed",
        "tooth_count": "new",
    }


def test_other_parameters_are_refused(tmp_path):
    stored = labelled.load(labelled.save(figure(), tmp_path / "fig.nc"))
    with pytest.raises(reference.ReferenceMismatchError, match="pinion_teeth = 31"):
        reference.compare(figure().assign_attrs(parameters="pinion_teeth = 31"), stored)


def other_labels(data):
    return data.assign_coords(label=data["label"].str.replace("(1+", "(9-", regex=False))


def with_attribute(variable, **values):
    def plant(data):
        data[variable].attrs |= values
        return data

    return plant


FAULTS = {
    "labels": other_labels,
    "one label": lambda data: data.assign_coords(
        label=data["label"].where(data["label"] != "(1+8)/3", "(1+8)/4")
    ),
    "no labels": lambda data: data.drop_vars("label"),
    "parameters": lambda data: data.assign_attrs(parameters=data.attrs["parameters"].replace("130", "131")),
    "no parameters": lambda data: data.drop_attrs(deep=False),
    "another statement": lambda data: data.assign_attrs(scale="log"),
    "unit": with_attribute("growth_rate", units="1/min"),
    "sentence": with_attribute("lower", long_name="Upper border"),
    "sentence of a coordinate": with_attribute("label", long_name="Nothing"),
    "looser tolerance": with_attribute("growth_rate", rtol=1e-3),
    "tighter tolerance": with_attribute("peak", atol=0.01),
    "number": lambda data: data.assign(peak=data["peak"] + 0.2),
    "grid": lambda data: data.assign_coords(speed_rpm=data["speed_rpm"] * (1 + 1e-9)),
    "section": lambda data: data.isel(section=slice(1, None)),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_every_kind_of_fault_in_a_figure_is_seen(fault):
    stored = labelled.load(STORED / "ch04_figure_4_04a.nc")
    reference.compare(stored.copy(deep=True), stored)
    with pytest.raises(reference.ReferenceMismatchError, match=r"^fig: \d+ of \d+ arrays disagree"):
        reference.compare(FAULTS[fault](stored.copy(deep=True)), stored, "fig")


def test_what_was_reworded_is_told():
    stored = labelled.load(STORED / "ch04_figure_4_04a.nc")
    with pytest.raises(
        reference.ReferenceMismatchError,
        match=r"'label' is reworded at section = 0\.125, tongue = 0: '\(9-4\)/1', stored '\(1\+4\)/1'",
    ):
        reference.compare(other_labels(stored), stored)
    changed = with_attribute("lower", units="1/s")(stored.copy(deep=True))
    with pytest.raises(reference.ReferenceMismatchError, match=r"reworded in units: '1/s', stored 'rpm'"):
        reference.compare(changed, stored)


def test_who_made_the_arrays_is_written_and_not_compared(tmp_path):
    path = labelled.save(figure(), tmp_path / "fig.nc")
    stored = labelled.load(path)
    assert stored.attrs["facegear_version"] == version("facegear")
    assert stored.attrs["numpy_version"] == np.__version__
    others = dict.fromkeys(
        ("facegear_version", "facegear_commit", "numpy_version", "xarray_version"), "other"
    )
    reference.compare(stored.assign_attrs(others), stored)
    again = labelled.load(labelled.save(stored.assign_attrs(others), tmp_path / "again.nc"))
    assert again.attrs["figure"] == "again"
    assert "other" not in again.attrs.values()


def test_a_file_in_the_place_of_another_is_refused(tmp_path):
    shutil.copy(labelled.save(figure(), tmp_path / "fig.nc"), tmp_path / "other.nc")
    with pytest.raises(labelled.ArrayFileError, match=r"other\.nc holds the arrays of 'fig'"):
        labelled.load(tmp_path / "other.nc")


def test_missing_file_is_named(tmp_path):
    with pytest.raises(labelled.ArrayFileError, match=r"fig\.nc is missing"):
        labelled.load(tmp_path / "fig.nc")


@pytest.mark.parametrize("keep", [0.05, 0.4, 0.97])
def test_truncated_file_is_refused(tmp_path, keep):
    path = labelled.save(figure(), tmp_path / "fig.nc")
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * keep)])
    with pytest.raises(labelled.ArrayFileError, match="truncated"):
        labelled.load(path)


def test_no_flipped_byte_changes_what_is_read(tmp_path):
    path = labelled.save(figure(), tmp_path / "fig.nc")
    whole, content = labelled.load(path), path.read_bytes()
    refused = 0
    for position in range(0, len(content), 5):
        damaged = bytearray(content)
        damaged[position] ^= 0x10
        path.write_bytes(damaged)
        try:
            found = labelled.load(path)
        except labelled.ArrayFileError:
            refused += 1
        else:  # what fills up to four bytes, and the like
            assert found.identical(whole), position
    assert refused > 0.9 * len(content) / 5


def test_file_of_another_program_is_refused(tmp_path):
    path = tmp_path / "fig.nc"
    figure().to_netcdf(path, engine="scipy")
    with pytest.raises(labelled.ArrayFileError, match="no digest"):
        labelled.load(path)


def test_variable_without_tolerance_cannot_be_saved(tmp_path):
    dataset = xr.Dataset({"radius": ("x", [1.0], {"long_name": "Radius", "units": "m"})})
    with pytest.raises(ValueError, match="'radius' lacks the attribute"):
        labelled.save(dataset, tmp_path / "fig.nc")
    assert list(tmp_path.iterdir()) == []


def test_rows_of_different_length_are_filled_up():
    found = [[SimpleNamespace(label="(1+1)/1", lower=2.0), SimpleNamespace(label="(1+2)/1", lower=3.0)], []]
    np.testing.assert_allclose(labelled.filled_rows(found, "lower"), [[2.0, 3.0], [np.nan, np.nan]])
    labels = labelled.filled_labels(found)
    assert labels.tolist() == [["(1+1)/1", "(1+2)/1"], ["", ""]]
    assert labelled.label_rows(xr.DataArray(labels)) == [["(1+1)/1", "(1+2)/1"], []]
    assert labelled.filled_labels([[]]).shape == (1, 1)
    assert labelled.filled_labels([]).shape == (0, 1)
    assert labelled.filled_rows([[]], "lower").shape == (1, 1)
    assert labelled.filled_rows([], "lower").shape == (0, 1)
