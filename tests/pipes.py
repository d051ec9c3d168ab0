"""Pipes and devices in a folder, and a check that nothing opens them.

A test that reads one could block forever.
"""

from __future__ import annotations

import builtins
import io
import os
import stat
from pathlib import Path
from typing import Any

import pytest


def put_beside(path: Path) -> None:
    """Create a pipe at ``path``, and beside it a link to a device that never ends."""
    os.mkfifo(path)
    path.with_name(f"a_{path.name}").symlink_to("/dev/zero")


def forbid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the test fail, instead of hang, if anything opens a pipe or /dev/zero."""
    original = io.open

    def checked_open(file: Any, *arguments: Any, **named: Any) -> Any:
        if not isinstance(file, int) and Path(file).exists():
            status = Path(file).stat()
            is_zero = stat.S_ISCHR(status.st_mode) and status.st_rdev == Path("/dev/zero").stat().st_rdev
            assert not stat.S_ISFIFO(status.st_mode) and not is_zero, f"{file} was opened"
        return original(file, *arguments, **named)

    monkeypatch.setattr(builtins, "open", checked_open)
    monkeypatch.setattr(io, "open", checked_open)
