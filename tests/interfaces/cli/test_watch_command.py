"""``tltlc watch``, as a person uses it: files are edited while it runs."""

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

WAITS = "waiting for changes, until Ctrl-C\n"
SPEC = "import lib\nspec found { limit 9 steps  reach seen }\n"
TEST = 'test "seen" for found { step seen  expect satisfied }\n'

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs a signal that reaches one process alone")


class Watching:
    """A running command, of which one reads what it says between one wait for changes and the next."""

    def __init__(self, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tltlc", "watch", *arguments],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        # A test that waits for what does not come ends.
        self._timer = Timer(HANG_S, self.process.kill)
        self._timer.start()

    def said(self) -> list[str]:
        assert self.process.stderr is not None
        lines: list[str] = []
        while not lines or lines[-1] != WAITS:
            lines.append(self.process.stderr.readline())
            assert lines[-1], f"it ended: {lines}"
        return [line.rstrip("\n") for line in lines[:-1]]

    def says_at_last(self, *lines: str) -> list[str]:
        """Read on until all these are said at once: of two edits the first one may be seen alone."""
        while not set(lines) <= set(said := self.said()):
            pass
        return said

    def end(self) -> int:
        self.process.send_signal(signal.SIGINT)
        self.process.communicate()
        self._timer.cancel()
        return self.process.returncode


def replace(path: Path, text: str) -> None:
    """Write a file at once, so that nobody sees a half of it."""
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
def watching(folder: Path) -> Iterator[Watching]:
    running = Watching()
    yield running
    if running.process.returncode is None:
        running.end()


def test_errors_lints_and_tests_after_each_change(watching: Watching, folder: Path) -> None:
    assert watching.said()[1:] == ["2 files: nothing to report, 1 test passed"]

    replace(folder / "found.tltl", SPEC + TEST.replace("satisfied", "pending"))
    said = watching.said()
    assert said[1].endswith(" changed: found.tltl")
    assert said[2] == "error[TLT0640]: this expectation does not hold"
    assert said[-1] == "2 files: nothing to report, 1 test FAILED"

    replace(folder / "found.tltl", SPEC + "entity nobody\n")
    said = watching.said()
    assert said[2] == "warning[TLT0421]: nothing uses the entity `nobody`"
    assert said[-1] == "2 files: 1 warning"

    # An import, of a file that two others might have.
    replace(folder / "lib.tltl", "signal saw: bool\n")
    said = watching.said()
    assert said[1].endswith(" changed: lib.tltl")
    assert "error[TLT0201]: no predicate `seen` here" in said
    assert said[-1].startswith("2 files: 1 error")
    replace(folder / "lib.tltl", "signal seen: bool\nsignal lit: bool\nlet dark = !lit\n")
    replace(folder / "found.tltl", SPEC.replace("reach seen", "reach seen  keep dark"))
    # What another file uses is used.
    watching.says_at_last("2 files: nothing to report")
    assert watching.end() == 130


def test_new_files_and_folders_without_files(watching: Watching, folder: Path) -> None:
    watching.said()
    (folder / "deep").mkdir()
    replace(folder / "deep" / "new.tltl", "signal a: bool\nspec x { limit 9 steps  reach a }\n")
    said = watching.said()
    assert said[1].endswith(f" changed: {Path('deep', 'new.tltl')}")
    assert said[2:] == ["3 files: nothing to report, 1 test passed"]
    for path in (folder / "deep" / "new.tltl", folder / "found.tltl", folder / "lib.tltl"):
        path.unlink()
    said = watching.said()
    while not said[-1].startswith("0 files"):
        said = watching.said()
    assert "error[TLT0722]: there is no .tltl file in `.`" in said
    assert watching.end() == 130


def test_a_file_is_deleted_renamed_and_replaced_as_editors_do(watching: Watching, folder: Path) -> None:
    watching.said()
    (folder / "lib.tltl").unlink()
    said = watching.said()
    assert "error[TLT0010]: there is no library `lib`" in said
    assert said[-1] == "1 file: 1 error"
    replace(folder / "lib.tltl~", "signal seen: bool\n")
    (folder / "lib.tltl~").replace(folder / "lib.tltl")
    assert watching.said()[-1] == "2 files: nothing to report, 1 test passed"
    (folder / "found.tltl").rename(folder / "sought.tltl")
    said = watching.said()
    # A busy machine looks for new files less often than at those that it knows.
    assert "changed:" in said[1]
    assert "found.tltl" in said[1] or "sought.tltl" in said[1]
    assert said[-1] == "2 files: nothing to report, 1 test passed"
    assert watching.end() == 130


def test_a_project_file_that_comes_counts(watching: Watching, folder: Path) -> None:
    watching.said()
    replace(folder / "found.tltl", SPEC + "entity nobody\n")
    assert watching.said()[-1] == "2 files: 1 warning"
    replace(folder / "tltl.toml", '[lint]\nallow = ["TLT0421"]\n')
    assert watching.said()[-1] == "2 files: nothing to report"
    assert watching.end() == 130


def test_a_folder_that_goes_and_comes_back(folder: Path) -> None:
    (folder / "deep").mkdir()
    running = Watching("deep", "found.tltl", "found.tltl")
    try:
        said = running.said()
        assert "error[TLT0722]: there is no .tltl file in `deep`" in said
        assert said[-1] == "1 file: 1 error, 1 test passed"
        (folder / "deep").rmdir()
        assert "error[TLT0001]: cannot read `deep`: there is no such file" in running.said()
        (folder / "new").mkdir()
        replace(folder / "new" / "a.tltl", "signal a: bool\nspec x { limit 9 steps  reach a then a }\n")
        (folder / "new").rename(folder / "deep")
        assert running.said()[-1] == "2 files: nothing to report, 1 test passed"
    finally:
        running.end()


def test_the_current_folder_goes(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "here").mkdir()
    replace(folder / "here" / "a.tltl", "signal a: bool\n")
    monkeypatch.chdir(folder / "here")
    running = Watching()
    running.said()
    monkeypatch.chdir(folder)
    (folder / "here" / "a.tltl").unlink()
    (folder / "here").rmdir()
    said = running.process.communicate(timeout=HANG_S)[1]
    running.end()
    assert said.splitlines()[0] == "error[TLT0001]: the current folder has been deleted"
    assert running.process.returncode == 3


def test_who_reads_it_goes(folder: Path) -> None:
    running = Watching()
    running.said()
    assert running.process.stderr is not None
    running.process.stderr.close()
    replace(folder / "found.tltl", SPEC)
    # As every program that writes into a pipe.
    assert running.process.wait(timeout=HANG_S) == 141
    running._timer.cancel()


def test_what_cannot_be_watched(process, folder: Path) -> None:  # type: ignore[no-untyped-def]
    done = process("watch", "-")
    assert (done.status, done.err.splitlines()[0]) == (
        2,
        "error[TLT0700]: `tltlc watch` takes files and folders: standard input does not change",
    )


def test_the_levels_of_a_project_beside_errors(folder: Path) -> None:
    jumpy = "signal x in [0, 9]\npredicate p in [-1, 1] = when x < 5: x / 9 - 1 otherwise: 1\n"
    replace(folder / "lib.tltl", f"{jumpy}predicate q in [-1, 1] = x\nsignal seen: bool\n")
    replace(folder / "tltl.toml", '[lint]\nallow = ["TLT0402"]\n')
    running = Watching("lib.tltl")
    try:
        said = "\n".join(running.said())
    finally:
        running.end()
    assert "error[TLT0306]" in said and "TLT0402" not in said
