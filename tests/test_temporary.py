"""Temporary files of killed processes are removed; all other files stay."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.waiting import HANG_S
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.temporary import remove_abandoned, temporaries, temporary_folder
from tltlc.io.writing import write_files

ROOT = Path(__file__).parents[1]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs signals that reach one process alone")

SPECS = "signal a: bool\n" + "".join(f"spec s{number} = F a\n" for number in range(14))
FILES = 42

WAITING_COMMAND = """
import sys
from pathlib import Path
replace = Path.replace
def told(path, target):
    print("renames", flush=True)
    sys.stdin.readline()
    Path.replace = replace
    return replace(path, target)
Path.replace = told
from tltlc.interfaces.cli.main import main
main()
"""
"""A program that compiles, and waits for a line on standard input before it renames its temporary files."""


@contextmanager
def command_waiting_to_rename(folder: Path, *, ignoring: str = "") -> Iterator[subprocess.Popen[str]]:
    (folder / "specs.tltl").write_text(SPECS, encoding="utf-8")
    program = (
        f"import signal; signal.signal(signal.{ignoring}, signal.SIG_IGN)\n{WAITING_COMMAND}"
        if ignoring
        else WAITING_COMMAND
    )
    command = [sys.executable, "-c", program, "compile", "specs.tltl", "-o", "out"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TLTLC_CACHE_DIR": ""}
    with subprocess.Popen(
        command, cwd=folder, env=environment, stdin=-1, stdout=-1, stderr=subprocess.STDOUT, text=True
    ) as running:
        try:
            assert running.stdout is not None
            assert running.stdout.readline() == "renames\n"
            yield running
        finally:
            running.kill()


def temporary_names(folder: Path) -> list[str]:
    return sorted(path.name for path in (folder / "out").iterdir() if path.name.startswith("."))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_command_ended_by_a_signal_leaves_no_file(number: signal.Signals, tmp_path: Path) -> None:
    with command_waiting_to_rename(tmp_path) as running:
        assert len(temporary_names(tmp_path)) == FILES + 1
        running.send_signal(number)
        out, _ = running.communicate(timeout=HANG_S)
    assert (running.returncode, out) == (128 + number, "")
    assert [path.name for path in tmp_path.iterdir()] == ["specs.tltl"]


AT_THE_LOCK = """
import os, signal, sys, time
from pathlib import Path
from tltlc.io import temporary
# The files are not renamed before the signal has been handled.
Path.replace = lambda path, target: time.sleep(60)
try_lock = temporary.try_lock
def interrupted(file):
    temporary.try_lock = try_lock
    os.kill(os.getpid(), signal.{name})
    return try_lock(file)
temporary.try_lock = interrupted
"""
"""A signal comes after the lock file is created and before it is locked."""

WHILE_CLEANING = """
import os, signal, sys
from pathlib import Path
replace, unlink = Path.replace, Path.unlink
def first(path, target):
    os.kill(os.getpid(), signal.{name})
    return replace(path, target)
def second(path, missing_ok=False):
    os.kill(os.getpid(), signal.{name})
    return unlink(path, missing_ok)
