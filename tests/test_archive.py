"""Archives are unpacked below their folder, or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from tltlc.archive import inside, unpack
from tltlc.diagnostics.diagnostic import TltlError

OUTSIDE = ["../x", "a/../../x", "/x", "//x", "a//x", "..", ".", "", "a/..", "a/.", "./x", "a/", "x\0", "/"]


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_path_that_leads_out_is_refused(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    with pytest.raises(TltlError, match="TLT0009"):
        unpack(folder, [(name, b"bad")], "the archive")
    assert [path.name for path in tmp_path.iterdir()] == ["folder"]
    assert not list(folder.iterdir())


def test_a_path_through_a_link_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path)
    with pytest.raises(TltlError, match="TLT0009"):
        inside(folder, "link/x", "the archive")


@pytest.mark.parametrize("names", [("a", "a"), ("a", "a/b"), ("a/b", "a")])
def test_two_entries_for_one_path_are_refused(names: tuple[str, str], tmp_path: Path) -> None:
    with pytest.raises(TltlError, match="TLT0009"):
        unpack(tmp_path, [(name, b"") for name in names], "the archive")


def test_a_name_that_the_system_refuses_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(TltlError, match="TLT0005"):
        unpack(tmp_path, [("x" * 300, b"")], "the archive")


def test_files_lie_at_their_paths(tmp_path: Path) -> None:
    unpack(tmp_path, [("a/b/c.tltl", b"1"), ("d", b"2"), ("...", b"3"), ("a/..b", b"4")], "the archive")
    assert {str(path.relative_to(tmp_path)): path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == {
        "a/b/c.tltl": b"1",
        "d": b"2",
        "...": b"3",
        "a/..b": b"4",
    }
