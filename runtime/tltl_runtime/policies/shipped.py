"""The policies that ship with the package, one for each of its levels."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.policies.file import SUFFIX

_FOLDER: Final = Path(__file__).with_name("shipped")


def shipped_policies() -> dict[str, Path]:
    """Return the files of the shipped policies, by the names of their levels."""
    return {path.name.removesuffix(SUFFIX): path for path in sorted(_FOLDER.glob(f"*{SUFFIX}"))}


def shipped_policy(level: str) -> Path | None:
    """Return the file of the policy that ships for the level ``level``; None if there is none."""
    return shipped_policies().get(level)
