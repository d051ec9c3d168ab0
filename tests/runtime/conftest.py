"""The tests of the runtime need the extra `rl`. Without it only `test_extra.py` is collected, and skipped."""

from __future__ import annotations

import fcntl
import os
from importlib.util import find_spec
from pathlib import Path
from tempfile import gettempdir

import pytest

NEEDED = ("gymnasium", "numpy", "pybullet", "torch")
MISSING = [name for name in NEEDED if find_spec(name) is None]

collect_ignore = [str(path) for path in Path(__file__).parent.rglob("*.py")] if MISSING else []
"""All files but ``test_extra.py``, which is skipped with the reason."""
collect_ignore = [path for path in collect_ignore if not path.endswith(("test_extra.py", "conftest.py", "__init__.py"))]


def pytest_configure(config: pytest.Config) -> None:
    if not MISSING:
        import torch

        torch.set_num_threads(1)
        _find_fonts()


def _find_fonts() -> None:
    """Let matplotlib find the fonts of this machine before the first test.

    Otherwise the first process that draws does it, with a message on standard error if that takes long.
    If several processes do it at once, some may fail.
    """
    with Path(gettempdir(), f"tltlc-tests-fonts-{os.getuid()}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        import matplotlib.font_manager  # noqa: F401
