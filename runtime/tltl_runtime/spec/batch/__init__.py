"""Run many copies of one automaton at once, as torch tensors.

Begin with :class:`BatchMonitor`. Tests check that the batch monitor gives the same results as
:mod:`tltlc.monitor`, which runs one automaton.
"""

from __future__ import annotations

from tltl_runtime.spec.batch.monitor import BatchMonitor, BatchStep

__all__ = ["BatchMonitor", "BatchStep"]
