"""Tables beside the page of an assessment."""

import pytest

from facegear.drives.assessment_columns import model_columns
from facegear.drives.assessment_table import model_table
from facegear.drives.shaft_modes import SettledTorsion
from facegear.floquet.labels import Combination
from facegear.maps.tracing import Tongue
from facegear.support.parameters import rad_per_s, rpm
from facegear.support.tables import write_table
from tests.drives.drive_files import rows


def test_numbers_of_models_have_the_units_of_other_tables_and_none_is_an_empty_cell(tmp_path):
    found = Tongue(*rad_per_s([95.0, 97.0, 96.0]).tolist(), 90.0, Combination(1, 8, "sum", 1))
    speeds = (float(rad_per_s(100.0)), float(rad_per_s(1000.0)))
    torsion = {
        name: SettledTorsion(None, speeds, tongues, settled=True)
        for name, tongues in (("unstable", (found,)), ("stable", ()))
    }
    table = model_table([], torsion, speeds, speeds, "of a test")
    unstable, stable = rows(write_table(model_columns(table), tmp_path / "models.csv"))
    assert float(unstable["fastest_speed_rpm"]) == pytest.approx(96.0, rel=1e-11)
    assert float(unstable["largest_growth_per_s"]) == 90.0
    assert stable["fastest_speed_rpm"] == stable["nodal_circles"] == ""
    assert "nan" not in {*unstable.values(), *stable.values()}
    # The array file has its own unit, and names it.
    assert table["fastest_speed"].attrs["units"] == "rad/s"
    assert rpm(float(table["fastest_speed"][0])) == pytest.approx(96.0, rel=1e-12)
