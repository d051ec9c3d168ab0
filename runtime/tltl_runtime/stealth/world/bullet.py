"""Import pybullet without the line that it prints on standard error.

The line would disturb programs that parse standard error. Pybullet prints it at the first import,
from C. So all other modules import pybullet from here. If pybullet is not installed, importing this
module raises TltlError, TLT0730.
"""

from __future__ import annotations

import sys

from tltl_runtime.support.quiet_stderr import silence
from tltlc.api import Diagnostic, TltlError


def _missing_package_error() -> TltlError:
    help_ = "in the clone of tltlc: pip install -c constraints.txt '.[game]'"
    if sys.version_info >= (3, 12):
        help_ = "it comes ready to use only for Python 3.10 and 3.11: install '.[game]' in the clone with one of these"
    return TltlError([Diagnostic("TLT0730", "the game needs `pybullet`, which is not installed", help=help_)])


try:
    with silence():
        import pybullet
except ModuleNotFoundError:
    raise _missing_package_error() from None

__all__ = ["pybullet"]
