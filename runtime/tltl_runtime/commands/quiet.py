"""Loading pybullet without the line that it writes to standard error, where messages for programs may go."""

from __future__ import annotations

import os
import sys


def load_pybullet() -> None:
    """Import pybullet, silently."""
    if "pybullet" in sys.modules:
        return
    sys.stderr.flush()
    kept = os.dup(2)
    with open(os.devnull, "wb") as nowhere:  # noqa: PTH123 (a device)
        os.dup2(nowhere.fileno(), 2)
    try:
        import pybullet  # noqa: F401
    finally:
        os.dup2(kept, 2)
        os.close(kept)
