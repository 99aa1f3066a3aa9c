"""The command `facegear`: a thin face on functions that others can call.

Exit codes: 0 done; 1 a file cannot be used, or a place not written to; 2 the command cannot be understood; 130
interrupted. Results go to standard output, progress and complaints to standard error.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import signal
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from facegear import __version__
from facegear.drives.contacts import NAMES
from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.drives.drive_keys import NAME, SECTIONS
from facegear.drives.drive_schema import schema
from facegear.drives.drive_text import drive_text, write_drive_file
from facegear.drives.examples import about, example_names, example_text
from facegear.drives.keys import Key, plain
from facegear.drives.new_drive import all_keys, completed, missing, value_in

DONE, REFUSED, MISUSED, INTERRUPTED = 0, 1, 2, 130

_CODES = "exit codes: 0 done, 1 a file cannot be used, 2 the command cannot be understood, 130 interrupted"


class UsageError(ValueError):
    """Arguments of the command do not go together."""


class _Parser(argparse.ArgumentParser):
    """A parser that shows its examples as they are written."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows `facegear`; that of this process if left out.

    Returns
    -------
    int
        The exit code.
    """
    # A request to end is an interruption: what is half-written goes, and so do workers.
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        options = parser().parse_args(arguments)
        with warnings.catch_warnings():
            # joblib replaces a worker that has come to hold much memory, and goes on.
            warnings.filterwarnings("ignore", "A worker stopped while some jobs", UserWarning)
            return int(options.run(options))
    except UsageError as problem:
        _say(f"facegear: error: {problem}")
        return MISUSED
    except BrokenPipeError:
        # Whoever read the output, `head` for one, has enough; nothing more can be said there.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return REFUSED
    except (DriveFileError, OSError, ArithmeticError) as problem:
        _say(str(problem))
        return REFUSED
    except KeyboardInterrupt:
        _say("Interrupted: nothing was left half-written.")
        return INTERRUPTED
    finally:
        signal.signal(signal.SIGTERM, before)


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt


def _say(line: str) -> None:
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()


def _tell(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


# --- what can be asked for ----------------------------------------------------------------------------------------


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
        _report,
        "verdict, tables, maps and meshes of a drive",
        """\
  facegear report my_drive.yaml
  facegear report my_drive.yaml --output results
  facegear report my_drive.yaml --most-steps 1 --cells 20     a first look, in a fraction of the time""",
    )
    _add_file_and_output(command, "results")
    command.add_argument(
        "--cells", type=_whole, default=60, help="speeds and values of the maps (%(default)s)"
    )
    command.add_argument(
        "--tolerance",
        type=_part,
        default=0.02,
        help="part of the speeds that may still move from one basis to the next (%(default)s)",
    )
    command.add_argument("--most-steps", type=_whole, default=5, help="bases that are tried (%(default)s)")
    _add_jobs(command)


def _add_assess(commands: Any) -> None:
    command = _command(
        commands,
        "assess",
        _assess,
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
        _check,
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
        _map,
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
    unit = "in the unit of the key; %s times the file's own if left out"
    command.add_argument("--from", dest="lowest", metavar="VALUE", type=float, help=unit % "half")
    command.add_argument("--to", dest="highest", metavar="VALUE", type=float, help=unit % "one and a half")
    command.add_argument(
        "--speeds",
        nargs=2,
        metavar=("LOW", "HIGH"),
        type=float,
        help="of the face gear [rpm]; those of the file if left out",
    )
    command.add_argument("--cells", type=_whole, default=60, help="values and speeds (%(default)s)")
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
        type=Path,
        help="netCDF (.nc), table (.csv), picture (.svg, .png, .pdf); FILE_map.nc, .csv and .svg beside the drive file "
        "if left out",
    )
    _add_jobs(command)


def _add_explore(commands: Any) -> None:
    command = _command(
        commands,
        "explore",
        _explore,
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
    command.add_argument("--port", type=_whole, help="that it listens on; a free one if left out")
    command.add_argument("--no-browser", action="store_true", help="do not open a browser")


def _add_new(commands: Any) -> None:
    command = _command(
        commands,
        "new",
        _new,
        "write a drive file with comments, asking for what is not given",
        """\
  facegear new my_drive.yaml          asks, on a terminal
  facegear new my_drive.yaml --pinion-teeth 26 --gear-teeth 130 --module-mm 3.175 --thickness-ratio 0.03 \\
      --bore-radius-mm 50 --stiffness 1 --damping-us 3 --mass 1 --angles-deg 0 120 --lowest-speed-rpm 100 \\
      --highest-speed-rpm 1000 --power-kW 447 --pinion-speed-rpm 5000""",
    )
    command.add_argument(
        "file", metavar="FILE", nargs="?", type=Path, default=Path("my_drive.yaml"), help="(%(default)s)"
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
        _examples,
        "drive files that come with facegear",
        """\
  facegear examples                          lists them
  facegear examples case_1 > my_drive.yaml
  facegear examples --schema > drive.schema.json     JSON Schema, for editors""",
    )
    command.add_argument("name", metavar="NAME", nargs="?", choices=("", *example_names()), default="")
    command.add_argument("--schema", action="store_true", help="print the JSON Schema of drive files")


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
        type=Path,
        help=f"where it goes; FILE_{kind} beside the file if left out",
    )


def _add_jobs(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--jobs", type=_processes, default=-1, help="processes; -1 for one on each processor (%(default)s)"
    )


def _whole(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, got {number}")
    return number


def _processes(text: str) -> int:
    number = int(text)
    if number == 0:
        raise argparse.ArgumentTypeError("must be at least 1, or -1 for one on each processor, got 0")
    return number


def _part(text: str) -> float:
    number = float(text)
    if not 1e-6 <= number <= 0.5:
        raise argparse.ArgumentTypeError(f"must be 1e-6 to 0.5, got {text}")
    return number


# --- what is done -------------------------------------------------------------------------------------------------


def _report(options: argparse.Namespace) -> int:
    file = read_drive_file(options.file)
    # These take longer to load than a mistake takes to be told.
    from facegear.drives.findings import Findings
    from facegear.drives.report_files import results_directory, write_report

    folder = options.output or results_directory(options.file)
    _require_folder(folder)
    found = Findings(file, options.cells, options.tolerance, options.most_steps, options.jobs, _say)
    page = write_report(found, folder, _say)
    _tell(f"The report: {page.resolve().as_uri()}")
    return DONE


def _assess(options: argparse.Namespace) -> int:
    file = read_drive_file(options.file)
    # These take longer to load than a mistake takes to be told.
    from facegear.drives.assess import assess
    from facegear.drives.assessment_files import write_assessment
    from facegear.drives.report_files import results_directory

    folder = options.output or results_directory(options.file, "assessment")
    _require_folder(folder)
    found = assess(file, jobs=options.jobs, tell=_say)
    page = write_assessment(found, folder)
    _tell(found.headline)
    _tell(f"The assessment: {page.resolve().as_uri()}")
    return DONE


def _require_folder(folder: Path) -> None:
    """Refuse a place that results cannot be written to before they are computed."""
    there = next(place for place in (folder.absolute(), *folder.absolute().parents) if place.exists())
    if not there.is_dir() or not os.access(there, os.W_OK | os.X_OK):
        raise UsageError(f"--output must be a folder that can be written to, got {str(folder)!r}")


def _check(options: argparse.Namespace) -> int:
    code = DONE
    for name in options.files:
        try:
            file = read_drive_file(name)
        except DriveFileError as problem:
            _say(str(problem))
            code = REFUSED
            continue
        _tell(f"{name}: can be used")
        for sentence in file.not_buildable:
            _tell(f"{name}: cannot be built as a solid shaft: {sentence}")
    return code


def _map(options: argparse.Namespace) -> int:
    file = read_drive_file(options.file)
    # These take longer to load than a mistake takes to be told.
    from facegear.drives.sweeps import WRITERS, sweep

    beside = Path(options.file)
    outputs = options.output or [
        beside.with_name(f"{beside.stem}_map{end}") for end in (".nc", ".csv", ".svg")
    ]
    for path in outputs:
        if path.suffix not in WRITERS:
            raise UsageError(f"--output must end in {', '.join(WRITERS)}, got {str(path)!r}")
    try:
        found = sweep(
            file,
            options.parameter,
            lowest=options.lowest,
            highest=options.highest,
            speeds_rpm=options.speeds,
            cells=options.cells,
            contact=options.contact,
            following=options.force,
            jobs=options.jobs,
        )
    except ValueError as problem:
        raise UsageError(str(problem)) from problem
    for path in outputs:
        WRITERS[path.suffix](found, path)
        _tell(f"The map: {path}")
    return DONE


def _new(options: argparse.Namespace) -> int:
    path: Path = options.file
    if path.exists() and not options.replace:
        raise UsageError(f"{path} is there already: choose another name, or say --replace")
    content: dict[str, Any] = {NAME.name: path.stem if options.name is None else options.name}
    for section, key in all_keys():
        given = getattr(options, f"key_{key.name}")
        if given is not None:
            typed = " ".join(given) if isinstance(given, list) else given
            content.setdefault(section, {})[key.name] = value_in(typed, key)
    if sys.stdin.isatty():
        content = completed(content, _ask, _say)
    elif lacking := missing(content):
        names = ", ".join(re.sub(r"\w+\.(\w+)", _flag_in, each) for each in lacking)
        raise UsageError(f"without a terminal to ask on, give {names}")
    try:
        file = parse_drive(drive_text(content), str(path))
    except DriveFileError as problem:
        raise UsageError(str(problem)) from problem
    write_drive_file(file, path)
    _tell(f"Written: {path}. Next: facegear report {path}")
    return DONE


def _flag_in(path: re.Match[str]) -> str:
    """Flag of the key at a dotted path."""
    return f"--{path[1].replace('_', '-')}"


def _ask(question: str) -> str:
    sys.stderr.write(question)
    sys.stderr.flush()
    answer = sys.stdin.readline()
    if not answer:
        raise KeyboardInterrupt
    return answer.strip()


def _examples(options: argparse.Namespace) -> int:
    if options.schema:
        _tell(json.dumps(schema(), indent=2, ensure_ascii=False))
    elif options.name:
        sys.stdout.write(example_text(options.name))
    else:
        for name in example_names():
            _tell(f"{name}\n    {about(name)}")
    return DONE


def _explore(options: argparse.Namespace) -> int:
    from facegear.drives.live import serve, uninstalled

    if lacking := uninstalled():
        _say(f'facegear explore needs {", ".join(lacking)}: pip install "facegear[explore]"')
        return REFUSED
    from facegear.drives.file_study import study_of

    study_of(options.file)  # What cannot be explored is told here, not in a browser.
    return serve(options.file, options.port, browser=not options.no_browser)
