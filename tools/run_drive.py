"""Make the report on a drive: `python tools/run_drive.py my_drive.yaml [folder]`.

Checks the file, executes `notebooks/your_drive.ipynb` for it and leaves the report, as a notebook and as a page that
any browser shows, in a folder together with the tables, arrays and meshes that it writes. Without a folder that is
`my_drive_results` beside the file.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from facegear.drive_file import DriveFileError, read_drive_file  # noqa: E402

NOTEBOOK = ROOT / "notebooks" / "your_drive.ipynb"


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit code."""
    if len(arguments) not in (1, 2):
        sys.stderr.write("Say for example: python tools/run_drive.py my_drive.yaml\n")
        return 2
    file = Path(arguments[0]).absolute()
    folder = Path(arguments[1]).resolve() if len(arguments) == 2 else file.with_name(f"{file.stem}_results")
    try:
        read_drive_file(file)
    except DriveFileError as problem:
        sys.stderr.write(f"{problem}\n")
        return 1
    return make_report(file, folder)


def make_report(file: Path, folder: Path) -> int:
    """Execute the notebook for a file that can be used; return the exit code."""
    # Here, because these take longer to load than a mistake takes to be told.
    import nbformat
    from nbconvert import HTMLExporter

    from tools.run_notebook import NotebookFailedError, execute

    try:
        parameters = {"drive_file": str(file), "output_directory": str(folder)}
        execute(NOTEBOOK, folder / "report.ipynb", folder / "failed", parameters=parameters)
    except NotebookFailedError as problem:
        sys.stderr.write(f"{problem}\n")
        return 1
    # The page holds its pictures; only mathematics comes from the network.
    page, _ = HTMLExporter(exclude_input=True).from_notebook_node(
        nbformat.read(folder / "report.ipynb", as_version=4)
    )
    (folder / "report.html").write_text(page, encoding="utf-8")
    (folder / "failed").rmdir()
    sys.stdout.write(f"The report: {(folder / 'report.html').as_uri()}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
