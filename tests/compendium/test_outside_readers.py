"""What the project writes is opened by readers that others use: netCDF-C and pandas."""

from pathlib import Path

import netCDF4
import numpy as np
import pandas as pd
import pytest
import xarray as xr

from compendium import ledger_tables, printed
from facegear.design.changes import effects_of_changes
from facegear.drives import report_arrays
from facegear.drives.assessment import Assessment
from facegear.drives.assessment_files import write_assessment
from facegear.drives.disk_response import DiskResponse
from facegear.drives.drive_file import parse_drive
from facegear.drives.examples import example_text
from facegear.drives.export import write_points
from facegear.drives.outcome import Outcome
from facegear.drives.variants import Variant
from facegear.geometry.drive import Drive
from facegear.geometry.solids import tooth_surface
from facegear.mechanics.gearboxes import FIGURES
from facegear.support import labelled
from facegear.support.tables import write_table
from tests.compendium.test_printed import ENTRY
from tests.compendium.test_reference import NAMES, table_of

STORED = sorted((Path(__file__).resolve().parents[2] / "data" / "reference").glob("*.nc"))


def opened_by_netcdf_c(path):
    """Arrays by name, text as text, nothing masked."""
    with netCDF4.Dataset(path) as file:
        assert min(dimension.size for dimension in file.dimensions.values()) > 0
        file.set_auto_mask(False)
        attributes = {name: file.getncattr(name) for name in file.ncattrs()}
        return {name: variable[:] for name, variable in file.variables.items()}, attributes


def assert_same(path):
    ours = labelled.load(path)
    theirs, attributes = opened_by_netcdf_c(path)
    assert set(theirs) == set(ours.variables)
    for name, values in theirs.items():
        # Two readers of the same bytes, text among them.
        np.testing.assert_array_equal(values, ours[name].values, err_msg=name)  # noqa: TID251
    assert attributes["figure"] == path.stem
    assert attributes.get("parameters") == ours.attrs.get("parameters")


@pytest.mark.parametrize("step", [8, pytest.param(1, marks=pytest.mark.slow)], ids=["some", "all"])
def test_every_stored_array_is_read_by_netcdf_c(step):
    assert len(STORED) > 100
    for path in STORED[::step]:
        assert_same(path)


@pytest.mark.parametrize("names", [[""], NAMES], ids=["one", "many"])
def test_tables_are_read_by_netcdf_c(tmp_path, names):
    assert_same(labelled.save(table_of(names), tmp_path / "table.nc"))


WITHOUT_ROWS = {
    "any": lambda: table_of([]),
    "tongues": lambda: report_arrays.tongue_table((), "Case I"),
    "changes": lambda: effects_of_changes(FIGURES["7.12a"].model(), (), (20.0, 21.0), "Fig. 7.12"),
}


@pytest.mark.parametrize("name", WITHOUT_ROWS)
def test_a_table_without_rows_is_read_by_netcdf_c(tmp_path, name):
    table = WITHOUT_ROWS[name]()
    path = labelled.save(table, tmp_path / "table.nc")
    theirs, attributes = opened_by_netcdf_c(path)
    assert set(theirs) == set(table.variables)
    (marked,) = (name for name in attributes if name.startswith("length_of_"))
    assert attributes[marked] == 0
    for variable, values in theirs.items():
        if marked == f"length_of_{table[variable].dims[0]}":
            assert len(values) == 1
            assert np.asarray(values).ravel()[0] in ("", -2147483647) or np.isnan(values).all()


@pytest.mark.parametrize("names", [[], NAMES[:5]], ids=["none", "many"])
def test_tables_are_read_by_pandas(tmp_path, names):
    columns = {"tongue": names, "angle_°": [0.5 * k for k in range(len(names))]}
    frame = pd.read_csv(write_table(columns, tmp_path / "table.csv"), keep_default_na=False)
    assert list(frame.columns) == ["tongue", "angle_°"]
    assert frame["tongue"].tolist() == names
    assert frame["angle_°"].tolist() == columns["angle_°"]


def test_files_of_an_assessment_are_read_by_netcdf_c_and_pandas(tmp_path):
    """With and without a response, in torsion too; every file beside the page."""
    file = parse_drive(example_text("gearbox_table_7_1"))
    model = file.transverse
    variants = [
        Variant("=Tregold", "force keeps its direction", teeth, model) for teeth in ("rigid", "on springs")
    ]
    peaks = {
        f"peak_{name}": ("peak", [1.0]) for name in ("speed", "force_rms", "force_lowest", "force_highest")
    }
    forces = {
        f"force_{name}": (("speed", "load"), [[1.0], [np.nan]])
        for name in ("mean", "rms", "lowest", "highest")
    }
    data = xr.Dataset(
        forces | peaks | {"peak_label": ("peak", ["1/1"]), "peak_load": ("peak", [0])},
        {"speed": [60.0, 61.0]},
        {"at_borders": 0},
    )
    found = Assessment(
        file,
        tuple(Outcome(variant, (), True) for variant in variants),
        {},
        {},
        data,
        "",
        (),
        (DiskResponse(variants[0], 0.0, None, "rigid teeth"), DiskResponse(variants[1], 1e-6, data, "")),
    )
    folder = write_assessment(found, tmp_path / "assessment").parent
    arrays = sorted(path.name for path in folder.glob("*.nc"))
    assert arrays == [
        "disk_response.nc",
        "disk_response_peaks.nc",
        "models.nc",
        "torsion_response.nc",
        "torsion_response_peaks.nc",
    ]
    for name in arrays:
        assert_same(folder / name)
    models, response = (pd.read_csv(folder / f"{name}.csv") for name in ("models", "disk_response"))
    assert models["contact"].tolist() == ["'=Tregold"] * 2
    assert response["force_rms_of_what_varies_N"].tolist()[0] == 1.0
    assert response["force_rms_of_what_varies_N"].isna().tolist() == [False, True]
    assert response["speed_rpm"].tolist() == pytest.approx([572.957795131, 582.507091716])
    assert sorted(path.suffix for path in folder.iterdir()) == [".csv"] * 3 + [".html"] + [".nc"] * 5


def test_points_of_a_tooth_are_read_by_pandas(tmp_path):
    surface = tooth_surface(Drive(26, 130, 3.175e-3), 3, 2)
    frame = pd.read_csv(write_points(surface, tmp_path / "points.csv"))
    found = frame[["x_mm", "y_mm", "z_mm"]].to_numpy() / 1e3
    np.testing.assert_allclose(found, surface.points.reshape(-1, 3), rtol=1e-11, atol=1e-15)


def test_the_ledger_is_read_by_pandas(tmp_path):
    entry = printed.PrintedValue(**ENTRY)
    rows = printed.ledger((entry,), {entry.id: 231.94})
    frame = pd.read_csv(ledger_tables.save_csv({3: rows}, tmp_path / "ledger.csv"), dtype={"printed": str})
    assert frame["printed"].tolist() == [entry.printed]
    assert frame["computed"].tolist() == [231.94]
    assert frame["unit"].tolist() == [entry.unit]
