"""The processes of a training: one, or several that torchrun started, each with environments of its own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import torch
from torch import distributed

from tltl_runtime.vector.cores import cores as usable_cores
from tltl_runtime.vector.cores import started
from tltlc.core.record import record

T = TypeVar("T")


@record
class Peers:
    """Process ``rank`` of ``count``, the ``local_rank``-th of this machine's ``local_count``.

    All processes ask for the same in the same order, else they wait for each other.
    """

    rank: int
    count: int
    local_rank: int
    local_count: int

    def gather(self, value: T) -> list[T]:
        """The values of all processes, by rank."""
        if self.count == 1:
            return [value]
        values: list[Any] = [None] * self.count
        distributed.all_gather_object(values, value)
        return values

    def broadcast(self, value: T) -> T:
        """The value of the first process."""
        if self.count == 1:
            return value
        values = [value]
        distributed.broadcast_object_list(values, src=0)
        return values[0]


def peers() -> Peers:
    """Where this process stands among those that torchrun started, by its environment variables; alone without it."""
    count, local_count = (started(name, 1) for name in ("WORLD_SIZE", "LOCAL_WORLD_SIZE"))
    rank, local_rank = (started(name, 0) for name in ("RANK", "LOCAL_RANK"))
    return Peers(rank, count, local_rank, local_count)


def cores() -> int:
    """How many cores there are for each process of this machine, at least one."""
    return max(1, usable_cores() // peers().local_count)


@contextmanager
def joined(device: str) -> Iterator[tuple[Peers, str]]:
    """Within, the processes can speak to each other; this one, and ``device``, its own."""
    found = peers()
    if found.count == 1:
        yield found, device
        return
    on_gpu = device.startswith("cuda")
    if on_gpu:
        torch.cuda.set_device(device)
    # Values travel by gloo on any device, and gradients by what is fastest for them.
    distributed.init_process_group("cpu:gloo,cuda:nccl" if on_gpu else "gloo")
    try:
        yield found, device
    finally:
        distributed.destroy_process_group()
