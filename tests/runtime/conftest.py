"""The runtime's tests need the extra `rl`: without it `test_extra.py` alone is collected, and skipped."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest

NEEDED = ("gymnasium", "numpy", "pybullet", "torch")
MISSING = [name for name in NEEDED if find_spec(name) is None]

collect_ignore = [str(path) for path in Path(__file__).parent.rglob("*.py")] if MISSING else []
"""All but ``test_extra.py``, which is skipped with the reason."""
collect_ignore = [path for path in collect_ignore if not path.endswith(("test_extra.py", "conftest.py", "__init__.py"))]


def pytest_configure(config: pytest.Config) -> None:
    if not MISSING:
        import torch

        torch.set_num_threads(1)
