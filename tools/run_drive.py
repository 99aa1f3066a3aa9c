"""Make the report on a drive: `python tools/run_drive.py my_drive.yaml [folder]`.

Checks the file, executes `notebooks/your_drive.ipynb` for it and leaves the report, as a notebook and as a page that
any browser shows, in a folder together with the tables, arrays and meshes that it writes. Without a folder that is
`my_drive_results` beside the file. Each cell that starts is a line on standard output, `cell 7 of 24: The drive`; the
last line says where the report is.
"""

import html
import sys
from pathlib import Path

from nbformat import NotebookNode
from nbformat.v4 import new_output

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from facegear.drives.drive_file import DriveFileError, read_drive_file  # noqa: E402

MOST_STEPS = 5
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

    from tools.run_notebook import NotebookFailedError, execute

    cells = sections(nbformat.read(NOTEBOOK, as_version=4))

    def show(done: int) -> None:
        """Say which cell starts after so many."""
        if done < len(cells):
            sys.stdout.write(f"cell {done + 1} of {len(cells)}: {cells[done]}\n")
            sys.stdout.flush()

    show(0)
    try:
        # The book's own example stops earlier, to be built in minutes.
        parameters = {"drive_file": str(file), "output_directory": str(folder), "most_steps": MOST_STEPS}
        execute(NOTEBOOK, folder / "report.ipynb", folder / "failed", parameters=parameters, on_cell=show)
    except NotebookFailedError as problem:
        sys.stderr.write(f"{problem}\n")
        return 1
    notebook = nbformat.read(folder / "report.ipynb", as_version=4)
    (folder / "report.html").write_text(page_of(notebook), encoding="utf-8")
    (folder / "failed").rmdir()
    sys.stdout.write(f"The report: {(folder / 'report.html').as_uri()}\n")
    return 0


def sections(notebook: NotebookNode) -> list[str]:
    """Return the heading above each code cell that holds something."""
    heading, found = "", []
    for cell in notebook.cells:
        if cell.cell_type == "code" and cell.source.strip():
            found.append(heading)
        elif cell.cell_type == "markdown":
            heading = next(
                (line.lstrip("# ") for line in reversed(cell.source.splitlines()) if line.startswith("#")),
                heading,
            )
    return found


def page_of(notebook: NotebookNode) -> str:
    """Return an executed report as one page that needs no network: figures with their captions, no code.

    The report has no formulas that a script would have to set, so that nothing is fetched.
    """
    from nbconvert import HTMLExporter

    for cell in notebook.cells:
        figure = cell.metadata.get("mystnb", {}).get("figure")
        pictures = [o for o in cell.get("outputs", []) if "image/svg+xml" in o.get("data", {})]
        if figure and pictures:
            caption = {"text/html": f"<p><em>{html.escape(figure['caption'])}</em></p>"}
            cell.outputs.append(new_output("display_data", data=caption))
            alt = html.escape(cell.metadata["mystnb"]["image"]["alt"], quote=True)
            for output in pictures:
                drawn = output["data"].pop("image/svg+xml")
                # Named for readers who cannot see it.
                output["data"]["text/html"] = (
                    f'<div role="img" aria-label="{alt}">{drawn[drawn.find("<svg") :]}</div>'
                )
    exporter = HTMLExporter(exclude_input=True, exclude_output_prompt=True, embed_images=True)
    for script in ("mathjax_url", "require_js_url", "jquery_url", "mermaid_js_url"):
        if exporter.has_trait(script):
            setattr(exporter, script, "")
    page, _ = exporter.from_notebook_node(notebook)
    return str(page)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
