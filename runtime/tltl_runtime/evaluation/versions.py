"""The versions of Python and of the packages on which the course of an episode depends."""

from __future__ import annotations

import platform
from importlib.metadata import version
from typing import Final

_PACKAGES: Final = ("tltlc", "gymnasium", "pybullet", "numpy")


def versions() -> dict[str, str]:
    """Return the installed versions of Python and of these packages, by name."""
    return {"python": platform.python_version(), **{name: version(name) for name in _PACKAGES}}
