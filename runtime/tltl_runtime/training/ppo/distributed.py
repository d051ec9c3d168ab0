"""The processes of a training: one, or several that torchrun starts.

Each process has its own environments.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import torch
from torch import distributed

from tltl_runtime.vector.cores import cores as usable_cores
from tltl_runtime.vector.cores import torchrun_variable
from tltlc.api import record

T = TypeVar("T")


@record
class ProcessGroup:
    """The place of this process among the processes of a training, and ways to exchange values.

    This is process ``rank`` of ``count``, and process ``local_rank`` of ``local_count`` on this
    machine; ranks count from 0. All processes must call the methods in the same order. Otherwise
    they wait for each other forever.
    """

    rank: int
    count: int
    local_rank: int
    local_count: int

    def gather(self, value: T) -> list[T]:
        """Send ``value`` to all processes; return the values of all processes, by rank."""
        if self.count == 1:
            return [value]
        values: list[Any] = [None] * self.count
        distributed.all_gather_object(values, value)
        return values

    def broadcast(self, value: T) -> T:
        """Send the ``value`` of the first process to all processes, and return it."""
        if self.count == 1:
            return value
        values = [value]
        distributed.broadcast_object_list(values, src=0)
        return values[0]


def process_group() -> ProcessGroup:
    """Return the rank of this process and the number of processes, from torchrun's variables.

    Without these environment variables, this process is the only one.
    """
    count, local_count = (torchrun_variable(name, 1) for name in ("WORLD_SIZE", "LOCAL_WORLD_SIZE"))
    rank, local_rank = (torchrun_variable(name, 0) for name in ("RANK", "LOCAL_RANK"))
    return ProcessGroup(rank, count, local_rank, local_count)


def cores() -> int:
    """Return how many cores of this machine each process of the training may use, at least one."""
    return max(1, usable_cores() // process_group().local_count)


@contextmanager
def join_process_group(device: str) -> Iterator[tuple[ProcessGroup, str]]:
    """Join torch's process group inside the ``with`` block; leave it at the end.

    Yield the :class:`ProcessGroup` and ``device``. A single process joins no group.
    """
    group = process_group()
    if group.count == 1:
        yield group, device
        return
    on_gpu = device.startswith("cuda")
    if on_gpu:
        torch.cuda.set_device(device)
    # gloo exchanges Python values on any device; NCCL is the fastest backend for gradients on GPUs.
    distributed.init_process_group("cpu:gloo,cuda:nccl" if on_gpu else "gloo")
    try:
        yield group, device
    finally:
        distributed.destroy_process_group()
