"""References are replaced where something moved, and only there."""

import pytest

from compendium import reference
from facegear.support import labelled
from tests.compendium.test_reference import figure
from tools import update_references


@pytest.fixture
def folders(tmp_path, monkeypatch):
    stored, new = tmp_path / "reference", tmp_path / "new"
    monkeypatch.setattr(update_references, "REFERENCE", stored)
    return stored, new


def test_the_same_numbers_keep_the_commit_that_made_them(folders, monkeypatch, capsys):
    stored, new = folders
    with monkeypatch.context() as patch:
        patch.setattr(labelled, "made_by", lambda: {"facegear_version": "0.0", "facegear_commit": "a" * 40})
        before = labelled.save(figure(), stored / "fig.nc").read_bytes()
    update_references.replace(labelled.save(figure(), new / "fig.nc"))
    assert (stored / "fig.nc").read_bytes() == before
    assert capsys.readouterr().out == "fig.nc: 0 of 4 arrays moved\n"


def test_what_moved_is_told_and_replaced(folders, capsys):
    stored, new = folders
    labelled.save(figure(), stored / "fig.nc")
    changed = figure(0.5).assign_attrs(parameters="pinion_teeth = 27")
    changed["teeth"].attrs["units"] = "teeth"
    update_references.replace(labelled.save(changed, new / "fig.nc"))
    told = capsys.readouterr().out
    assert "fig.nc: 3 of 5 arrays moved" in told
    assert "(dataset): reworded in parameters: 'pinion_teeth = 27', stored 'pinion_teeth = 26'" in told
    assert "radius: largest change 0.5" in told
    assert "teeth: reworded in units: 'teeth', stored '1'" in told
    reference.compare(changed, labelled.load(stored / "fig.nc"))


def test_a_file_that_cannot_be_used_is_replaced(folders, capsys):
    stored, new = folders
    labelled.save(figure(), stored / "fig.nc").write_bytes(b"CDF")
    update_references.replace(labelled.save(figure(), new / "fig.nc"))
    assert "fig.nc: replaced, 4 arrays\n  array file fig.nc is truncated" in capsys.readouterr().out
    labelled.load(stored / "fig.nc")
