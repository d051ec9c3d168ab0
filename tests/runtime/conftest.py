"""Skip the tests of the runtime if the extra `rl` is not installed.

Then pytest collects only `test_extra.py`, which it skips with the reason.
"""

from __future__ import annotations

import fcntl
import os
from importlib.util import find_spec
from pathlib import Path
from tempfile import gettempdir

import pytest

from tests.waiting import HANG_S

NEEDED = ("gymnasium", "numpy", "pybullet", "torch")
MISSING = [name for name in NEEDED if find_spec(name) is None]

collect_ignore = [str(path) for path in Path(__file__).parent.rglob("*.py")] if MISSING else []
"""The files that pytest does not collect, because a package is missing."""
collect_ignore = [path for path in collect_ignore if not path.endswith(("test_extra.py", "conftest.py", "__init__.py"))]


def pytest_configure(config: pytest.Config) -> None:
    if not MISSING:
        import torch

        torch.set_num_threads(1)
        _wait_for_busy_workers()
        _find_fonts()


def _wait_for_busy_workers() -> None:
    """Let environments of the tests wait for their workers as long as any test waits, instead of 60 s.

    On a machine with too little memory, a step can take minutes.
    """
    from tltl_runtime.vector import WorkerVectorEnv

    assert WorkerVectorEnv.__init__.__kwdefaults__ is not None
    WorkerVectorEnv.__init__.__kwdefaults__["timeout"] = HANG_S


def _find_fonts() -> None:
    """Let matplotlib find the fonts of this machine before the first test.

    Otherwise the first process that draws does it, and prints a message on standard error if that
    takes long. If several processes do it at once, some may fail.
    """
    with Path(gettempdir(), f"tltlc-tests-fonts-{os.getuid()}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        import matplotlib.font_manager  # noqa: F401
