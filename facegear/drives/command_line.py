"""The command line of `facegear`: what can be asked for, with help and examples, and numbers that cannot be meant."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from facegear import __version__
from facegear.drives.commands import assess_drive, check, examples, explore, new, report, stability_map
from facegear.drives.contacts import NAMES
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.examples import example_names
from facegear.drives.keys import MOST_CELLS, Key, plain

T = TypeVar("T")

# More than any machine has processors: each takes a hundred megabytes.
_MOST_PROCESSES = 1024
_CODES = "exit codes: 0 done, 1 a file cannot be used, 2 the command cannot be understood, 130 interrupted"


class _Parser(argparse.ArgumentParser):
    """A parser that shows its examples as they are written."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)


def parser() -> argparse.ArgumentParser:
    """Make the parser of the command."""
    top = _Parser(
        prog="facegear",
        description="The stability of a face-gear drive: where it shakes itself apart, and what to change.",
        epilog=f"""\
examples:
  facegear new my_drive.yaml          write a drive file, asking what is needed
  facegear check my_drive.yaml        can it be used?
  facegear report my_drive.yaml       the verdict, in my_drive_results/report.html
  facegear assess my_drive.yaml       and under every model that could change it

`facegear COMMAND --help` has examples of each.
{_CODES}""",
    )
    top.add_argument("--version", action="version", version=f"facegear {__version__}")
    commands = top.add_subparsers(title="commands", metavar="COMMAND", required=True, parser_class=_Parser)
    _add_new(commands)
    _add_examples(commands)
    _add_check(commands)
    _add_report(commands)
    _add_assess(commands)
    _add_map(commands)
    _add_explore(commands)
    return top


def _command(commands: Any, name: str, run: Any, does: str, examples: str) -> argparse.ArgumentParser:
    made: argparse.ArgumentParser = commands.add_parser(
        name,
        help=does,
        description=f"{does[0].upper()}{does[1:]}{'' if does.endswith('?') else '.'}",
        epilog=f"examples:\n{examples}\n\n{_CODES}",
    )
    made.set_defaults(run=run)
    return made


def _add_report(commands: Any) -> None:
    command = _command(
        commands,
        "report",
        report,
        "verdict, tables, maps and meshes of a drive",
        """\
  facegear report my_drive.yaml
  facegear report my_drive.yaml --output results
  facegear report my_drive.yaml --most-steps 1 --cells 20     a first look, in a fraction of the time""",
    )
    _add_file_and_output(command, "results")
    command.add_argument(
        "--cells", type=_whole(1, MOST_CELLS), default=60, help="speeds and values of the maps (%(default)s)"
    )
    command.add_argument(
        "--tolerance",
        type=_given(float, "a number from 1e-6 to 0.5", lambda number: 1e-6 <= number <= 0.5),
        default=0.02,
        help="part of the speeds that may still move from one basis to the next (%(default)s)",
    )
    command.add_argument(
        "--most-steps", type=_whole(1, 100), default=5, help="bases that are tried (%(default)s)"
    )
    _add_jobs(command)


def _add_assess(commands: Any) -> None:
    command = _command(
        commands,
        "assess",
        assess_drive,
        "verdict under every model that could change it, and within tolerances",
        """\
  facegear assess my_drive.yaml
  facegear assess my_drive.yaml --output results --jobs 2

A first verdict comes within seconds, the page in some minutes for one pinion. Tolerances are a section of the file.""",
    )
    _add_file_and_output(command, "assessment")
    _add_jobs(command)


def _add_check(commands: Any) -> None:
    command = _command(
        commands,
        "check",
        check,
        "can a drive file be used?",
        """\
  facegear check my_drive.yaml
  facegear check drives/*.yaml""",
    )
    command.add_argument("files", metavar="FILE", nargs="+", help="drive file (YAML)")


def _add_map(commands: Any) -> None:
    command = _command(
        commands,
        "map",
        stability_map,
        "stability map over speed and one number of a drive file",
        """\
  facegear map my_drive.yaml
  facegear map my_drive.yaml --parameter thickness_ratio --from 0.02 --to 0.06
  facegear map my_drive.yaml --parameter power_kW --force dead --output power.svg power.csv
  facegear map gearbox.yaml --parameter input_stiffness_Nm_per_rad --speeds 400 900

The map holds for the basis that the file names (nodal_circles, nodal_diameters), for one contact and one direction of
the driving force; `facegear report` raises the basis and takes all of them.""",
    )
    command.add_argument("file", metavar="FILE", help="drive file (YAML)")
    command.add_argument(
        "--parameter",
        metavar="KEY",
        default="stiffness",
        help="key of the drive file that is swept (%(default)s)",
    )
    number = _given(float, "a finite number", math.isfinite)
    unit = "in the unit of the key; %s times the file's own if left out"
    command.add_argument("--from", dest="lowest", metavar="VALUE", type=number, help=unit % "half")
    command.add_argument("--to", dest="highest", metavar="VALUE", type=number, help=unit % "one and a half")
    command.add_argument(
        "--speeds",
        nargs=2,
        metavar=("LOW", "HIGH"),
        type=number,
        help="of the face gear [rpm]; those of the file if left out",
    )
    command.add_argument(
        "--cells", type=_whole(2, MOST_CELLS), default=60, help="values and speeds (%(default)s)"
    )
    command.add_argument("--contact", choices=tuple(NAMES), default="", help="that of the file if left out")
    command.add_argument(
        "--force",
        choices=("follower", "dead"),
        default="follower",
        help="the driving force follows the bent rim or keeps its direction (%(default)s)",
    )
    command.add_argument(
        "--output",
        nargs="+",
        metavar="FILE",
        type=_place,
        help="netCDF (.nc), table (.csv), picture (.svg, .png, .pdf); FILE_map.nc, .csv and .svg beside the drive file "
        "if left out; a file is replaced only if an earlier map wrote it",
    )
    _add_jobs(command)


