"""The command line: what it refuses, its help."""

import re

import pytest

import facegear
import facegear.__main__
from facegear.drives.command import main


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "the following arguments are required: COMMAND"),
        (["reprot", "a.yaml"], "invalid choice: 'reprot'"),
        (["report"], "the following arguments are required: FILE"),
        (["report", "a.yaml", "--cells", "0"], "--cells: must be a whole number from 1 to 1000, got '0'"),
        # 74.5 GiB.
        (
            ["map", "a.yaml", "--cells", "100000"],
            "--cells: must be a whole number from 2 to 1000, got '100000'",
        ),
        (["map", "a.yaml", "--cells", "1.5"], "--cells: must be a whole number from 2 to 1000, got '1.5'"),
        (["map", "a.yaml", "--from", "x"], "--from: must be a finite number, got 'x'"),
        (["map", "a.yaml", "--speeds", "1", "nan"], "--speeds: must be a finite number, got 'nan'"),
        (["report", "a.yaml", "--tolerance", "2"], "must be a number from 1e-6 to 0.5, got '2'"),
        (["report", "a.yaml", "--jobs", "x"], "from 1 to 1024, or -1 for one on each processor, got 'x'"),
        (["assess", "a.yaml", "--jobs", "-5"], "from 1 to 1024, or -1 for one on each processor, got '-5'"),
        (["assess", "a.yaml", "--jobs", "0"], "from 1 to 1024, or -1 for one on each processor, got '0'"),
        (["assess", "a.yaml", "--output", ""], "--output: must be a path, got ''"),
        (["map", "a.yaml", "--output", " "], "--output: must be a path, got ' '"),
        (["explore", "--port", "70000"], "--port: must be a whole number from 1 to 65535, got '70000'"),
        (["examples", "nope"], "argument NAME: invalid choice: 'nope' (choose from 'both_faces', "),
        (["examples", "--schema", "case_1"], "argument NAME: not allowed with argument --schema"),
    ],
)
def test_what_cannot_be_understood(arguments, told, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    said = capsys.readouterr().err
    assert told in said
    # Names of functions of the program are none of a user.
    assert not re.search(r"invalid \w+ value|\b_\w", said)


def test_version(capsys):
    with pytest.raises(SystemExit) as caught:
        main(["--version"])
    assert caught.value.code == 0
    assert capsys.readouterr().out == f"facegear {facegear.__version__}\n"


def test_each_command_has_examples_and_exit_codes(capsys):
    with pytest.raises(SystemExit):
        main(["--help"])
    names = re.findall(r"^    (\w+)  +\w", capsys.readouterr().out, re.MULTILINE)
    assert {"report", "check"} <= set(names)
    for name in names:
        with pytest.raises(SystemExit):
            main([name, "--help"])
        told = capsys.readouterr().out
        assert f"examples:\n  facegear {name}" in told
        assert "exit codes: 0 done, 1 a file cannot be used" in told
