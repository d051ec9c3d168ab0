"""Pybullet, imported without the line that it writes to standard error, where messages for programs may go.

No other module imports pybullet by itself: the first import is the one that speaks, and it does so from C.  Where it is
not installed, importing this module raises TltlError, TLT0730.
"""

from __future__ import annotations

import sys

from tltl_runtime.support.quiet_stderr import silence
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def _missing() -> TltlError:
    way_out = "in the clone of tltlc: pip install -c constraints.txt '.[game]'"
    if sys.version_info >= (3, 12):
        way_out = "it comes ready to use for Python 3.10 and 3.11 alone: install '.[game]' in the clone with one"
    return TltlError([Diagnostic("TLT0730", "the game needs `pybullet`, which is not installed", help=way_out)])


try:
    with silence():
        import pybullet
except ModuleNotFoundError:
    raise _missing() from None

__all__ = ["pybullet"]
