"""Files that are looked for: what the system does not tell is not there."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NoReturn

import pytest

from tltlc.io.files import exists, is_dir, is_file, note_read, noted, read_source, stamp, walk, was_read


def test_what_is_there(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    assert [(exists(tmp_path / each), is_file(tmp_path / each)) for each in ("a", "", "b", "a/b")] == [
        (True, True),
        (True, False),
        (False, False),
        (False, False),
    ]


@pytest.mark.parametrize("look", [exists, is_file])
@pytest.mark.parametrize("name", ["a" * 300, "a\0", "\ud800"])
def test_a_name_that_the_system_does_not_allow_is_nowhere(look: Callable[[str], bool], name: str) -> None:
    assert not look(name)


@pytest.mark.parametrize("look", [exists, is_file])
def test_what_one_may_not_look_at_is_nowhere(
    look: Callable[[Path], bool], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object, **__: object) -> NoReturn:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "stat", refused)
    assert not look(tmp_path)


def test_what_is_looked_at_is_noted_as_it_was_before(tmp_path: Path) -> None:
    file, missing = tmp_path / "a", tmp_path / "b"
    file.write_text("1")
    before = stamp(str(file))
    with noted() as outer, noted() as inner:
        assert is_file(file) and not exists(missing) and is_dir(tmp_path)
        file.write_text("22")
        read_source(file)
    assert outer == inner == {str(file): before, str(missing): None, str(tmp_path): stamp(str(tmp_path))}
    assert stamp(str(file)) != before
    exists(tmp_path / "c")
    assert len(outer) == 3


def test_a_folder_stays_the_same_whatever_is_written_into_it(tmp_path: Path) -> None:
    before = stamp(str(tmp_path))
    (tmp_path / "a").touch()
    assert before is not None and stamp(str(tmp_path)) == before


def test_notes_within_notes(tmp_path: Path) -> None:
    with noted() as outer:
        with noted():
            pass
        exists(tmp_path)
    assert [*outer] == [str(tmp_path)]


def test_only_files_are_replaced_by_what_is_written(tmp_path: Path) -> None:
    file = tmp_path / "a"
    file.touch()
    with noted():
        note_read(file)
        note_read(os.devnull)
        assert was_read(file)
        assert not was_read(os.devnull)


def test_a_round_of_watching_forgets_what_earlier_rounds_have_read(tmp_path: Path) -> None:
    source, link = tmp_path / "a", tmp_path / "link"
    source.write_text("1")
    link.hardlink_to(source)
    with noted():
        with noted():
            read_source(source)
            assert was_read(source) and was_read(link)
        with noted():
            assert not was_read(source)
        assert was_read(source)
    assert not was_read(source)


@pytest.fixture
def deep(tmp_path: Path) -> Iterator[Path]:
    """A folder with a thousand folders in each other, more than Python's stack has room for."""
    before = Path.cwd()
    os.chdir(tmp_path)
    try:
        for _ in range(1200):
            Path("d").mkdir()
            os.chdir("d")
        os.chdir(before)
        yield tmp_path
    finally:
        os.chdir(before)
        # Nothing of Python's removes it.
        subprocess.run(["rm", "-rf", str(tmp_path / "d")], check=False)


def test_folders_of_any_depth_are_walked(deep: Path) -> None:
    (deep / "b").mkdir()
    (deep / "b" / "file").touch()
    (deep / "link").symlink_to(deep)
    refused: list[OSError] = []
    walked = list(walk(deep, refused.append))
    assert (str(deep), ["b", "d", "link"], []) == (walked[0][0], sorted(walked[0][1]), walked[0][2])
    assert (str(deep / "b"), [], ["file"]) in walked
    # Where a path may have some thousand characters only, the last folders are refused.
    assert len(walked) > 1000 or len(refused) == 1
