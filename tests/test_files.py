"""Files appear whole or not at all."""

import pytest

from facegear.files import written_whole


def test_a_file_appears_when_all_is_written(tmp_path):
    path = tmp_path / "folder" / "table.csv"
    with written_whole(path) as place:
        place.write_text("1", encoding="utf-8")
        assert place.suffix == ".csv"
        assert not path.exists()
    assert path.read_text(encoding="utf-8") == "1"
    assert path.stat().st_mode & 0o777 == 0o644
    assert list(path.parent.iterdir()) == [path]


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
