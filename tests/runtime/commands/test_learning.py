"""Commands that learn, or play what was learned, where what learns is not installed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S


@pytest.mark.parametrize("command", ["train soon.tltl", "evaluate --level branching", "inspect branching"])
def test_the_extra_that_is_missing_is_named(command: str, tmp_path: Path) -> None:
    hide = "import sys; sys.modules['torch'] = None"
    program = f"{hide}; from tltlc.cli.main import main; main({command.split()})"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S, check=False
    )
    name = command.partition(" ")[0]
    assert (done.returncode, done.stdout) == (4, "")
    assert done.stderr == (
        f"error[TLT0730]: `tltlc {name}` needs `torch`, which is not installed\n"
        "  help: in the clone of tltlc: pip install -c constraints.txt '.[rl]'\n"
    )
