"""Check the argument that names a suite."""

from __future__ import annotations

from pathlib import Path

from tltlc.api import fileio


def check_suite_exists(suite: Path | None) -> None:
    """Check that the suite exists, before the slow import of the modules that play. None is accepted.

    Raises:
        TltlError: TLT0001, the error that reading the suite would raise.
    """
    if suite is not None and not fileio.exists(suite):
        from tltl_runtime.support.path_text import path_text

        fileio.read_source(suite, path_text(suite))
