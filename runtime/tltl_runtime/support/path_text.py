"""Format paths for messages."""

from __future__ import annotations

from pathlib import Path


def path_text(path: Path) -> str:
    """Return a path as text, relative to the current folder if the path is inside that folder."""
    try:
        return str(path.absolute().relative_to(Path.cwd()))
    except ValueError:
        return str(path)
