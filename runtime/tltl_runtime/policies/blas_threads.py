"""Set the number of threads of NumPy's matrix products: the last bits of a network's output depend on it."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

# NumPy loads its library for matrix products when it is imported, so `_loaded_libraries` finds this library.
import numpy as np  # noqa: F401
from threadpoolctl import ThreadpoolController


def blas_threads(count: int) -> AbstractContextManager[object]:
    """Return a context manager; inside it, NumPy multiplies matrices in ``count`` threads."""
    limits: AbstractContextManager[object] = _loaded_libraries().limit(limits=count, user_api="blas")
    return limits


@cache
def _loaded_libraries() -> ThreadpoolController:
    """Find the libraries of this process that compute in threads.

    The search takes 10 ms, so it is made only once per process.
    """
    return ThreadpoolController()
