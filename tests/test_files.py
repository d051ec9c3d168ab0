"""Looking for files: a file that the system cannot access counts as missing."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NoReturn

import pytest

from tltlc.io.access_log import access_log, log_read, stamp, was_read
from tltlc.io.files import exists, is_dir, is_file, read_source, walk


def test_existing_files_and_folders_are_found(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    assert [(exists(tmp_path / name), is_file(tmp_path / name)) for name in ("a", "", "b", "a/b")] == [
        (True, True),
        (True, False),
        (False, False),
        (False, False),
    ]


@pytest.mark.parametrize("look", [exists, is_file])
@pytest.mark.parametrize("name", ["a" * 300, "a\0", "\ud800"])
def test_a_name_that_the_system_does_not_allow_is_missing(look: Callable[[str], bool], name: str) -> None:
    assert not look(name)


@pytest.mark.parametrize("look", [exists, is_file])
def test_a_file_without_permission_is_missing(
    look: Callable[[Path], bool], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forbidden(*_: object, **__: object) -> NoReturn:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "stat", forbidden)
    assert not look(tmp_path)


def test_a_looked_up_path_is_logged_with_its_first_state(tmp_path: Path) -> None:
    file, missing = tmp_path / "a", tmp_path / "b"
    file.write_text("1")
    before = stamp(str(file))
    with access_log() as outer, access_log() as inner:
        assert is_file(file) and not exists(missing) and is_dir(tmp_path)
        file.write_text("22")
        read_source(file)
    assert outer == inner == {str(file): before, str(missing): None, str(tmp_path): stamp(str(tmp_path))}
    assert stamp(str(file)) != before
    exists(tmp_path / "c")
    assert len(outer) == 3


def test_the_stamp_of_a_folder_ignores_its_files(tmp_path: Path) -> None:
    before = stamp(str(tmp_path))
    (tmp_path / "a").touch()
    assert before is not None and stamp(str(tmp_path)) == before


def test_an_inner_access_log_does_not_end_the_outer_one(tmp_path: Path) -> None:
    with access_log() as outer:
        with access_log():
            pass
        exists(tmp_path)
    assert [*outer] == [str(tmp_path)]


def test_only_regular_files_count_as_read(tmp_path: Path) -> None:
    file = tmp_path / "a"
    file.touch()
    with access_log():
        log_read(file)
        log_read(os.devnull)
        assert was_read(file)
        assert not was_read(os.devnull)


def test_a_new_access_log_forgets_files_that_an_earlier_one_read(tmp_path: Path) -> None:
    source, link = tmp_path / "a", tmp_path / "link"
    source.write_text("1")
    link.hardlink_to(source)
    with access_log():
        with access_log():
            read_source(source)
            assert was_read(source) and was_read(link)
        with access_log():
            assert not was_read(source)
        assert was_read(source)
    assert not was_read(source)


@pytest.fixture
def deep_folder(tmp_path: Path) -> Iterator[Path]:
    """A folder with more nested folders than Python's recursion limit."""
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
        # No function of Python can remove a folder this deep.
        subprocess.run(["rm", "-rf", str(tmp_path / "d")], check=False)


def test_folders_of_any_depth_are_walked(deep_folder: Path) -> None:
    (deep_folder / "b").mkdir()
    (deep_folder / "b" / "file").touch()
    (deep_folder / "link").symlink_to(deep_folder)
    errors: list[OSError] = []
    walked = list(walk(deep_folder, errors.append))
    assert (str(deep_folder), ["b", "d", "link"], []) == (walked[0][0], sorted(walked[0][1]), walked[0][2])
    assert (str(deep_folder / "b"), [], ["file"]) in walked
    # If paths are limited to some thousand characters, the deepest folders give an error.
    assert len(walked) > 1000 or len(errors) == 1
