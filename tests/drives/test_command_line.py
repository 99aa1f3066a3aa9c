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
        (["report", "a.yaml", "--cells", "0"], "must be at least 1, got 0"),
        (["report", "a.yaml", "--tolerance", "2"], "must be 1e-6 to 0.5, got 2"),
    ],
)
def test_what_cannot_be_understood(arguments, told, capsys):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert told in capsys.readouterr().err


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