def _add_explore(commands: Any) -> None:
    command = _command(
        commands,
        "explore",
        explore,
        "controls and a stability map to click on, in a browser",
        """\
  facegear explore                    the example case_1
  facegear explore my_drive.yaml
  facegear explore --no-browser --port 8866

It runs on this machine (Voilà) until it is interrupted, and needs `pip install "facegear[explore]"`.""",
    )
    command.add_argument(
        "file", metavar="FILE", nargs="?", help="drive file where the controls stand at first"
    )
    command.add_argument("--port", type=_whole(1, 65535), help="that it listens on; a free one if left out")
    command.add_argument("--no-browser", action="store_true", help="do not open a browser")


def _add_new(commands: Any) -> None:
    command = _command(
        commands,
        "new",
        new,
        "write a drive file with comments, asking for what is not given",
        """\
  facegear new my_drive.yaml          asks, on a terminal
  facegear new my_drive.yaml --pinion-teeth 26 --gear-teeth 130 --module-mm 3.175 --thickness-ratio 0.03 \\
      --bore-radius-mm 50 --stiffness 1 --damping-us 3 --mass 1 --angles-deg 0 120 --lowest-speed-rpm 100 \\
      --highest-speed-rpm 1000 --power-kW 447 --pinion-speed-rpm 5000""",
    )
    command.add_argument(
        "file", metavar="FILE", nargs="?", type=_place, default=Path("my_drive.yaml"), help="(%(default)s)"
    )
    command.add_argument("--replace", action="store_true", help="replace a file that is there")
    command.add_argument("--name", help=f"{NAME.meaning}; that of the file if left out")
    for name, section in SECTIONS.items():
        group = command.add_argument_group(name, plain(section.meaning).replace("%", "%%"))
        for key in section.keys:
            many = "*" if key.kind in ("numbers", "choices") else None
            group.add_argument(
                _flag(key),
                dest=f"key_{key.name}",
                nargs=many,
                metavar=key.unit or "VALUE",
                help=_help_of(key),
            )


def _add_examples(commands: Any) -> None:
    command = _command(
        commands,
        "examples",
        examples,
        "drive files that come with facegear",
        """\
  facegear examples                          lists them
  facegear examples case_1 > my_drive.yaml
  facegear examples --schema > drive.schema.json     JSON Schema, for editors""",
    )
    what = command.add_mutually_exclusive_group()
    what.add_argument("name", metavar="NAME", nargs="?", choices=example_names())
    what.add_argument("--schema", action="store_true", help="print the JSON Schema of drive files")


def _flag(key: Key) -> str:
    return f"--{key.name.replace('_', '-')}"


def _help_of(key: Key) -> str:
    """Meaning and valid values, in words that argparse takes for no format."""
    default = "" if key.default is None else f"; {_listed(key.default)} if left out"
    return f"{key.plain_meaning}: {key.valid}{default}".replace("%", "%%")


def _listed(value: Any) -> str:
    return " ".join(f"{entry:g}" for entry in value) or "none" if isinstance(value, tuple) else str(value)


def _add_file_and_output(command: argparse.ArgumentParser, kind: str) -> None:
    command.add_argument("file", metavar="FILE", help="drive file (YAML)")
    command.add_argument(
        "--output",
        metavar="FOLDER",
        type=_place,
        help=f"where it goes; FILE_{kind} beside the file if left out",
    )


def _add_jobs(command: argparse.ArgumentParser) -> None:
    words = f"a whole number from 1 to {_MOST_PROCESSES}, or -1 for one on each processor"
    command.add_argument(
        "--jobs",
        type=_given(int, words, lambda number: number == -1 or 1 <= number <= _MOST_PROCESSES),
        default=-1,
        help="processes; -1 for one on each processor (%(default)s)",
    )


def _given(kind: Callable[[str], T], words: str, is_valid: Callable[[T], bool]) -> Callable[[str], T]:
    """Make what turns an argument into a number; of any other text it says what would be one."""

    def number(text: str) -> T:
        with suppress(ValueError):
            if is_valid(value := kind(text)):
                return value
        raise argparse.ArgumentTypeError(f"must be {words}, got {text!r}")

    return number


def _whole(lowest: int, highest: int) -> Callable[[str], int]:
    return _given(
        int, f"a whole number from {lowest} to {highest}", lambda number: lowest <= number <= highest
    )


def _place(text: str) -> Path:
    """Path of a file or folder; no text is none, although it would be the current folder."""
    if not text.strip():
        raise argparse.ArgumentTypeError(f"must be a path, got {text!r}")
    return Path(text)
