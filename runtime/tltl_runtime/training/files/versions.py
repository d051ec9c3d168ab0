"""The versions of Python and of the packages that a training depends on."""

from __future__ import annotations

import platform
from importlib.metadata import version
from typing import Final

_PACKAGES: Final = ("tltlc", "torch", "rsl-rl-lib", "gymnasium", "pybullet", "numpy")


def versions() -> dict[str, str]:
    """Return the versions of Python and of the installed packages, by name."""
    return {"python": platform.python_version(), **{name: version(name) for name in _PACKAGES}}
