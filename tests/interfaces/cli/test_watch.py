"""``tltlc compile --watch``, as a person uses it: files are edited while it runs."""

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
WAITS = "waiting for changes, until Ctrl-C\n"
LIBRARY = "signal seen: bool\nlet hidden = !seen\n"
SPECS = "import lib\nspec calm = G hidden\nspec found = F seen\n"


class Watching:
    """A running command, of which one reads what it says between one wait for changes and the next."""

    def __init__(self, *arguments: str) -> None:
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", "tltlc", "compile", *arguments, "--watch"]
        self.process = subprocess.Popen(
            command, env=environment, stderr=subprocess.PIPE, text=True, preexec_fn=_interrupts_as_usual
        )
        # A test that waits for what does not come ends.
        self._timer = Timer(HANG_S, self.process.kill)
        self._timer.start()

    def said(self) -> str:
        assert self.process.stderr is not None
        lines: list[str] = []
        while not lines or lines[-1] != WAITS:
            line = self.process.stderr.readline()
            assert line, f"it ended: {lines}"
            lines.append(line)
        return "".join(lines[:-1])

    def says_at_last(self, wanted: str) -> None:
        """Read on until something is said: of two edits the first one may be seen alone."""
        while wanted not in self.said():
            pass

    def end(self) -> int:
        self.process.send_signal(signal.SIGINT)
        self.process.communicate()
        self._timer.cancel()
        return self.process.returncode


def _interrupts_as_usual() -> None:
    """Tests may run in the background of a shell, which ignores Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs a signal that reaches one process alone")


@pytest.fixture
def watching(inside: Path) -> Iterator[Watching]:
    (inside / "lib.tltl").write_text(LIBRARY)
    (inside / "specs.tltl").write_text(SPECS)
    running = Watching("specs.tltl", "-o", "out", "-t", "json,lua")
    yield running
    if running.process.returncode is None:
        running.end()


def _replace(path: Path, text: str) -> None:
    """As editors do: under another name first."""
    new = path.with_suffix(".new")
    new.write_text(text)
    new.replace(path)


def test_the_files_of_what_has_changed_are_written(watching: Watching, inside: Path) -> None:
    first = watching.said()
    assert [line.split()[0] for line in first.splitlines()] == ["wrote"] * 4
    found = {path: path.stat().st_mtime_ns for path in (inside / "out").iterdir()}

    _replace(inside / "specs.tltl", SPECS.replace("F seen", "F !seen"))
    second = watching.said()
    assert "changed: specs.tltl\n" in second
    assert "wrote out/found.fspa.json\nwrote out/found_monitor.lua\n2 files have not changed\n" in second
    changed = {path.name for path, time in found.items() if path.stat().st_mtime_ns != time}
    assert changed == {"found.fspa.json", "found_monitor.lua"}

    _replace(inside / "lib.tltl", LIBRARY + "// nothing new\n")
    assert watching.said().endswith("changed: lib.tltl\n4 files have not changed\n")
    assert watching.end() == 130


def test_errors_are_shown_and_waited_out(watching: Watching, inside: Path) -> None:
    watching.said()
    (inside / "lib.tltl").unlink()
    assert "error[TLT0010]" in watching.said()
    _replace(inside / "lib.tltl", LIBRARY)
    assert watching.said().endswith("changed: lib.tltl\n4 files have not changed\n")
    _replace(inside / "tltl.toml", "targets = 3")
    assert "error[TLT0703]" in watching.said()
    (inside / "tltl.toml").unlink()
    (inside / "specs.tltl").unlink()
    watching.says_at_last("error[TLT0001]")
    _replace(inside / "specs.tltl", SPECS)
    assert watching.said().endswith("changed: specs.tltl\n4 files have not changed\n")
    assert watching.end() == 130


def test_two_specs_that_come_to_have_one_name_are_waited_out(inside: Path) -> None:
    for name in "ab":
        (inside / f"{name}.tltl").write_text(f"signal seen: bool\nspec {name} = F seen\n")
    running = Watching("a.tltl", "b.tltl", "-o", "out", "-t", "json")
    try:
        running.said()
        _replace(inside / "b.tltl", "signal seen: bool\nspec a = F seen\n")
        said = running.said()
        assert (
            "error[TLT0700]: `a.tltl` and `b.tltl` both make `a.fspa.json`\n  help: rename one of the specs\n" in said
        )
        _replace(inside / "b.tltl", "signal seen: bool\nspec b = G seen\n")
        assert "wrote out/b.fspa.json\n" in running.said()
    finally:
        running.end()


def test_a_new_file_of_a_folder_is_compiled(inside: Path) -> None:
    running = Watching(".", "-o", "out", "-t", "json")
    try:
        assert running.said() == "wrote out/hide.fspa.json\n"
        _replace(inside / "new.tltl", "signal seen: bool\nspec found = F seen\n")
        assert "wrote out/found.fspa.json" in running.said()
    finally:
        running.end()


def test_what_cannot_be_mended_by_a_change_ends_it(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    done = process("compile", "hide.tltl", "--watch", "-t", "pythn")
    assert (done.status, done.err.splitlines()[0]) == (2, "error[TLT0710]: there is no target `pythn`")
    done = process("compile", "-", "--watch")
    assert (done.status, done.err.splitlines()[0]) == (
        2,
        "error[TLT0700]: --watch takes files: standard input does not change",
    )
    done = process("compile", "none.tltl", "--watch")
    assert (done.status, done.err.splitlines()[0]) == (
        3,
        "error[TLT0001]: cannot read `none.tltl`: there is no such file",
    )


def test_a_file_that_changes_all_the_time_is_compiled_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tltlc.interfaces.cli import watching
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

    monkeypatch.setattr(watching.time, "sleep", changed_meanwhile)
    with pytest.raises(KeyboardInterrupt):
        watching.repeat(work)
    assert [changed for _, changed in worked] == [(), (str(log),), (str(log),)]
    assert [place for place, _ in worked] == [0, 11, 22]
