"""Vector environments: many Gymnasium environments at once, stepped by worker processes.

Begin with :class:`WorkerVectorEnv`.
"""

from __future__ import annotations

from tltl_runtime.vector.env import WorkerVectorEnv
from tltl_runtime.vector.errors import Playing, WorkerError
from tltl_runtime.vector.level_environments import make_vec

__all__ = ["Playing", "WorkerError", "WorkerVectorEnv", "make_vec"]
