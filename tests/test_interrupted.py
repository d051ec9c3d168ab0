"""A child process that ends by a signal interrupts the command, and is not an error of the child."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.tools.diff.repository import _repository, needs_git  # noqa: F401
from tests.waiting import HANG_S
from tltlc.io.child_interrupts import raise_if_interrupted

ROOT = Path(__file__).parents[1]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs signals that reach one process alone")


@pytest.mark.parametrize("status", [0, 1, 2, 128, 129, -9, -11, 141])
def test_other_exit_statuses_are_no_interrupt(status: int) -> None:
    raise_if_interrupted(status)


@pytest.mark.parametrize("status", [-signal.SIGINT, -signal.SIGTERM, 130, 143])
def test_an_interrupted_child_is_an_interrupt(status: int) -> None:
    with pytest.raises(KeyboardInterrupt):
        raise_if_interrupted(status)


def test_importing_the_layout_process_changes_no_signal() -> None:
    code = (
        "import signal; before = signal.getsignal(signal.SIGINT)\n"
        "import tltlc.backends.drawing.child; assert signal.getsignal(signal.SIGINT) is before"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=HANG_S)


@needs_git
@pytest.mark.parametrize("word", ["rev-parse", "ls-tree", "--batch-check", "--batch"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_git_is_an_interrupt(repository: Path, word: str, number: signal.Signals) -> None:
    """Ctrl-C goes to all processes of a terminal, and git may end first."""
    tools, temporary = repository / "tools", repository / "temporary"
    tools.mkdir()
    temporary.mkdir()
    real = subprocess.run(["which", "git"], capture_output=True, text=True, check=True).stdout.strip()
    script = f'#!/bin/sh\ncase " $* " in *" {word}"*) kill -{number.value} $$;; esac\nexec {real} "$@"\n'
    (tools / "git").write_text(script, encoding="utf-8")
    (tools / "git").chmod(0o755)
    environment = {
        **os.environ,
        "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}",
        "PYTHONPATH": str(ROOT),
        "TMPDIR": str(temporary),
    }
    command = [sys.executable, "-m", "tltlc", "breaking", "specs", "--against", "v1"]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert (result.returncode, result.stdout, result.stderr) == (128 + number, "", "")
    assert list(temporary.iterdir()) == []
