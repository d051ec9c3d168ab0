"""Many environments at once, stepped by worker processes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tltl_runtime.vector.env import WorkerVectorEnv
from tltl_runtime.vector.errors import Playing, WorkerError

if TYPE_CHECKING:
    from tltl_runtime.vector.game import make_vec

__all__ = ["Playing", "WorkerError", "WorkerVectorEnv", "make_vec"]


def __getattr__(name: str) -> object:
    if name != "make_vec":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # Importing the game needs pybullet, which other environments do not need.
    from tltl_runtime.vector.game import make_vec

    return make_vec
