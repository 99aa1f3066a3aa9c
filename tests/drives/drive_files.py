"""Drive files that several tests start from, how a refusal reads, and what a table holds."""

import csv
from pathlib import Path

import pytest

from facegear.drives.drive_file import DriveFileError, parse_drive

ROOT = Path(__file__).resolve().parents[2]
DRIVES = ROOT / "data" / "drives"
CASE_1 = (DRIVES / "case_1.yaml").read_text(encoding="utf-8")
GEARBOX = (DRIVES / "gearbox_table_7_1.yaml").read_text(encoding="utf-8")
BOTH_FACES = (DRIVES / "both_faces.yaml").read_text(encoding="utf-8")


def refusal(content):
    with pytest.raises(DriveFileError) as caught:
        parse_drive(content, "my.yaml")
    message = str(caught.value)
    assert message.startswith("my.yaml: ")
    assert "\n" not in message
    return message.removeprefix("my.yaml: ")


def rows(path):
    with path.open(encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))
