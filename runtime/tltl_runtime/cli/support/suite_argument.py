"""Check the argument that names a suite."""

from __future__ import annotations

from pathlib import Path

from tltlc.io.files import exists, read_source


def check_there(suite: Path | None) -> None:
    """Check early that the suite exists, before torch is imported, which takes seconds.

    Raises:
        TltlError: TLT0001, the same error as reading the suite would raise.
    """
    if suite is not None and not exists(suite):
        from tltl_runtime.stealth.levels.made_for import shown

        read_source(suite, shown(suite))
