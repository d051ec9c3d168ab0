"""Files that are there as a whole or not at all, after a loss of power too where that is asked for."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.writing import remove_file, rewrite, write_file, write_files


@pytest.fixture(name="done")
def _done(monkeypatch: pytest.MonkeyPatch) -> list[int | str]:
    """What the system is asked for, in order: sizes of files and `folder` that are synced, names that files get."""
    told: list[int | str] = []
    sync, replace = os.fsync, Path.replace

    def synced(descriptor: int) -> None:
        found = os.fstat(descriptor)
        told.append("folder" if stat.S_ISDIR(found.st_mode) else found.st_size)
        sync(descriptor)

    def replaced(path: Path, target: Path) -> Path:
        told.append(target.name)
        return replace(path, target)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(Path, "replace", replaced)
    return told


@pytest.mark.skipif(os.name == "nt", reason="Windows syncs no folders")
def test_durable_files_are_on_the_disk_before_they_get_their_names(tmp_path: Path, done: list[int | str]) -> None:
    write_files(tmp_path, {"a": "one", "b/c": b"three"}, durable=True)
    assert done == [3, 5, "a", "c", "folder", "folder"]
    assert [(tmp_path / name).read_text() for name in ("a", "b/c")] == ["one", "three"]
    done.clear()
    write_file(tmp_path / "a", "four", durable=True)
    assert done == [4, "a", "folder"]


def test_other_files_wait_for_no_disk(tmp_path: Path, done: list[int | str]) -> None:
    write_files(tmp_path, {"a": "one", "b/c": b"three"})
    assert done == ["a", "c"]


def test_what_is_there_already_is_not_written(tmp_path: Path, done: list[int | str]) -> None:
    (tmp_path / "a").write_text("one")
    (tmp_path / "b").write_text("another")
    assert write_files(tmp_path, {"a": "one", "b": "two", "c": b"three"}) == (tmp_path / "b", tmp_path / "c")
    assert done == ["b", "c"]
    assert write_files(tmp_path, {"a": "one"}, durable=True) == (tmp_path / "a",)


@pytest.mark.parametrize("durable", [False, True])
def test_a_failure_leaves_what_was_there(tmp_path: Path, durable: bool) -> None:
    (tmp_path / "a").write_text("older")
    (tmp_path / "b").mkdir()
    with pytest.raises(TltlError, match=r"TLT0005: cannot write `.*b`"):
        write_files(tmp_path, {"a": "newer", "b": "newer"}, durable=durable)
    assert (tmp_path / "a").read_text() == "older"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b"]


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process as other systems do")
def test_what_a_killed_process_left_of_a_durable_file_is_removed(tmp_path: Path) -> None:
    killed = """
import os, signal, sys
from pathlib import Path
from tltlc.io.writing import write_file
os.fsync = lambda _: os.kill(os.getpid(), signal.SIGKILL)
write_file(Path(sys.argv[1]), "newer", durable=True)
"""
    path = tmp_path / "a"
    path.write_text("older")
    for _ in range(2):
        subprocess.run([sys.executable, "-c", killed, str(path)], check=False)
        assert path.read_text() == "older"
        # Also its temporary file and its lock file, and no more than those of the last process.
        assert len([*tmp_path.iterdir()]) == 3
    write_file(path, "newer", durable=True)
    assert [each.read_text() for each in tmp_path.iterdir()] == ["newer"]


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1"])
def test_a_pipe_is_written_by_the_name_of_its_descriptor(name: str) -> None:
    code = "import sys, pathlib, tltlc.io.writing as w; w.write_file(pathlib.Path(sys.argv[1]), 'é')"
    done = subprocess.run([sys.executable, "-c", code, name], capture_output=True, check=False)
    assert (done.returncode, done.stdout) == (0, "é".encode()), done.stderr


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/dev/stderr", "log"])
@pytest.mark.parametrize("again", [False, True])
def test_the_file_that_output_goes_to_keeps_what_others_write(tmp_path: Path, name: str, *, again: bool) -> None:
    code = "import sys, pathlib, tltlc.io.writing as w; w.write_file(pathlib.Path(sys.argv[1]), 'new')"
    log = tmp_path / "log"
    log.write_text("new" if again else "before, ")
    with log.open("ab") as file:
        for _ in range(2):
            subprocess.run([sys.executable, "-c", code, name], stdout=file, stderr=file, cwd=tmp_path, check=True)
    assert log.read_text() == ("new" if again else "before, ") + "newnew"


def test_a_file_is_removed_where_it_is_there(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    for _ in range(2):
        remove_file(tmp_path / "a", "leave it")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "b").mkdir()
    with pytest.raises(TltlError, match=r"TLT0005: cannot remove `.*b`") as error:
        remove_file(tmp_path / "b", "leave it")
    assert [found.help for found in error.value.diagnostics] == ["leave it"]


def test_a_source_file_that_could_not_be_read_again_stays(tmp_path: Path) -> None:
    path = tmp_path / "big.tltl"
    path.write_text("spec a = true\n")
    with pytest.raises(TltlError) as caught:
        rewrite(path, "// ◇\n" * 200_000)
    assert [each.code for each in caught.value.diagnostics] == ["TLT0004"]
    assert path.read_text() == "spec a = true\n"


def test_a_rename_that_fails_restores_the_files_before_it(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    (tmp_path / "c").write_text("old c")
    replace = Path.replace

    def refuse(self: Path, target: Path) -> Path:
        # Like a system on which `c` must not change.
        if target.name == "c":
            raise PermissionError(1, "Operation not permitted")
        return replace(self, target)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "replace", refuse)
        with pytest.raises(TltlError, match="cannot write"):
            write_files(tmp_path, {"a": "new", "new/b": "new", "c": "new"})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"a": "old", "c": "old c"}


def test_folders_that_were_made_go_where_a_file_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "z").mkdir()
    with pytest.raises(TltlError, match="it is a folder"):
        write_files(tmp_path, {"x/y/a": "new", "z": "new"})
    assert [path.name for path in tmp_path.iterdir()] == ["z"]
