"""An archive is unpacked only into its folder; otherwise it is an error."""

from __future__ import annotations

from pathlib import Path
from unicodedata import normalize

import pytest

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.archive import Archive, entry_path, unpack

ARCHIVE = Archive("the archive", damaged_help="make it again", elsewhere_help="unpack it elsewhere")
OUTSIDE = ["../x", "a/../../x", "/x", "//x", "a//x", "..", ".", "", "a/..", "a/.", "./x", "a/", "x\0", "/"]


@pytest.mark.parametrize("name", OUTSIDE)
def test_a_path_out_of_the_folder_is_rejected(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    with pytest.raises(TltlError, match="TLT0009"):
        unpack(folder, [(name, b"bad")], ARCHIVE)
    assert [path.name for path in tmp_path.iterdir()] == ["folder"]
    assert not list(folder.iterdir())


def test_a_path_through_a_link_is_rejected(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path)
    with pytest.raises(TltlError, match="TLT0009"):
        entry_path(folder, "link/x", ARCHIVE)


@pytest.mark.parametrize("names", [("a", "a"), ("a", "a/b"), ("a/b", "a")])
def test_two_entries_for_one_path_are_rejected(names: tuple[str, str], tmp_path: Path) -> None:
    with pytest.raises(TltlError, match="TLT0009") as caught:
        unpack(tmp_path, [(name, b"") for name in names], ARCHIVE)
    (diagnostic,) = caught.value.diagnostics
    first, second = names
    problem = f"two entries for `{first}`" if first == second else f"`{first}` and `{second}`, which cannot both exist"
    assert (diagnostic.title, diagnostic.help) == (f"the archive contains {problem}", ARCHIVE.damaged_help)


@pytest.mark.parametrize(
    "names", [("A.tltl", "a.tltl"), ("Folder", "folder/x"), ("x/Folder/y", "x/folder"), ("\u00e9", "e\u0301")]
)
def test_a_clash_of_names_on_this_file_system_suggests_another_folder(
    names: tuple[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tltlc.io.archive.entry_path", lambda folder, name, _: folder / normalize("NFC", name).lower())
    with pytest.raises(TltlError) as caught:
        unpack(tmp_path, [("other", b""), *((name, b"") for name in names)], ARCHIVE)
    (diagnostic,) = caught.value.diagnostics
    title = f"the archive contains `{names[0]}` and `{names[1]}`, which cannot both exist in this file system"
    assert (diagnostic.code, diagnostic.title, diagnostic.help) == ("TLT0009", title, ARCHIVE.elsewhere_help)


WINDOWS = ["con", "nul.tltl", "a/Aux/b", "COM1.tar.gz", "lpt9", "com\u00b2", "nul .txt", "a:b", "a\\b", "x.", "x "]


@pytest.mark.parametrize("name", WINDOWS)
def test_names_that_windows_forbids_are_rejected_there(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert entry_path(tmp_path, name, ARCHIVE) == tmp_path.joinpath(*name.split("/"))
    monkeypatch.setattr("tltlc.io.archive._IS_WINDOWS", True)
    with pytest.raises(TltlError) as caught:
        entry_path(tmp_path, name, ARCHIVE)
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.help) == ("TLT0009", ARCHIVE.elsewhere_help)


@pytest.mark.parametrize("name", ["console", "a.con", "com", "com10", "nu", "a/lpt.txt", ".x"])
def test_plain_names_are_files_on_windows(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.io.archive._IS_WINDOWS", True)
    assert entry_path(tmp_path, name, ARCHIVE) == tmp_path.joinpath(*name.split("/"))


def test_a_name_that_the_system_rejects_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(TltlError, match="TLT0005"):
        unpack(tmp_path, [("/".join(["x" * 203] * 20), b"")], ARCHIVE)


def test_a_name_that_is_too_long_for_file_systems_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(TltlError, match=r"TLT0009: .* with a part that is longer than 255 bytes"):
        unpack(tmp_path, [("a/" + "x" * 256, b"")], ARCHIVE)


def test_files_are_unpacked_to_their_paths(tmp_path: Path) -> None:
    unpack(tmp_path, [("a/b/c.tltl", b"1"), ("d", b"2"), ("...", b"3"), ("a/..b", b"4")], ARCHIVE)
    assert {str(path.relative_to(tmp_path)): path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == {
        "a/b/c.tltl": b"1",
        "d": b"2",
        "...": b"3",
        "a/..b": b"4",
    }
