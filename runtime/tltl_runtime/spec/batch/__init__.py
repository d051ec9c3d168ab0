"""Run many copies of one automaton at once, as torch tensors; tests check equality with :mod:`tltlc.monitor`."""

from __future__ import annotations

from tltl_runtime.spec.batch.monitor import BatchMonitor, BatchStep

__all__ = ["BatchMonitor", "BatchStep"]