Path.replace, Path.unlink = first, second
"""
"""A signal comes before the first file is renamed, and another one each time a temporary file is removed."""


@pytest.mark.parametrize("program", [AT_THE_LOCK, WHILE_CLEANING], ids=["lock", "cleaning"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_at_a_bad_moment_leaves_no_file(number: signal.Signals, program: str, tmp_path: Path) -> None:
    (tmp_path / "specs.tltl").write_text(SPECS, encoding="utf-8")
    script = program.format(name=number.name) + "from tltlc.interfaces.cli.main import main\nmain()\n"
    command = [sys.executable, "-c", script, "compile", "specs.tltl", "-o", "out"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TLTLC_CACHE_DIR": ""}
    result = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=HANG_S)
    assert [path.name for path in tmp_path.iterdir()] == ["specs.tltl"]
    assert (result.returncode, result.stdout) == (128 + number, "")


def test_a_new_temporary_folder_removes_the_one_of_a_killed_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    script = (
        "import os\nfrom tltlc.io.temporary import temporary_folder\n"
        "with temporary_folder() as folder:\n"
        "    (folder / 'a' / 'b').mkdir(parents=True)\n    (folder / 'a' / 'b' / 'c').touch()\n"
        "    os.kill(os.getpid(), 9)\n"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)}
    result = subprocess.run([sys.executable, "-c", script], env=environment, timeout=HANG_S, check=False)
    assert (result.returncode, len(list(tmp_path.iterdir()))) == (-9, 2)
    with temporary_folder() as folder:
        assert sorted(tmp_path.iterdir()) == [folder, folder.with_name(f"{folder.name[:-2]}.lock")]
        # A second temporary folder does not remove the first one.
        with temporary_folder():
            assert folder.is_dir()
        assert folder.is_dir()
        assert folder.stat().st_mode & 0o077 == 0
    assert list(tmp_path.iterdir()) == []


def test_a_temporary_folder_that_cannot_be_created_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "gone"))
    with pytest.raises(TltlError, match="TLT0005: cannot create a temporary folder"), temporary_folder():
        pass


def test_an_ignored_signal_stays_ignored(tmp_path: Path) -> None:
    with command_waiting_to_rename(tmp_path, ignoring="SIGHUP") as running:
        running.send_signal(signal.SIGHUP)
        running.communicate("go on\n", timeout=HANG_S)
    assert running.returncode == 0
    assert (len(list((tmp_path / "out").iterdir())), temporary_names(tmp_path)) == (FILES, [])


def test_the_next_write_removes_files_of_a_killed_process(tmp_path: Path) -> None:
    with command_waiting_to_rename(tmp_path) as running:
        running.kill()
    assert len(temporary_names(tmp_path)) == FILES + 1
    write_files(tmp_path / "out", {"other": "text"})
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["other"]


def test_a_running_process_keeps_its_temporary_files(tmp_path: Path) -> None:
    with command_waiting_to_rename(tmp_path) as running:
        before = temporary_names(tmp_path)
        write_files(tmp_path / "out", {"other": "text"})
        assert temporary_names(tmp_path) == before
        running.communicate("go on\n", timeout=HANG_S)
    assert running.returncode == 0
    assert (len(list((tmp_path / "out").iterdir())), temporary_names(tmp_path)) == (FILES + 1, [])


def test_two_writers_in_one_process_keep_their_files(tmp_path: Path) -> None:
    with temporaries() as owner:
        file = owner.path(tmp_path / "a")
        file.write_text("one")
        write_files(tmp_path, {"b": "two"})
        assert file.read_text() == "one"
    assert [path.name for path in tmp_path.iterdir()] == ["b"]


PREFIX = ".tltlc-1-0123456789abcdef"


def test_only_regular_files_with_our_names_are_removed(tmp_path: Path) -> None:
    folder, elsewhere = tmp_path / "folder", tmp_path / "elsewhere"
    folder.mkdir()
    elsewhere.write_text("precious")
    removed = [f"{PREFIX}.lock", f"{PREFIX}-0.tmp", f"{PREFIX}-17.mp4", f"{PREFIX}-3"]
    other_owner = ".tltlc-2-0123456789abcdef"
    kept = [f"{PREFIX}-x.tmp", f"{PREFIX}-1.tmp.bak", f"{PREFIX}0-1.tmp", f"a{PREFIX}-1.tmp"]
    # A temporary file without a lock file may still have an owner.
    kept += [f"{other_owner}-0.tmp", ".tltlc-3-0123456789ABCDEF.lock", ".tltlc-3.lock", ".tltlc-12-0.tmp"]
    for name in (*removed, *kept):
        (folder / name).write_text("text")
    (folder / f"{PREFIX}-8.tmp").symlink_to(elsewhere)
    (folder / f"{PREFIX}-9.tmp").mkdir()
    # These have the name of a lock file, but are not regular files.
    (folder / ".tltlc-4-0123456789abcdef.lock").symlink_to(elsewhere)
    (folder / ".tltlc-4-0123456789abcdef-0.tmp").write_text("text")
    os.mkfifo(folder / ".tltlc-5-0123456789abcdef.lock")
    (folder / ".tltlc-6-0123456789abcdef.lock").mkdir()
    before = {path.name for path in folder.iterdir()}
    remove_abandoned(folder)
    assert {path.name for path in folder.iterdir()} == before - set(removed)
    assert elsewhere.read_text() == "precious"


def test_files_are_written_on_a_file_system_without_locks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import fcntl

    def no_locks(*_: object) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(fcntl, "flock", no_locks)
    (tmp_path / f"{PREFIX}.lock").touch()
    write_files(tmp_path, {"a": "text"})
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"{PREFIX}.lock", "a"]


def test_a_removed_lock_file_is_created_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another process may take a new lock file for an abandoned one, and remove it before it is locked."""
    from tltlc.io import temporary as module

    attempts = []

    def removed_once(path: Path, file: object) -> bool:
        attempts.append(path)
        if len(attempts) == 1:
            path.unlink()
        return path.exists()

    monkeypatch.setattr(module, "_is_still_at", removed_once)
    write_files(tmp_path, {"a": "text"})
    assert len(set(attempts)) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
