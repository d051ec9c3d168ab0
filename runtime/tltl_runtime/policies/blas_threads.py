"""Set the number of threads of NumPy's matrix products: the last bits of a network's output depend on it."""

from __future__ import annotations

from contextlib import AbstractContextManager

from threadpoolctl import threadpool_limits


def blas_threads(count: int) -> AbstractContextManager[object]:
    """Let NumPy multiply matrices in ``count`` threads within this context."""
    limits: AbstractContextManager[object] = threadpool_limits(count, "blas")
    return limits
