"""Files are written completely or not at all; durable files also survive a loss of power."""

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
    """The calls in order: the size of a synced file, `folder` for a synced folder, the name of a renamed file."""
    calls: list[int | str] = []
    sync, replace = os.fsync, Path.replace

    def synced(descriptor: int) -> None:
        status = os.fstat(descriptor)
        calls.append("folder" if stat.S_ISDIR(status.st_mode) else status.st_size)
        sync(descriptor)

    def replaced(path: Path, target: Path) -> Path:
        calls.append(target.name)
        return replace(path, target)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(Path, "replace", replaced)
    return calls


@pytest.mark.skipif(os.name == "nt", reason="Windows syncs no folders")
def test_durable_files_are_synced_before_they_are_renamed(tmp_path: Path, done: list[int | str]) -> None:
    write_files(tmp_path, {"a": "one", "b/c": b"three"}, durable=True)
    assert done == [3, 5, "a", "c", "folder", "folder"]
    assert [(tmp_path / name).read_text() for name in ("a", "b/c")] == ["one", "three"]
    done.clear()
    write_file(tmp_path / "a", "four", durable=True)
    assert done == [4, "a", "folder"]


def test_other_files_are_not_synced(tmp_path: Path, done: list[int | str]) -> None:
    write_files(tmp_path, {"a": "one", "b/c": b"three"})
    assert done == ["a", "c"]


def test_a_file_with_the_same_content_is_not_written(tmp_path: Path, done: list[int | str]) -> None:
    (tmp_path / "a").write_text("one")
    (tmp_path / "b").write_text("another")
    assert write_files(tmp_path, {"a": "one", "b": "two", "c": b"three"}) == (tmp_path / "b", tmp_path / "c")
    assert done == ["b", "c"]
    assert write_files(tmp_path, {"a": "one"}, durable=True) == (tmp_path / "a",)


@pytest.mark.parametrize("durable", [False, True])
def test_a_failure_keeps_the_old_files(tmp_path: Path, durable: bool) -> None:
    (tmp_path / "a").write_text("older")
    (tmp_path / "b").mkdir()
    with pytest.raises(TltlError, match=r"TLT0005: cannot write `.*b`"):
        write_files(tmp_path, {"a": "newer", "b": "newer"}, durable=durable)
    assert (tmp_path / "a").read_text() == "older"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b"]


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process as other systems do")
def test_files_of_a_killed_process_are_removed(tmp_path: Path) -> None:
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
        # There are also one temporary file and one lock file, those of the last process.
        assert len([*tmp_path.iterdir()]) == 3
    write_file(path, "newer", durable=True)
    assert [file.read_text() for file in tmp_path.iterdir()] == ["newer"]


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1"])
def test_a_pipe_can_be_written_through_the_name_of_its_descriptor(name: str) -> None:
    code = "import sys, pathlib, tltlc.io.writing as w; w.write_file(pathlib.Path(sys.argv[1]), 'é')"
    result = subprocess.run([sys.executable, "-c", code, name], capture_output=True, check=False)
    assert (result.returncode, result.stdout) == (0, "é".encode()), result.stderr


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/dev/stderr", "log"])
@pytest.mark.parametrize("again", [False, True])
def test_a_file_that_is_also_standard_output_keeps_other_output(tmp_path: Path, name: str, *, again: bool) -> None:
    code = "import sys, pathlib, tltlc.io.writing as w; w.write_file(pathlib.Path(sys.argv[1]), 'new')"
    log = tmp_path / "log"
    log.write_text("new" if again else "before, ")
    with log.open("ab") as file:
        for _ in range(2):
            subprocess.run([sys.executable, "-c", code, name], stdout=file, stderr=file, cwd=tmp_path, check=True)
    assert log.read_text() == ("new" if again else "before, ") + "newnew"


def test_removing_a_missing_file_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    for _ in range(2):
        remove_file(tmp_path / "a", "leave it")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "b").mkdir()
    with pytest.raises(TltlError, match=r"TLT0005: cannot remove `.*b`") as error:
        remove_file(tmp_path / "b", "leave it")
    assert [diagnostic.help for diagnostic in error.value.diagnostics] == ["leave it"]


def test_a_source_file_is_not_replaced_by_one_that_is_too_large(tmp_path: Path) -> None:
    path = tmp_path / "big.tltl"
    path.write_text("spec a = true\n")
    with pytest.raises(TltlError) as caught:
        rewrite(path, "// ◇\n" * 200_000)
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["TLT0004"]
    assert path.read_text() == "spec a = true\n"


def test_a_failed_rename_restores_the_earlier_files(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    (tmp_path / "c").write_text("old c")
    replace = Path.replace

    def refuse(self: Path, target: Path) -> Path:
        # Simulate a system on which `c` must not change.
        if target.name == "c":
            raise PermissionError(1, "Operation not permitted")
        return replace(self, target)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "replace", refuse)
        with pytest.raises(TltlError, match="cannot write"):
            write_files(tmp_path, {"a": "new", "new/b": "new", "c": "new"})
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"a": "old", "c": "old c"}


def test_new_folders_are_removed_if_a_file_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "z").mkdir()
    with pytest.raises(TltlError, match="it is a folder"):
        write_files(tmp_path, {"x/y/a": "new", "z": "new"})
    assert [path.name for path in tmp_path.iterdir()] == ["z"]
