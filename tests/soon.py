"""Run what once took hours, and now takes less than a second."""

from __future__ import annotations

import subprocess
import sys
from typing import Final

_SECONDS: Final = 120.0


def soon(code: str) -> str:
    """Run Python code in a process of its own and return its output; fail the test after two minutes."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=_SECONDS, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout
