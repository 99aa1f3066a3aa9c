"""Stored arrays: what is saved comes back, and nothing damaged, edited or out of tolerance is accepted."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from facegear import reference


def figure(offset=0.0):
    return xr.Dataset(
        {
            "radius": reference.variable(
                ("speed", "pair"), np.arange(6.0).reshape(3, 2) + offset, "Radius", "m", 0, 1e-9
            ),
            "teeth": reference.variable("pair", np.array([25, 26]), "Teeth", "1"),
        },
        coords={"speed": [1.0, 2.0, 3.0], "pair": [0, 1]},
        attrs={"parameters": "pinion_teeth = 26"},
    )


def test_round_trip_is_exact(tmp_path):
    stored = reference.load(reference.save(figure(), tmp_path / "fig.nc"))
    assert all(row.agrees and row.largest_absolute == 0.0 for row in reference.difference(figure(), stored))
    assert stored["radius"].attrs["units"] == "m"


def test_nan_is_a_value_that_agrees_with_itself_only(tmp_path):
    with_gap = figure()
    with_gap["radius"][0, 0] = np.nan
    stored = reference.load(reference.save(with_gap, tmp_path / "fig.nc"))
    reference.compare(with_gap, stored)
    with pytest.raises(reference.ReferenceMismatchError, match=r"'radius' is inf off at speed = 1, pair = 0"):
        reference.compare(figure(), stored)


@pytest.mark.parametrize("offset", [2e-9, -1.0, np.nan])
def test_beyond_tolerance_is_refused(tmp_path, offset):
    stored = reference.load(reference.save(figure(), tmp_path / "fig.nc"))
    with pytest.raises(reference.ReferenceMismatchError, match="fig: 1 of 4 arrays disagree; 'radius'"):
        reference.compare(figure(offset), stored, "fig")


def test_within_tolerance_is_accepted(tmp_path):
    stored = reference.load(reference.save(figure(), tmp_path / "fig.nc"))
    (row,) = [row for row in reference.compare(figure(5e-10), stored) if row.name == "radius"]
    assert row.exceedance == pytest.approx(0.5, rel=1e-6)


def test_new_removed_and_reshaped_variables_are_named(tmp_path):
    stored = reference.load(reference.save(figure(), tmp_path / "fig.nc"))
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
    stored = reference.load(reference.save(figure(), tmp_path / "fig.nc"))
    with pytest.raises(reference.ReferenceMismatchError, match="pinion_teeth = 31"):
        reference.compare(figure().assign_attrs(parameters="pinion_teeth = 31"), stored)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(reference.ReferenceFileError, match=r"fig\.nc is missing"):
        reference.load(tmp_path / "fig.nc")


@pytest.mark.parametrize("keep", [0.05, 0.4, 0.97])
def test_truncated_file_is_refused(tmp_path, keep):
    path = reference.save(figure(), tmp_path / "fig.nc")
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * keep)])
    with pytest.raises(reference.ReferenceFileError, match="truncated"):
        reference.load(path)


def test_every_flipped_data_byte_is_noticed(tmp_path):
    path = reference.save(figure(), tmp_path / "fig.nc")
    content = bytearray(path.read_bytes())
    noticed = 0
    for position in range(len(content) - 48, len(content)):  # the 6 radii stand last
        damaged = bytearray(content)
        damaged[position] ^= 0x10
        path.write_bytes(damaged)
        with pytest.raises(reference.ReferenceFileError):
            reference.load(path)
        noticed += 1
    assert noticed == 48


def test_file_of_another_program_is_refused(tmp_path):
    path = tmp_path / "fig.nc"
    figure().to_netcdf(path, engine="scipy")
    with pytest.raises(reference.ReferenceFileError, match="no digest"):
        reference.load(path)


def test_variable_without_tolerance_cannot_be_saved(tmp_path):
    dataset = xr.Dataset({"radius": ("x", [1.0], {"long_name": "Radius", "units": "m"})})
    with pytest.raises(ValueError, match="'radius' lacks the attribute"):
        reference.save(dataset, tmp_path / "fig.nc")
    assert list(tmp_path.iterdir()) == []


def test_rows_of_different_length_are_filled_up():
    found = [[SimpleNamespace(label="(1+1)/1", lower=2.0), SimpleNamespace(label="(1+2)/1", lower=3.0)], []]
    np.testing.assert_allclose(reference.filled_rows(found, "lower"), [[2.0, 3.0], [np.nan, np.nan]])
    assert reference.label_lines(found) == "(1+1)/1 (1+2)/1\n"
    assert reference.filled_rows([[]], "lower").shape == (1, 1)
    assert reference.filled_rows([], "lower").shape == (0, 1)
