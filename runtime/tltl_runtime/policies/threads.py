"""How many threads torch uses: with more than one the last bits of a network's output are another matter."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager

import torch


def one_thread() -> AbstractContextManager[None]:
    """Within, torch computes in one thread, so that equal observations give equal logits on any number of cores."""
    return threads(1)


@contextmanager
def threads(count: int) -> Iterator[None]:
    """Within, torch computes in ``count`` threads."""
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)
