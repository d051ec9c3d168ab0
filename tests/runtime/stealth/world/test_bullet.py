"""Pybullet is imported in one module only, and prints nothing."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import tltl_runtime
from tests.waiting import HANG_S

_PACKAGE = Path(tltl_runtime.__file__).parent


@pytest.mark.parametrize("closed", ["", "2>&-"])
def test_the_game_is_silent(closed: str) -> None:
    program = "from tltl_runtime.stealth.env import make_env; make_env('navigation').close(); print('made')"
    done = subprocess.run(
        f'"{sys.executable}" -c "{program}" {closed}', shell=True, capture_output=True, text=True, timeout=HANG_S
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "made\n", "")


def test_one_module_imports_pybullet() -> None:
    importing = re.compile(r"^\s*(import|from) pybullet\b", re.MULTILINE)
    importers = [path.name for path in _PACKAGE.rglob("*.py") if importing.search(path.read_text(encoding="utf-8"))]
    assert importers == ["bullet.py"]
