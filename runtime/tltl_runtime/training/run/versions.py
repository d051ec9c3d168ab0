"""What a training depends on beside its settings: the versions of Python and of packages."""

from __future__ import annotations

import platform
from importlib.metadata import version
from typing import Final

_PACKAGES: Final = ("tltlc", "torch", "rsl-rl-lib", "gymnasium", "pybullet", "numpy")


def versions() -> dict[str, str]:
    """The versions here and now, by name."""
    return {"python": platform.python_version(), **{name: version(name) for name in _PACKAGES}}
