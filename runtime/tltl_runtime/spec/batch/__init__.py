"""Run many copies of one automaton at once, as torch tensors.

Begin with :class:`BatchMonitor`. Tests check that its results equal those of :mod:`tltlc.monitor`.
"""

from __future__ import annotations

from tltl_runtime.spec.batch.monitor import BatchMonitor, BatchStep

__all__ = ["BatchMonitor", "BatchStep"]
