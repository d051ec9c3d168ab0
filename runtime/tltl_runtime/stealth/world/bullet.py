"""Pybullet, imported without the line that it writes to standard error, where messages for programs may go.

No other module imports pybullet by itself: the first import is the one that speaks, and it does so from C.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def _silence() -> Iterator[None]:
    """Nothing reaches standard error; where the process has none, nothing needs to be kept from it."""
    if sys.stderr is not None:
        sys.stderr.flush()
    try:
        kept = os.dup(2)
    except OSError:
        yield
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    os.close(nowhere)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


with _silence():
    import pybullet

__all__ = ["pybullet"]
