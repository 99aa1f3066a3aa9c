"""What the commands `check`, `new`, `map` and `examples` do."""

import io
import json
import re
import shutil
import sys

import pytest

from facegear.drives import commands, map_files, sweeps
from facegear.drives.command import main
from facegear.drives.drive_file import read_drive_file
from facegear.drives.drive_schema import schema
from facegear.support.labelled import load
from tests.drives.drive_files import CASE_1, DRIVES, rows

EXAMPLES = sorted(DRIVES.glob("*.yaml"))


def test_there_are_eight_examples_and_all_can_be_used(capsys):
    assert main(["check", *map(str, EXAMPLES)]) == 0
    told = capsys.readouterr().out.splitlines()
    assert told == [f"{path}: can be used" for path in EXAMPLES]
    assert len(EXAMPLES) == 8


def test_one_wrong_file_does_not_keep_the_others_from_being_checked(here, capsys):
    shutil.copy(EXAMPLES[0], here / "right.yaml")
    assert main(["check", "none.yaml", "right.yaml"]) == 1
    out, err = capsys.readouterr()
    assert out == "right.yaml: can be used\n"
    assert "none.yaml' cannot be read" in err


def test_teeth_that_yield_are_told(here, capsys):
    (here / "strong.yaml").write_text(re.sub("power_kW: .*", "power_kW: 100000", CASE_1), encoding="utf-8")
    assert main(["check", "strong.yaml"]) == 0
    used, yields = capsys.readouterr().out.splitlines()
    assert used == "strong.yaml: can be used"
    stress, allowed = map(float, re.search(r"stress (\S+) MPa, allowable (\S+) MPa", yields).groups())
    # That of 447.42 kW is 249.8 MPa; 440 MPa over a safety factor of 1.5.
    assert stress == pytest.approx(249.806 * 100000 / 447.42, rel=1e-3)
    assert allowed == pytest.approx(440 / 1.5, rel=1e-3)


FLAGS = [
    "--pinion-teeth",
    "26",
    "--gear-teeth",
    "130",
    "--module-mm",
    "3.175",
    "--thickness-ratio",
    "0.03",
    "--bore-radius-mm",
    "50",
    "--stiffness",
    "1",
    "--damping-us",
    "3",
    "--mass",
    "1",
    "--angles-deg",
    "-10",
    "120",
    "--lowest-speed-rpm",
    "100",
    "--highest-speed-rpm",
    "1000",
    "--power-kW",
    "447",
    "--pinion-speed-rpm",
    "5000",
]


def test_a_new_file_from_flags(here, capsys):
    assert main(["new", "my.yaml", *FLAGS]) == 0
    assert capsys.readouterr().out == "Written: my.yaml. Next: facegear report my.yaml\n"
    file = read_drive_file(here / "my.yaml")
    assert (file.name, file.drive.pinion_teeth, file.drive.module) == ("my", 26, 3.175e-3)
    assert file.transverse.gear.pinion_angles == pytest.approx((-0.174532925, 2.094395102))
    assert "# pressure_angle_deg: 25.0" in (here / "my.yaml").read_text(encoding="utf-8")


def test_a_file_that_is_there_is_not_replaced_unless_told(here, capsys):
    (here / "my.yaml").write_text("mine", encoding="utf-8")
    assert main(["new", "my.yaml", *FLAGS]) == 2
    assert "my.yaml is there already" in capsys.readouterr().err
    assert (here / "my.yaml").read_text(encoding="utf-8") == "mine"
    assert main(["new", "my.yaml", "--replace", *FLAGS]) == 0
    assert read_drive_file(here / "my.yaml").drive.gear_teeth == 130


def test_what_a_new_file_lacks_is_named_by_its_flags(here, capsys, monkeypatch):
    monkeypatch.setattr(sys, "stdin", (here / "nothing").open("w+"))
    assert main(["new", "--pinion-teeth", "26"]) == 2
    err = capsys.readouterr().err
    assert "give --gear-teeth, --module-mm or --diametral-pitch-per-inch, --thickness-ratio," in err
    assert main(["new", *FLAGS, "--gear-teeth", "20"]) == 2
    assert "my_drive.yaml: " in capsys.readouterr().err
    assert not (here / "my_drive.yaml").exists()
    sys.stdin.close()


