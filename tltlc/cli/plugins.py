"""What other distributions, or parts that need an extra, add to the command line through entry points."""

from __future__ import annotations

import os
import sys
from typing import Any

from tltlc.cli import exits


def find(group: str) -> Any:
    """The entry points of a group, none of them loaded."""
    if not any(_may_have(group, folder) for folder in sys.path):
        return ()
    from importlib.metadata import entry_points

    return entry_points(group=group)


def load(plugin: Any, wanted_by: str) -> Any:
    """What an entry point stands for; error TLT0730, with the way to install it, where it lacks a component."""
    try:
        return plugin.load()
    except ModuleNotFoundError as error:
        package = plugin.dist.name if plugin.dist else "tltlc"
        wanted = f"{package}[{','.join(plugin.extras)}]" if plugin.extras else error.name or package
        raise exits.missing_component(wanted_by, error.name or package, wanted) from error


def _may_have(group: str, folder: str) -> bool:
    """Whether a distribution in the folder names the group: asking importlib.metadata costs 16 ms."""
    try:
        names = os.listdir(folder or ".")  # noqa: PTH208 (no pathlib while only help is asked for)
    except OSError:
        return os.path.isfile(folder)  # noqa: PTH113 (what is inside an archive, only importlib.metadata can say)
    for name in names:
        if name.endswith((".dist-info", ".egg-info")):
            try:
                with open(f"{folder or '.'}/{name}/entry_points.txt", "rb") as file:  # noqa: PTH123
                    if f"[{group}]".encode() in file.read():
                        return True
            except OSError:
                continue
    return False
