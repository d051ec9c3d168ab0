"""Pybullet, imported without the line that it writes to standard error, where messages for programs may go.

No other module imports pybullet by itself: the first import is the one that speaks, and it does so from C.  Where it is
not installed, importing this module raises TltlError, TLT0730.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


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


def _missing() -> TltlError:
    way_out = "pip install 'tltlc[game]'"
    if sys.version_info >= (3, 12):
        way_out = "it comes ready to use for Python 3.10 and 3.11 alone: install 'tltlc[game]' with one of these"
    return TltlError([Diagnostic("TLT0730", "the game needs `pybullet`, which is not installed", help=way_out)])


try:
    with _silence():
        import pybullet
except ModuleNotFoundError:
    raise _missing() from None

__all__ = ["pybullet"]
