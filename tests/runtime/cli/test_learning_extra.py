"""Commands that train or use policies: torch is reported if missing, and is imported as late as possible."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S


@pytest.mark.parametrize("command", ["train soon.tltl", "evaluate --level branching", "inspect branching"])
def test_a_missing_extra_is_named(command: str, tmp_path: Path) -> None:
    hide = "import sys; sys.modules['torch'] = None"
    program = f"{hide}; from tltlc.interfaces.cli.main import main; main({command.split()})"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S, check=False
    )
    name = command.partition(" ")[0]
    assert (done.returncode, done.stdout) == (4, "")
    assert done.stderr == (
        f"error[TLT0730]: `tltlc {name}` needs `torch`, which is not installed\n"
        "  help: in the clone of tltlc: pip install -c constraints.txt '.[rl]'\n"
    )


def test_missing_files_are_reported_before_torch_is_imported(tmp_path: Path) -> None:
    program = """
import sys
from tltlc.interfaces.cli.main import main

for command in sys.argv[1:]:
    try:
        main(command.split())
    except SystemExit as ended:
        print(ended.code, "torch" in sys.modules)
"""
    commands = ["evaluate --level gone", "evaluate --level gone.toml", "evaluate gone.safetensors"]
    commands += ["evaluate --level branching:v9", "regress gone.toml", "baseline gone.toml"]
    done = subprocess.run(
        [sys.executable, "-c", program, *commands], cwd=tmp_path, capture_output=True, text=True, timeout=HANG_S
    )
    assert done.stdout.splitlines() == ["2 False", "3 False", "3 False", "2 False", "3 False", "3 False"], done.stderr
    codes = [line.partition("]")[0] for line in done.stderr.splitlines() if line.startswith("error[")]
    assert codes == [f"error[TLT0{code}" for code in ("800", "001", "001", "800", "001", "001")]
