"""Make the stored arrays of `data/reference` anew, and say what moved.

`python tools/update_references.py [notebook …]` executes the notebooks (all of them when none is named) into a
folder of their own and replaces the reference files by what they computed. Anchors are never touched: an array
that disagrees with its independent route stops the next build, whatever its reference says.
"""

import os
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from compendium.reference import VariableDifference, difference  # noqa: E402
from facegear.support.labelled import ArrayFileError, load  # noqa: E402
from tools.lock import one_at_a_time  # noqa: E402
from tools.run_notebook import NotebookFailedError, execute  # noqa: E402

REFERENCE = ROOT / "data" / "reference"
NEW = ROOT / "build" / "new-references"


def say(message: str) -> None:
    """Print one line."""
    sys.stdout.write(message + "\n")
    sys.stdout.flush()


def compute(notebook: Path) -> bool:
    """Execute a notebook for its arrays; say whether they are there.

    A disagreement with the old references is what this is about, and no reason to stop: the arrays of all figures
    are written before the first is compared.
    """
    try:
        execute(
            notebook, NEW / notebook.name, ROOT / "build" / "failed", parameters={"build_directory": str(NEW)}
        )
    except NotebookFailedError as problem:
        if problem.error != "ReferenceCheckError":
            say(f"FAILED {problem}")
            return False
        say(f"{notebook.stem}: {problem}")
    return True


def told(row: VariableDifference) -> str:
    """Return the line about one variable."""
    if row.change != "compared":
        return f"  {row.name}: {row.change} {row.where}".rstrip()
    within = "within" if row.agrees else "BEYOND"
    return (
        f"  {row.name}: largest change {row.largest_absolute:.3g}, relative {row.largest_relative:.3g}, "
        f"{within} tolerance"
    )


def replace(new: Path) -> None:
    """Put one array file in the place of the stored one, if anything moved, and say what."""
    stored = REFERENCE / new.name
    arrays = load(new)
    try:
        rows = difference(arrays, load(stored))
    except ArrayFileError as problem:
        say(f"{new.name}: {'replaced' if stored.exists() else 'new'}, {len(arrays.variables)} arrays")
        if stored.exists():
            say(f"  {problem}")
    else:
        moved = [row for row in rows if row.change != "compared" or row.largest_absolute > 0]
        say(f"{new.name}: {len(moved)} of {len(rows)} arrays moved")
        for row in moved:
            say(told(row))
        if not moved:  # the file goes on telling which commit made these numbers
            return
    temporary = stored.with_suffix(".tmp")
    shutil.copyfile(new, temporary)
    os.replace(temporary, stored)


def main(names: list[str]) -> int:
    """Update the references of the notebooks named, of all when none is; return the exit code."""
    notebooks = sorted((ROOT / "notebooks").glob("*.ipynb"))
    unknown = set(names) - {path.stem for path in notebooks}
    if unknown:
        say(f"There is no notebooks/{min(unknown)}.ipynb.")
        return 2
    with one_at_a_time():
        shutil.rmtree(NEW, ignore_errors=True)
        chosen = [path for path in notebooks if not names or path.stem in names]
        if not all(compute(notebook) for notebook in chosen):
            say("Nothing was replaced.")
            return 1
        REFERENCE.mkdir(parents=True, exist_ok=True)
        computed = sorted((NEW / "arrays").glob("*.nc"))
        for new in computed:
            replace(new)
        if not names:
            for orphan in sorted({path.name for path in REFERENCE.glob("*.nc")} - {p.name for p in computed}):
                say(f"{orphan}: no notebook computes it any more; removed")
                (REFERENCE / orphan).unlink()
    say("Read the changes before committing them: git diff --stat data/reference")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
