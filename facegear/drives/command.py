"""The command `facegear`: a thin face on functions that others can call.

Exit codes: 0 done; 1 a file cannot be used, or a place not written to; 2 the command cannot be understood; 130
interrupted. Results go to standard output, progress and complaints to standard error.
"""

from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from facegear import __version__
from facegear.drives.drive_file import DriveFileError, read_drive_file

DONE, REFUSED, MISUSED, INTERRUPTED = 0, 1, 2, 130

_CODES = "exit codes: 0 done, 1 a file cannot be used, 2 the command cannot be understood, 130 interrupted"


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
        return int(options.run(options))
    except (DriveFileError, OSError) as problem:
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

`facegear COMMAND --help` has examples of each.
{_CODES}""",
    )
    top.add_argument("--version", action="version", version=f"facegear {__version__}")
    commands = top.add_subparsers(title="commands", metavar="COMMAND", required=True, parser_class=_Parser)
    _add_report(commands)
    _add_check(commands)
    return top


def _command(commands: Any, name: str, run: Any, does: str, examples: str) -> argparse.ArgumentParser:
    made: argparse.ArgumentParser = commands.add_parser(
        name,
        help=does,
        description=f"{does[0].upper()}{does[1:]}.",
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
    command.add_argument("file", metavar="FILE", help="drive file (YAML)")
    command.add_argument(
        "--output",
        metavar="FOLDER",
        type=Path,
        help="where it goes; FILE_results beside the file if left out",
    )
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


def _add_jobs(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--jobs", type=int, default=-1, help="processes; -1 for one on each processor (%(default)s)"
    )


def _whole(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"must be at least 1, got {number}")
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
    found = Findings(file, options.cells, options.tolerance, options.most_steps, options.jobs)
    page = write_report(found, folder, _say)
    _tell(f"The report: {page.resolve().as_uri()}")
    return DONE


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
