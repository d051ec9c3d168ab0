"""The versions of Python and of the packages on which the course of an episode, or its judgement, depends."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from typing import Final

_JUDGING: Final = ("tltlc",)
_PACKAGES: Final = (*_JUDGING, "gymnasium", "pybullet", "numpy")


def versions() -> dict[str, str]:
    """Return the versions of Python and of those of these packages that are installed, by name."""
    return _versions(_PACKAGES)


def judging_versions() -> dict[str, str]:
    """Return the versions of Python and of tltlc, which alone decide how recorded traces are judged."""
    return _versions(_JUDGING)


def _versions(packages: Sequence[str]) -> dict[str, str]:
    versions_by_name = {"python": platform.python_version()}
    for name in packages:
        with suppress(PackageNotFoundError):
            versions_by_name[name] = version(name)
    return versions_by_name
