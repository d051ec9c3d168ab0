"""The runtime's tests need the extra `rl`: without it they are skipped, and say so."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

NEEDED = ("gymnasium", "numpy", "pybullet", "torch")
MISSING = [name for name in NEEDED if find_spec(name) is None]

collect_ignore_glob = ["*.py", "*/*.py"] if MISSING else []


def pytest_report_header() -> str | None:
    return f"tests/runtime is skipped: {', '.join(MISSING)} missing (the extra `rl`)" if MISSING else None


def pytest_configure(config: pytest.Config) -> None:
    if not MISSING:
        import torch

        torch.set_num_threads(1)
