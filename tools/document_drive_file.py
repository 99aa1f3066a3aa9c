"""Write what is made from the table of keys of a drive file: `data/drive.schema.json`, and the tables of its page."""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from facegear.drives.drive_schema import documentation, schema  # noqa: E402
from tools.pages import in_readers_digits  # noqa: E402

SCHEMA = ROOT / "data" / "drive.schema.json"
PAGE = ROOT / "book" / "drive_file.md"
MARKS = ("<!-- keys -->\n", "\n<!-- end of keys -->")


def schema_text() -> str:
    """Return the text of the schema file."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def page_text(page: str) -> str:
    """Return the page with its tables renewed."""
    before, rest = page.split(MARKS[0], 1)
    _, after = rest.split(MARKS[1], 1)
    return f"{before}{MARKS[0]}\n{in_readers_digits(documentation())}\n{MARKS[1]}{after}"


if __name__ == "__main__":
    SCHEMA.write_text(schema_text(), encoding="utf-8")
    PAGE.write_text(page_text(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
