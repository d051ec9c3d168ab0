"""The versions of Python and of the packages on which episodes and the judgement of traces depend."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from typing import Final

_JUDGING: Final = ("tltlc",)
_PACKAGES: Final = (*_JUDGING, "gymnasium", "pybullet", "numpy")


def versions() -> dict[str, str]:
    """Return the versions of Python, tltlc, Gymnasium, PyBullet and NumPy: ``{"python": "3.11.9", …}``.

    Packages that are not installed are left out.
    """
    return _versions(_PACKAGES)


def judging_versions() -> dict[str, str]:
    """Return the versions of Python and tltlc, by name: how recorded traces are judged depends on these alone."""
    return _versions(_JUDGING)


def _versions(packages: Sequence[str]) -> dict[str, str]:
    versions_by_name = {"python": platform.python_version()}
    for name in packages:
        with suppress(PackageNotFoundError):
            versions_by_name[name] = version(name)
    return versions_by_name
