"""Compile specs as if their bounds needed few states, so that they become states and no timers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from unittest.mock import patch

from tltlc.resolve import specs


@contextmanager
def unfolded() -> Iterator[None]:
    """Unfold all bounds, however many states they need."""
    with patch.object(specs, "MOST_UNFOLDED", 10**100):
        yield
