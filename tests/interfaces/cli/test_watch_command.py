"""``tltlc watch`` while files are edited."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Timer

import pytest

from tests.interfaces.cli.conftest import ROOT
from tests.waiting import HANG_S

WAITS = "waiting for changes (press Ctrl-C to stop)\n"
SPEC = "import lib\nspec found { limit 9 steps  reach seen }\n"
TEST = 'test "seen" for found { step seen  expect satisfied }\n'

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs a signal that reaches one process alone")


class WatchProcess:
    """A running command; its messages are read from one wait for changes to the next."""

    def __init__(self, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tltlc", "watch", *arguments],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        # Kill the process so that a test does not wait for ever.
        self._timer = Timer(HANG_S, self.process.kill)
        self._timer.start()

    def next_messages(self) -> list[str]:
        assert self.process.stderr is not None
        lines: list[str] = []
        while not lines or lines[-1] != WAITS:
            lines.append(self.process.stderr.readline())
            assert lines[-1], f"it ended: {lines}"
        return [line.rstrip("\n") for line in lines[:-1]]

    def wait_for_messages(self, *lines: str) -> list[str]:
        """Read until one message has all these lines; the first of two edits may be reported alone."""
        while not set(lines) <= set(messages := self.next_messages()):
            pass
        return messages

    def end(self) -> int:
        self.process.send_signal(signal.SIGINT)
        self.process.communicate()
        self._timer.cancel()
        return self.process.returncode


def replace(path: Path, text: str) -> None:
    """Replace a file atomically, so that no process reads a part of it."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lib.tltl").write_text("signal seen: bool\n")
    (tmp_path / "found.tltl").write_text(SPEC + TEST)
    return tmp_path


@pytest.fixture
def watching(folder: Path) -> Iterator[WatchProcess]:
    running = WatchProcess()
    yield running
    if running.process.returncode is None:
        running.end()


def test_each_change_is_checked_linted_and_tested(watching: WatchProcess, folder: Path) -> None:
    assert watching.next_messages()[1:] == ["2 files: nothing to report, 1 test passed"]

    replace(folder / "found.tltl", SPEC + TEST.replace("satisfied", "pending"))
    messages = watching.next_messages()
    assert messages[1].endswith(" changed: found.tltl")
    assert messages[2] == "error[TLT0640]: this expectation does not hold"
    assert messages[-1] == "2 files: nothing to report, 1 test FAILED"

    replace(folder / "found.tltl", SPEC + "entity nobody\n")
    messages = watching.next_messages()
    assert messages[2] == "warning[TLT0421]: nothing uses the entity `nobody`"
    assert messages[-1] == "2 files: 1 warning"

    # The imported file changes; its importer must be checked again.
    replace(folder / "lib.tltl", "signal saw: bool\n")
    messages = watching.next_messages()
    assert messages[1].endswith(" changed: lib.tltl")
    assert "error[TLT0201]: no predicate `seen` here" in messages
    assert messages[-1].startswith("2 files: 1 error")
    replace(folder / "lib.tltl", "signal seen: bool\nsignal lit: bool\nlet dark = !lit\n")
    replace(folder / "found.tltl", SPEC.replace("reach seen", "reach seen  keep dark"))
    # A declaration that another file uses counts as used.
    watching.wait_for_messages("2 files: nothing to report")
    assert watching.end() == 130


def test_new_files_and_empty_folders_are_noticed(watching: WatchProcess, folder: Path) -> None:
    watching.next_messages()
    (folder / "deep").mkdir()
    replace(folder / "deep" / "new.tltl", "signal a: bool\nspec x { limit 9 steps  reach a }\n")
    messages = watching.next_messages()
    assert messages[1].endswith(f" changed: {Path('deep', 'new.tltl')}")
    assert messages[2:] == ["3 files: nothing to report, 1 test passed"]
    for path in (folder / "deep" / "new.tltl", folder / "found.tltl", folder / "lib.tltl"):
        path.unlink()
    messages = watching.next_messages()
    while not messages[-1].startswith("0 files"):
        messages = watching.next_messages()
    assert "error[TLT0722]: there is no .tltl file in `.`" in messages
    assert watching.end() == 130


