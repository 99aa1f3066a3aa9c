"""The explorer of a drive file: what is explored is the file, and what is saved is what was explored."""

import ast

import pytest

from facegear.drives import explorer, live
from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.drives.examples import example_names, example_text
from facegear.drives.file_study import file_study, study_of
from facegear.drives.studies.drive import drive_study
from facegear.drives.studies.oscillator import oscillator_study
from facegear.drives.studies.study import shown_only
from facegear.drives.verdict import driven
from facegear.drives.widgets import typed

examples = pytest.mark.parametrize("name", example_names())


def first_model(file, following="follower"):
    return driven(file, following, next(iter(file.contacts.values())))


@examples
def test_it_starts_as_the_file_and_is_saved_as_the_file(name):
    file = parse_drive(example_text(name))
    study = file_study(file)
    assert study.model(study.settings()) == first_model(file)
    again = parse_drive(study.drive_text(study.settings()))
    assert first_model(again) == first_model(file)
    assert (again.requirements, again.torsional, again.teeth) == (
        file.requirements,
        file.torsional,
        file.teeth,
    )


def test_controls_change_the_file():
    study = file_study(parse_drive(example_text("example_b")))
    changes = {
        "gear_teeth": 150,
        "stiffness": 0.5,
        "angle_2": 90.0,
        "contact_ratio": "geometric",
        "force_at": "tooth",
    }
    settings = study.settings(changes | {"following": "keeps its direction", "power_kW": 200.0})
    saved = parse_drive(study.drive_text(settings))
    assert saved.drive.gear_teeth == 150
    assert saved.content["pinions"]["angles_deg"] == [0.0, 90.0]
    assert saved.requirements.power == 2e5
    assert study.model(settings) == first_model(saved, "dead")
    assert saved.force_at == "tooth"


def test_what_the_file_would_not_take_is_told_in_its_words():
    study = study_of(None)
    with pytest.raises(DriveFileError, match=r"these settings: gears\.gear_teeth"):
        study.model(study.settings({"pinion_teeth": 60, "gear_teeth": 50}))


@examples
def test_every_slider_has_its_value_among_its_steps(name):
    study = file_study(parse_drive(example_text(name)))
    for control in (*study.controls, study.speed):
        if hasattr(control, "step"):
            steps = (control.value - control.lowest) / control.step
            assert steps == pytest.approx(round(steps), abs=1e-6), control.name


class TestSaving:
    @pytest.fixture
    def widget(self, tmp_path):
        from dataclasses import replace

        study = replace(shown_only(drive_study(), ["stiffness", "power", "module"]), columns=3, rows=3)
        return explorer.MapExplorer(study, tmp_path)

    def test_the_drive_as_it_stands(self, widget, tmp_path):
        widget.controls["power"].value = 300.0
        widget.name.value = "mine.yaml"
        widget.save.click()
        assert "Saved: " in widget.saved.value
        saved = read_drive_file(tmp_path / "mine.yaml")
        model = widget.study.model(widget.settings)
        assert first_model(saved).load == model.load
        assert first_model(saved).force.newtons(saved.drive) == pytest.approx(
            model.force.newtons(model.body.drive)
        )
        assert saved.drive == model.body.drive

    def test_nothing_is_replaced_and_no_folder_is_left(self, widget, tmp_path):
        (tmp_path / "mine.yaml").write_text("mine", encoding="utf-8")
        widget.controls["power"].value = 300.0
        for name, told in (
            ("mine.yaml", "is there already"),
            ("../mine.yaml", "without a folder"),
            ("mine.txt", "ending in .yaml"),
        ):
            widget.save_as(name)
            assert told in widget.saved.value
        assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]

    def test_a_drive_without_power_is_none_of_a_file(self, widget, tmp_path):
        widget.save.click()
        assert "Not saved: these settings: operation.power_kW must lie in" in widget.saved.value
        assert not list(tmp_path.iterdir())

    def test_what_is_no_drive_has_no_button(self):
        study = oscillator_study()
        widget = explorer.MapExplorer(study)
        assert widget.save not in widget.widget.children[0].children
        with pytest.raises(ValueError, match="settings must be those of a drive"):
            study.drive_text(study.settings())


def test_the_notebook_of_the_command_is_that_of_the_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = live.notebook("it's.yaml")
    (cell,) = made["cells"]
    (call,) = [node for node in ast.walk(ast.parse("".join(cell["source"]))) if isinstance(node, ast.Call)][
        :1
    ]
    assert call.keywords[0].value.value == str(tmp_path)
    assert call.args[0].args[0].value == str(tmp_path / "it's.yaml")
    import nbformat

    nbformat.validate(nbformat.from_dict(made))


def test_labels_are_words_without_raw_subscripts_and_power_goes_down_to_what_a_file_takes():
    study = study_of(None)
    labels = {control.name: control.label for control in study.controls}
    assert not [label for label in labels.values() if "_" in label]
    assert labels["pinion_teeth"] == "teeth of the pinion"
    (power,) = [control for control in study.controls if control.name == "power_kW"]
    assert power.lowest < 0.01 * power.value


def test_a_power_of_nothing_is_refused_with_the_reason():
    (power,) = [control for control in study_of(None).controls if control.name == "power_kW"]
    with pytest.raises(ValueError, match=r"must lie between .* got 0: a drive in a file transmits power"):
        typed(power, "0")
