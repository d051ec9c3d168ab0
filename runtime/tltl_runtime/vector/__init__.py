"""Many environments at once, stepped by worker processes."""

from __future__ import annotations

from tltl_runtime.vector.env import WorkerVectorEnv
from tltl_runtime.vector.errors import Playing, WorkerError
from tltl_runtime.vector.level_environments import make_vec

__all__ = ["Playing", "WorkerError", "WorkerVectorEnv", "make_vec"]
