"""The file of a suite as an argument of commands."""

from __future__ import annotations

from pathlib import Path

from tltlc.io.files import exists, read_source


def check_there(suite: Path | None) -> None:
    """Raise the TltlError that is raised where a suite is read which is not there, before torch is loaded, which takes
    seconds.
    """
    if suite is not None and not exists(suite):
        from tltl_runtime.stealth.levels.made_for import shown

        read_source(suite, shown(suite))