def test_on_a_terminal_it_asks_until_answers_can_be_used(here, capsys, monkeypatch):
    # Pointed teeth, too few for the gear, a comma, a bore that is too large, each asked for again at once.
    answers = [
        "11",
        "26",
        "20",
        "130",
        "3,175",
        "3.175",
        "0.03",
        "400",
        "50",
        "1",
        "3",
        "1",
        "100",
        "90",
        "1000",
        "447",
        "5000",
    ]
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(commands, "ask", lambda question: asked.append(question) or answers.pop(0))
    asked = []
    assert main(["new", "my.yaml", "--name", "Mine"]) == 0
    assert not answers
    assert asked[0] == "gears.pinion_teeth: N_1, teeth of the pinion (a whole number from 10 to 300)? "
    err = capsys.readouterr().err
    assert "a point, not a comma: 3.175" in err
    assert "gears.gear_teeth must be greater than gears.pinion_teeth = 26, got 20\n" in err
    assert (
        "operation.highest_speed_rpm must be greater than operation.lowest_speed_rpm = 100, got 90\n" in err
    )
    assert "body.bore_radius_mm must lie between" in err
    assert "gears.pinion_teeth=11 is too few" in err
    assert [question.partition(":")[0] for question in asked][:10] == [
        "gears.pinion_teeth",
        "gears.pinion_teeth",
        "gears.gear_teeth",
        "gears.gear_teeth",
        "gears.module_mm",
        "gears.module_mm",
        "body.thickness_ratio",
        "body.bore_radius_mm",
        "body.bore_radius_mm",
        "pinions.stiffness",
    ]
    assert (read_drive_file("my.yaml").name, read_drive_file("my.yaml").drive.gear_teeth) == ("Mine", 130)


def test_an_end_of_input_leaves_nothing(here, monkeypatch, capsys):
    monkeypatch.setattr(sys, "stdin", io.StringIO("26\n"))
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    assert main(["new", "my.yaml"]) == 130
    assert not list(here.iterdir())


def test_a_map_in_three_kinds_of_files(here, capsys):
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    words = [
        "--parameter",
        "thickness_ratio",
        "--from",
        "0.02",
        "--to",
        "0.06",
        "--speeds",
        "500",
        "600",
        "--cells",
        "3",
        "--jobs",
        "1",
    ]
    assert main(["map", "my.yaml", *words]) == 0
    assert capsys.readouterr().out == "".join(f"The map: my_map{end}\n" for end in (".nc", ".csv", ".svg"))
    chart = load(here / "my_map.nc")
    assert chart["thickness_ratio"].values == pytest.approx([0.02, 0.04, 0.06])
    assert len(rows(here / "my_map.csv")) == 9
    assert main(["map", "my.yaml", *words, "--output", "a/b.png"]) == 0
    assert (here / "a" / "b.png").read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("--parameter no_such", "parameter must be one of module_mm"),
        ("--from 2 --to 1", "from and to must ascend"),
        ("--from 2", "--to must be given for stiffness = 1: half and one and a half times the file's own"),
        (
            "--parameter bore_radius_mm --from 10 --to 500",
            "with bore_radius_mm = 10 mm: body.bore_radius_mm must lie in [11.5969, 188.433] in mm, got 10 mm",
        ),
        (
            "--parameter bore_radius_mm --from 12 --to 200",
            "with bore_radius_mm = 200 mm: body.bore_radius_mm must lie in [11.5969, 188.433] in mm, got 200 mm",
        ),
        (
            "--parameter module_mm --from 0.2 --to 9",
            "with module_mm = 0.2 mm: body.bore_radius_mm must lie in [",
        ),
        ("--output map.xls", "--output must end in .nc, .csv, .svg, .png, .pdf, got 'map.xls'"),
        (
            "--output my.yaml/map.csv",
            "--output must be a file that can be written, got 'my.yaml/map.csv': Not a dir",
        ),
        ("--contact loaded", "contact must be tregold or geometric"),
    ],
)
def test_a_map_that_there_is_not(here, capsys, words, told):
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    assert main(["map", "my.yaml", *words.split()]) == 2
    assert told in capsys.readouterr().err
    assert [path.name for path in here.iterdir()] == ["my.yaml"]


