"""``tltlc compile --watch`` while files are edited."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from threading import Timer

import pytest

from tests.waiting import HANG_S

ROOT = Path(__file__).parents[3]
WAITS = "waiting for changes (press Ctrl-C to stop)\n"
LIBRARY = "signal seen: bool\nlet hidden = !seen\n"
SPECS = "import lib\nspec calm = G hidden\nspec found = F seen\n"


class WatchProcess:
    """A running command; its messages are read from one wait for changes to the next."""

    def __init__(self, *arguments: str) -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", "tltlc", "compile", *arguments, "--watch"]
        self.process = subprocess.Popen(
            command, env=environment, stderr=subprocess.PIPE, text=True, preexec_fn=_interrupts_as_usual
        )
        # Kill the process so that a test does not wait for ever.
        self._timer = Timer(HANG_S, self.process.kill)
        self._timer.start()

    def next_messages(self) -> str:
        assert self.process.stderr is not None
        lines: list[str] = []
        while not lines or lines[-1] != WAITS:
            line = self.process.stderr.readline()
            assert line, f"it ended: {lines}"
            lines.append(line)
        return "".join(lines[:-1])

    def wait_for_messages(self, text: str) -> None:
        """Read until a message contains a text; the first of two edits may be reported alone."""
        while text not in self.next_messages():
            pass

    def end(self) -> int:
        self.process.send_signal(signal.SIGINT)
        self.process.communicate()
        self._timer.cancel()
        return self.process.returncode


def _interrupts_as_usual() -> None:
    """Restore the handler of SIGINT: a shell ignores Ctrl-C for tests in the background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs a signal that reaches one process alone")


@pytest.fixture
def watching(inside: Path) -> Iterator[WatchProcess]:
    (inside / "lib.tltl").write_text(LIBRARY)
    (inside / "specs.tltl").write_text(SPECS)
    running = WatchProcess("specs.tltl", "-o", "out", "-t", "json,lua")
    yield running
    if running.process.returncode is None:
        running.end()


def _replace(path: Path, text: str) -> None:
    """Replace a file as editors do: write another file and rename it."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


def test_only_changed_files_are_written(watching: WatchProcess, inside: Path) -> None:
    first = watching.next_messages()
    assert [line.split()[0] for line in first.splitlines()] == ["wrote"] * 4
    times = {path: path.stat().st_mtime_ns for path in (inside / "out").iterdir()}

    _replace(inside / "specs.tltl", SPECS.replace("F seen", "F !seen"))
    second = watching.next_messages()
    assert "changed: specs.tltl\n" in second
    assert "wrote out/found.fspa.json\nwrote out/found_monitor.lua\n2 files have not changed\n" in second
    changed = {path.name for path, time in times.items() if path.stat().st_mtime_ns != time}
    assert changed == {"found.fspa.json", "found_monitor.lua"}

    _replace(inside / "lib.tltl", LIBRARY + "// nothing new\n")
    assert watching.next_messages().endswith("changed: lib.tltl\n4 files have not changed\n")
    assert watching.end() == 130


def test_compiling_resumes_after_errors_are_fixed(watching: WatchProcess, inside: Path) -> None:
    watching.next_messages()
    (inside / "lib.tltl").unlink()
    assert "error[TLT0010]" in watching.next_messages()
    _replace(inside / "lib.tltl", LIBRARY)
    assert watching.next_messages().endswith("changed: lib.tltl\n4 files have not changed\n")
    _replace(inside / "tltl.toml", "targets = 3")
    assert "error[TLT0703]" in watching.next_messages()
    (inside / "tltl.toml").unlink()
    (inside / "specs.tltl").unlink()
    watching.wait_for_messages("error[TLT0001]")
    _replace(inside / "specs.tltl", SPECS)
    assert watching.next_messages().endswith("changed: specs.tltl\n4 files have not changed\n")
    assert watching.end() == 130


def test_compiling_resumes_after_a_name_conflict_is_fixed(inside: Path) -> None:
    for name in "ab":
        (inside / f"{name}.tltl").write_text(f"signal seen: bool\nspec {name} = F seen\n")
    running = WatchProcess("a.tltl", "b.tltl", "-o", "out", "-t", "json")
    try:
        running.next_messages()
        _replace(inside / "b.tltl", "signal seen: bool\nspec a = F seen\n")
        messages = running.next_messages()
        assert (
            "error[TLT0700]: `a.tltl` and `b.tltl` both make `a.fspa.json`\n  help: rename one of the specs\n"
            in messages
        )
        _replace(inside / "b.tltl", "signal seen: bool\nspec b = G seen\n")
        assert "wrote out/b.fspa.json\n" in running.next_messages()
    finally:
        running.end()


def test_a_new_file_in_a_folder_is_compiled(inside: Path) -> None:
    running = WatchProcess(".", "-o", "out", "-t", "json")
    try:
        assert running.next_messages() == "wrote out/hide.fspa.json\n"
        _replace(inside / "new.tltl", "signal seen: bool\nspec found = F seen\n")
        assert "wrote out/found.fspa.json" in running.next_messages()
    finally:
        running.end()


def test_errors_that_no_edit_can_fix_end_the_command(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = process("compile", "hide.tltl", "--watch", "-t", "pythn")
    assert (outcome.status, outcome.err.splitlines()[0]) == (2, "error[TLT0710]: there is no target `pythn`")
    outcome = process("compile", "-", "--watch")
    assert (outcome.status, outcome.err.splitlines()[0]) == (
        2,
        "error[TLT0700]: --watch takes files: standard input does not change",
    )
    outcome = process("compile", "none.tltl", "--watch")
    assert (outcome.status, outcome.err.splitlines()[0]) == (
        3,
        "error[TLT0001]: cannot read `none.tltl`: there is no such file",
    )


def test_a_file_that_changes_constantly_is_compiled_nevertheless(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tltlc.interfaces.cli import repeated_runs
    from tltlc.io import files

    log, looks, worked = tmp_path / "log.tltl", [], []

    def changed_meanwhile(_: float) -> None:
        looks.append(1)
        assert len(looks) < 100, "it waits for ever"
        log.write_text("x" * len(looks))

    def work(changed: tuple[str, ...]) -> None:
        worked.append((len(looks), changed))
        if len(worked) == 3:
            raise KeyboardInterrupt
        files.is_file(str(log))

    monkeypatch.setattr(repeated_runs.time, "sleep", changed_meanwhile)
    with pytest.raises(KeyboardInterrupt):
        repeated_runs.repeat(work)
    assert [changed for _, changed in worked] == [(), (str(log),), (str(log),)]
    assert [place for place, _ in worked] == [0, 11, 22]
