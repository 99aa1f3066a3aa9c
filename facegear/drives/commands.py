"""What each command of `facegear` does, once its arguments are understood.

Results go to standard output, progress and complaints to standard error; each returns its exit code.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from facegear.drives.drive_file import DriveFileError, parse_drive, read_drive_file
from facegear.drives.drive_keys import NAME
from facegear.drives.drive_schema import schema
from facegear.drives.drive_text import drive_text, write_drive_file
from facegear.drives.examples import about, example_names, example_text
from facegear.drives.new_drive import all_keys, completed, missing, value_in
from facegear.drives.refusals import told
from facegear.support.files import files_written_whole

DONE, REFUSED, MISUSED, INTERRUPTED = 0, 1, 2, 130


class UsageError(ValueError):
    """Arguments of the command do not go together."""


def say(line: str) -> None:
    """Write a line of progress, or a complaint."""
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()


def tell(line: str) -> None:
    """Write a line of what was asked for."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def report(options: argparse.Namespace) -> int:
    """Write the report on a drive."""
    file = read_drive_file(options.file)
    # These take longer to load than a mistake takes to be told.
    from facegear.drives.findings import Findings
    from facegear.drives.report_files import FILES, results_directory, write_report

    folder = options.output or results_directory(options.file)
    _require_folder(folder, FILES)
    found = Findings(file, options.cells, options.tolerance, options.most_steps, options.jobs, say)
    page = write_report(found, folder, say)
    tell(f"The report: {page.resolve().as_uri()}")
    return DONE


def assess_drive(options: argparse.Namespace) -> int:
    """Write the assessment of a drive under every model that could change its verdict."""
    file = read_drive_file(options.file)
    # These take longer to load than a mistake takes to be told.
    from facegear.drives.assess import assess
    from facegear.drives.assessment_files import FILES, write_assessment
    from facegear.drives.report_files import results_directory

    folder = options.output or results_directory(options.file, "assessment")
    _require_folder(folder, FILES)
    found = assess(file, jobs=options.jobs, tell=say)
    page = write_assessment(found, folder)
    tell(found.headline)
    tell(f"The assessment: {page.resolve().as_uri()}")
    return DONE


def _require_folder(folder: Path, files: Sequence[str]) -> None:
    """Refuse a place that results cannot be written to, or where they would replace others, before all computing."""
    from facegear.drives.report_files import foreign

    if reason := _not_writable(folder) or foreign(folder, files):
        raise UsageError(f"--output must be a folder that can be written to, got {str(folder)!r}: {reason}")


def _not_writable(folder: Path) -> str:
    """Say why nothing can be written into a folder, which need not be there yet; nothing if it can."""
    there = next(place for place in (folder.absolute(), *folder.absolute().parents) if place.exists())
    try:
        # Permissions do not tell: some file systems take no folder from anybody.
        tempfile.TemporaryDirectory(prefix=".", dir=there).cleanup()
    except OSError as problem:
        return problem.strerror or str(problem)
    return ""


def check(options: argparse.Namespace) -> int:
    """Say of each file whether it can be used."""
    code = DONE
    for name in options.files:
        try:
            file = read_drive_file(name)
        except DriveFileError as problem:
            say(str(problem))
            code = REFUSED
            continue
        tell(f"{name}: can be used")
        for sentence in file.not_buildable:
            tell(f"{name}: cannot be built as a solid shaft: {sentence}")
        if file.yields:
            tell(f"{name}: the pinion's teeth may yield at the root: {file.yields}")
    return code


def stability_map(options: argparse.Namespace) -> int:
    """Write a map over speed and one number of a file."""
    file = read_drive_file(options.file)
    # These take longer to load than a mistake takes to be told.
    from facegear.drives.map_files import WRITERS, foreign
    from facegear.drives.sweeps import sweep

    beside = Path(options.file)
    outputs = options.output or [
        beside.with_name(f"{beside.stem}_map{end}") for end in (".nc", ".csv", ".svg")
    ]
    for path in outputs:
        if path.suffix not in WRITERS:
            raise UsageError(f"--output must end in {', '.join(WRITERS)}, got {str(path)!r}")
        if reason := _not_writable(path.parent) or foreign(path):
            raise UsageError(f"--output must be a file that can be written, got {str(path)!r}: {reason}")
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
        raise UsageError(told(problem)) from problem
    # All of them or none: an interruption leaves no map beside an older picture of another.
    with files_written_whole(outputs) as places:
        for place in places:
            WRITERS[place.suffix](found, place)
    for path in outputs:
        tell(f"The map: {path}")
    return DONE


def new(options: argparse.Namespace) -> int:
    """Write a drive file, asking for what is not given."""
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
        content = completed(content, ask, say)
    elif lacking := missing(content):
        names = ", ".join(re.sub(r"\w+\.(\w+)", _flag_in, each) for each in lacking)
        raise UsageError(f"without a terminal to ask on, give {names}")
    try:
        file = parse_drive(drive_text(content), str(path))
    except DriveFileError as problem:
        raise UsageError(str(problem)) from problem
    write_drive_file(file, path)
    tell(f"Written: {path}. Next: facegear report {path}")
    return DONE


def _flag_in(path: re.Match[str]) -> str:
    """Flag of the key at a dotted path."""
    return f"--{path[1].replace('_', '-')}"


def ask(question: str) -> str:
    """Read an answer from the terminal."""
    sys.stderr.write(question)
    sys.stderr.flush()
    answer = sys.stdin.readline()
    if not answer:
        raise KeyboardInterrupt
    return answer.strip()


def examples(options: argparse.Namespace) -> int:
    """List the examples, or print one of them, or the schema."""
    if options.schema:
        tell(json.dumps(schema(), indent=2, ensure_ascii=False))
    elif options.name:
        sys.stdout.write(example_text(options.name))
    else:
        for name in example_names():
            tell(f"{name}\n    {about(name)}")
    return DONE


def explore(options: argparse.Namespace) -> int:
    """Serve the explorer until it is interrupted."""
    from facegear.drives.live import serve, uninstalled

    if lacking := uninstalled():
        say(f'facegear explore needs {", ".join(lacking)}: pip install "facegear[explore]"')
        return REFUSED
    from facegear.drives.file_study import study_of

    study_of(options.file)  # What cannot be explored is told here, not in a browser.
    return serve(options.file, options.port, browser=not options.no_browser)