@pytest.mark.parametrize("end", list(map_files.WRITERS))
def test_a_file_that_no_map_wrote_is_not_replaced(here, capsys, monkeypatch, end):
    """`echo precious > p.csv; facegear map --output p.csv` replaced it."""

    def computes(*_, **__):
        raise AssertionError("something was computed")

    monkeypatch.setattr(sweeps, "sweep", computes)
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    (here / f"p{end}").write_text("precious\n", encoding="utf-8")
    assert main(["map", "my.yaml", "--cells", "2", "--output", "other.csv", f"p{end}"]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert f"--output must be a file that can be written, got 'p{end}': p{end} is there and would be" in told
    assert (here / f"p{end}").read_text(encoding="utf-8") == "precious\n"
    assert sorted(path.name for path in here.iterdir()) == ["my.yaml", f"p{end}"]


def test_an_earlier_map_is_replaced(here, capsys):
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    for most in ("600", "700"):
        assert main(["map", "my.yaml", "--cells", "2", "--speeds", "500", most, "--jobs", "1"]) == 0
        assert load(here / "my_map.nc")["speed_rpm"].values.tolist() == [500.0, float(most)]


def test_a_map_that_is_interrupted_leaves_no_file_of_three(here, monkeypatch):
    (here / "my.yaml").write_text(CASE_1, encoding="utf-8")
    older = "mass,speed_rpm,growth_rate_per_s\n"
    (here / "my_map.csv").write_text(older)

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(map_files, "WRITERS", dict(map_files.WRITERS) | {".svg": interrupted})
    assert main(["map", "my.yaml", "--cells", "2", "--speeds", "500", "600", "--jobs", "1"]) == 130
    assert sorted(path.name for path in here.iterdir()) == ["my.yaml", "my_map.csv"]
    assert (here / "my_map.csv").read_text() == older


def test_examples_are_listed_and_printed(capsys):
    assert main(["examples"]) == 0
    assert re.findall(r"^\w+$", capsys.readouterr().out, re.MULTILINE) == [path.stem for path in EXAMPLES]
    assert main(["examples", "case_1"]) == 0
    assert capsys.readouterr().out == CASE_1
    assert main(["examples", "--schema"]) == 0
    assert json.loads(capsys.readouterr().out) == schema()


def test_what_flags_gave_is_not_blamed_for_what_is_not_known_yet(here, capsys, monkeypatch):
    """A bore of 500 mm is too large for the gear of any example, and right for this one."""
    answers = ["26", "130", "16", "0.03", "1", "3", "1", "20", "200", "447", "5000"]
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(commands, "ask", lambda _: answers.pop(0))
    assert main(["new", "my.yaml", "--bore-radius-mm", "500"]) == 0
    assert not answers
    assert capsys.readouterr().err == ""
    assert read_drive_file("my.yaml").transverse.gear.body.bore_radius == pytest.approx(0.5)


def test_an_answer_stands_for_the_same_in_two_units(here, capsys, monkeypatch):
    answers = ["3.175"]
    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(commands, "ask", lambda _: answers.pop(0))
    assert main(["new", "my.yaml", *FLAGS, "--diametral-pitch-per-inch", "9"]) == 0
    assert (
        "gears.module_mm = 3.175 and gears.diametral_pitch_per_inch = 9 say the same"
        in capsys.readouterr().err
    )
    assert read_drive_file("my.yaml").drive.module == 3.175e-3