def test_deleted_renamed_and_replaced_files_are_noticed(watching: WatchProcess, folder: Path) -> None:
    watching.next_messages()
    (folder / "lib.tltl").unlink()
    messages = watching.next_messages()
    assert "error[TLT0010]: there is no library `lib`" in messages
    assert messages[-1] == "1 file: 1 error"
    replace(folder / "lib.tltl~", "signal seen: bool\n")
    (folder / "lib.tltl~").replace(folder / "lib.tltl")
    assert watching.next_messages()[-1] == "2 files: nothing to report, 1 test passed"
    (folder / "found.tltl").rename(folder / "sought.tltl")
    messages = watching.next_messages()
    # On a busy machine, the command looks for new files less often than at known files.
    assert "changed:" in messages[1]
    assert "found.tltl" in messages[1] or "sought.tltl" in messages[1]
    assert messages[-1] == "2 files: nothing to report, 1 test passed"
    assert watching.end() == 130


def test_a_new_project_file_applies(watching: WatchProcess, folder: Path) -> None:
    watching.next_messages()
    replace(folder / "found.tltl", SPEC + "entity nobody\n")
    assert watching.next_messages()[-1] == "2 files: 1 warning"
    replace(folder / "tltl.toml", '[lint]\nallow = ["TLT0421"]\n')
    assert watching.next_messages()[-1] == "2 files: nothing to report"
    assert watching.end() == 130


def test_a_folder_that_disappears_and_returns_is_noticed(folder: Path) -> None:
    (folder / "deep").mkdir()
    running = WatchProcess("deep", "found.tltl", "found.tltl")
    try:
        messages = running.next_messages()
        assert "error[TLT0722]: there is no .tltl file in `deep`" in messages
        assert messages[-1] == "1 file: 1 error, 1 test passed"
        (folder / "deep").rmdir()
        assert "error[TLT0001]: cannot read `deep`: there is no such file" in running.next_messages()
        (folder / "new").mkdir()
        replace(folder / "new" / "a.tltl", "signal a: bool\nsignal b: bool\nspec x { limit 9 steps  reach a then b }\n")
        (folder / "new").rename(folder / "deep")
        assert running.next_messages()[-1] == "2 files: nothing to report, 1 test passed"
    finally:
        running.end()


def test_a_deleted_current_folder_ends_the_command(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "here").mkdir()
    replace(folder / "here" / "a.tltl", "signal a: bool\n")
    monkeypatch.chdir(folder / "here")
    running = WatchProcess()
    running.next_messages()
    monkeypatch.chdir(folder)
    (folder / "here" / "a.tltl").unlink()
    (folder / "here").rmdir()
    messages = running.process.communicate(timeout=HANG_S)[1]
    running.end()
    assert messages.splitlines()[0] == "error[TLT0001]: the current folder has been deleted"
    assert running.process.returncode == 3


def test_a_closed_pipe_ends_the_command(folder: Path) -> None:
    running = WatchProcess()
    running.next_messages()
    assert running.process.stderr is not None
    running.process.stderr.close()
    replace(folder / "found.tltl", SPEC)
    # The exit status of a program that gets SIGPIPE.
    assert running.process.wait(timeout=HANG_S) == 141
    running._timer.cancel()


def test_standard_input_cannot_be_watched(process, folder: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = process("watch", "-")
    assert (outcome.status, outcome.err.splitlines()[0]) == (
        2,
        "error[TLT0700]: `tltlc watch` takes files and folders: standard input does not change",
    )


def test_levels_of_the_project_apply_beside_errors(folder: Path) -> None:
    jumpy = "signal x in [0, 9]\npredicate p in [-1, 1] = when x < 5: x / 9 - 1 otherwise: 1\n"
    replace(folder / "lib.tltl", f"{jumpy}predicate q in [-1, 1] = x\nsignal seen: bool\n")
    replace(folder / "tltl.toml", '[lint]\nallow = ["TLT0402"]\n')
    running = WatchProcess("lib.tltl")
    try:
        messages = "\n".join(running.next_messages())
    finally:
        running.end()
    assert "error[TLT0306]" in messages and "TLT0402" not in messages
