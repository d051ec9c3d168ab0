"""The versions that an episode depends on: Python and the packages that play it."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from functools import lru_cache
from importlib.metadata import version
from typing import Final

_PACKAGES: Final = ("tltlc", "pybullet", "numpy")


@lru_cache(maxsize=1)
def versions() -> Mapping[str, str]:
    """Return the installed versions of Python and of the packages that play episodes, by name."""
    return {"python": platform.python_version(), **{name: version(name) for name in _PACKAGES}}
