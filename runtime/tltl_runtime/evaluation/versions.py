"""The versions of Python and of the packages on which the course of an episode depends."""

from __future__ import annotations

import platform
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from typing import Final

_PACKAGES: Final = ("tltlc", "gymnasium", "pybullet", "numpy")


def versions() -> dict[str, str]:
    """Return the versions of Python and of those of these packages that are installed, by name."""
    versions_by_name = {"python": platform.python_version()}
    for name in _PACKAGES:
        with suppress(PackageNotFoundError):
            versions_by_name[name] = version(name)
    return versions_by_name
