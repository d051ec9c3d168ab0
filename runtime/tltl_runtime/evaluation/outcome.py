"""What is looked at in an episode that was played, whoever tells of it."""

from __future__ import annotations

from typing import Protocol


class Outcome(Protocol):
    """How an episode went."""

    @property
    def success(self) -> bool:
        """Whether the spec was met."""

    @property
    def progress(self) -> float:
        """The best, in [0, 1]."""

    @property
    def reward(self) -> float:
        """The sum over the steps."""


class TimedOutcome(Outcome, Protocol):
    """How an episode went, and how long it took."""

    @property
    def steps(self) -> int:
        """How many decisions it took."""
