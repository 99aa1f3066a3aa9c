"""Files appear whole or not at all."""

import os
import re
import signal
import subprocess
import sys

import pytest

from facegear.support.files import file_stem, files_written_whole, folder_written_whole, written_whole


def test_a_file_appears_when_all_is_written(tmp_path):
    path = tmp_path / "folder" / "table.csv"
    with written_whole(path) as place:
        place.write_text("1", encoding="utf-8")
        assert place.suffix == ".csv"
        assert not path.exists()
    assert path.read_text(encoding="utf-8") == "1"
    assert path.stat().st_mode & 0o777 == 0o644
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("place", [written_whole, folder_written_whole])
def test_errors_name_what_was_to_be_written(tmp_path, monkeypatch, place):
    def refuse(**options):
        raise PermissionError(13, "Permission denied", f"{options['dir']}/.table.x1y2")

    monkeypatch.setattr("tempfile.mkstemp", refuse)
    monkeypatch.setattr("tempfile.mkdtemp", refuse)
    path = tmp_path / "table.csv"
    with pytest.raises(PermissionError, match=r"Permission denied: '.*/table\.csv'$"), place(path):
        pass
    (tmp_path / "file").write_text("", encoding="utf-8")
    with (
        pytest.raises(OSError, match=r"file/below/table\.csv'$"),
        place(tmp_path / "file" / "below" / "table.csv"),
    ):
        pass


def test_a_file_stays_what_it_was_if_writing_stops(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("old", encoding="utf-8")

    def stop_halfway():
        with written_whole(path) as place:
            place.write_text("ne", encoding="utf-8")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stop_halfway()
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    "text",
    [
        "../../etc/passwd",
        "a/b\\c",
        "CON",
        "nul",
        "",
        " ",
        "\x00",
        "=1+1",
        "-rf",
        "~",
        "a" * 500,
        "Ü" * 300,
        "齿轮",
        "a\nb",
    ],
)
def test_any_text_gives_a_name_of_a_file(tmp_path, text):
    stem = file_stem(text)
    assert re.fullmatch(r"[a-z0-9][a-z0-9_]{0,59}", stem)
    assert stem not in {"con", "nul"}
    (tmp_path / f"{stem}.nc").write_text("", encoding="utf-8")
    assert [path.parent for path in tmp_path.rglob("*.nc")] == [tmp_path]


def test_names_that_are_safe_can_be_read():
    assert file_stem("transverse, true sweep") == "transverse_true_sweep"
    assert file_stem("Zahnrad für Prüfstand 2") == "zahnrad_fur_prufstand_2"


def interrupted(path):
    with folder_written_whole(path) as place:
        (place / "one.txt").write_text("2")
        raise KeyboardInterrupt


def test_a_folder_appears_whole_or_not_at_all(tmp_path):
    path = tmp_path / "a" / "results"
    with pytest.raises(KeyboardInterrupt):
        interrupted(path)
    assert not list((tmp_path / "a").iterdir())
    with folder_written_whole(path) as place:
        (place / "one.txt").write_text("1")
        assert not path.exists()
    assert [file.name for file in path.iterdir()] == ["one.txt"]


def test_a_folder_that_is_there_keeps_what_is_not_replaced(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "one.txt").write_text("0")
    with pytest.raises(KeyboardInterrupt):
        interrupted(tmp_path)
    assert (tmp_path / "one.txt").read_text() == "0"
    with folder_written_whole(tmp_path) as place:
        (place / "one.txt").write_text("1")
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {
        "mine.txt": "mine",
        "one.txt": "1",
    }


def test_several_files_appear_together_or_not_at_all(tmp_path):
    one, two = paths = tmp_path / "a" / "one.nc", tmp_path / "b" / "two.csv"

    def write(text, stop=False):
        with files_written_whole(paths) as places:
            assert [place.name for place in places] == ["one.nc", "two.csv"]
            places[0].write_text(text)
            if stop:
                raise KeyboardInterrupt
            places[1].write_text(text)

    for text, before in (("1", None), ("2", "1")):
        with pytest.raises(KeyboardInterrupt):
            write(text, stop=True)
        assert [path.read_text() if path.exists() else None for path in paths] == [before, before]
        write(text)
        assert one.read_text() == two.read_text() == text
        assert sorted(path.name for path in tmp_path.rglob("*")) == ["a", "b", "one.nc", "two.csv"]


def test_what_an_earlier_time_wrote_is_removed_and_what_others_wrote_is_not(tmp_path):
    for name in ("mine.txt", "one.txt", "earlier.txt"):
        (tmp_path / name).write_text("0")
    (tmp_path / "folder.txt").mkdir()
    own = ("one.txt", "earlier.txt", "never.txt", "folder.txt")

    def write(stop=False):
        with folder_written_whole(tmp_path, own) as place:
            (place / "one.txt").write_text("1")
            if stop:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write(stop=True)
    assert (tmp_path / "earlier.txt").read_text() == (tmp_path / "one.txt").read_text() == "0"
    write()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder.txt", "mine.txt", "one.txt"]
    assert (tmp_path / "one.txt").read_text() == "1"


KILLED = """
import os, signal, sys
from pathlib import Path
from facegear.support.files import {place}
with {place}(Path(sys.argv[1])) as place:
    (place / "one.txt" if place.is_dir() else place).write_text("half")
    os.kill(os.getpid(), signal.{how})
"""


def killed(place, path, how="SIGKILL"):
    """Write to a place in a process that ends itself by force; what is left beside it."""
    program = KILLED.format(place=place.__name__, how=how)
    done = subprocess.run([sys.executable, "-c", program, str(path)], check=False)
    assert done.returncode == -getattr(signal, how)
    return list(path.parent.iterdir())


@pytest.mark.skipif(os.name == "nt", reason="signals as POSIX has them")
@pytest.mark.parametrize("place", [written_whole, folder_written_whole])
def test_what_a_killed_process_left_is_cleared_by_the_next_one(tmp_path, place):
    path, other = tmp_path / "results.csv", tmp_path / "others.csv"
    (left,) = killed(place, path)
    assert left.name.startswith(".results.csv.")
    # Another target leaves it alone, and so does one whose process still runs.
    with written_whole(other) as free:
        free.write_text("1")
    assert sorted(tmp_path.iterdir()) == sorted([left, other])
    running = left.with_name(re.sub(r"\.\d+\.(?=\w{8}(\.csv)?$)", f".{os.getpid()}.", left.name))
    assert running != left
    left.rename(running)
    with place(path) as free:
        (free / "one.txt" if free.is_dir() else free).write_text("1")
        assert running.exists()
    running.rename(left)
    with place(path) as free:
        (free / "one.txt" if free.is_dir() else free).write_text("2")
        assert not left.exists()
    assert sorted(tmp_path.iterdir()) == sorted([path, other])


def test_hidden_files_of_ones_own_and_of_other_machines_stay(tmp_path):
    own = [".results", ".results.txt", ".results.elsewhere.99999999.abcdefgh", ".results.notes.1.old"]
    for name in own:
        (tmp_path / name).write_text("mine")
    with folder_written_whole(tmp_path / "results") as place:
        (place / "one.txt").write_text("1")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*own, "results"])


def test_the_longest_name_of_a_file_can_be_written(tmp_path):
    path = tmp_path / ("n" * 251 + ".csv")
    with written_whole(path) as place:
        place.write_text("1")
    assert list(tmp_path.iterdir()) == [path]
