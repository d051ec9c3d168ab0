"""A policy that ends its process during an episode.

It has a module of its own, which worker processes can import.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable

from tltl_runtime.policies.policy import Policy


class Deadly:
    """A stand-in for a policy: it calls ``end`` when it should choose an action."""

    def __init__(self, policy: Policy, end: Callable[[], object]) -> None:
        self.card, self._end = policy.card, end

    def choose(self, *_: object) -> object:
        """Call ``end`` instead of choosing an action."""
        return self._end()


def kill_this_process() -> None:
    """Kill this process with SIGKILL."""
    os.kill(os.getpid(), signal.SIGKILL)
