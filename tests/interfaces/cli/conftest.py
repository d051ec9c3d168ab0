from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.waiting import HANG_S

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples" / "cover_and_hide.tltl"

HIDE = "signal seen: bool\nspec hide = G !seen\n"


@dataclass(frozen=True)
class Outcome:
    status: int
    out: str
    err: str


@pytest.fixture
def inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A temporary folder with one valid source file, as the current folder."""
    (tmp_path / "hide.tltl").write_text(HIDE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def tltlc(capfd: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """A function that runs a command line in this process."""

    def run(*arguments: str | Path) -> Outcome:
        from tltlc.interfaces.cli.main import main

        capfd.readouterr()
        with pytest.raises(SystemExit) as exit_:
            main([str(argument) for argument in arguments])
        assert isinstance(exit_.value.code, int)
        captured = capfd.readouterr()
        return Outcome(exit_.value.code, captured.out, captured.err)

    return run


@pytest.fixture
def process() -> Callable[..., Outcome]:
    """A function that runs a command line in a new process."""

    def run(*arguments: str | Path, stdin: bytes = b"", **environment: str) -> Outcome:
        completed = subprocess.run(
            [sys.executable, "-m", "tltlc", *map(str, arguments)],
            input=stdin,
            capture_output=True,
            timeout=HANG_S,
            env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
            check=False,
        )
        return Outcome(completed.returncode, completed.stdout.decode(), completed.stderr.decode())

    return run
