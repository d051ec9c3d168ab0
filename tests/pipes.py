"""Entries of a folder that are no files, and a watch on who opens them: reading one could take for ever."""

from __future__ import annotations

import builtins
import io
import os
import stat
from pathlib import Path
from typing import Any

import pytest


def put_beside(path: Path) -> None:
    """Put a pipe at the path, and beside it a link to a device that never ends."""
    os.mkfifo(path)
    path.with_name(f"a_{path.name}").symlink_to("/dev/zero")


def forbid(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the test fail, instead of hang, where anything opens a pipe or /dev/zero."""
    really = io.open

    def checked(file: Any, *arguments: Any, **named: Any) -> Any:
        if not isinstance(file, int) and Path(file).exists():
            status = Path(file).stat()
            is_zero = stat.S_ISCHR(status.st_mode) and status.st_rdev == Path("/dev/zero").stat().st_rdev
            assert not stat.S_ISFIFO(status.st_mode) and not is_zero, f"{file} was opened"
        return really(file, *arguments, **named)

    monkeypatch.setattr(builtins, "open", checked)
    monkeypatch.setattr(io, "open", checked)
