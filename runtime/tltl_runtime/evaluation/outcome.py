"""Protocols for the results of episodes."""

from __future__ import annotations

from typing import Protocol


class Outcome(Protocol):
    """How an episode went."""

    @property
    def success(self) -> bool:
        """Whether the spec was met."""

    @property
    def progress(self) -> float:
        """The best progress, in [0, 1]."""

    @property
    def reward(self) -> float:
        """The sum of the rewards of all steps."""


class TimedOutcome(Outcome, Protocol):
    """How an episode went, and how long it took."""

    @property
    def steps(self) -> int:
        """The number of decisions."""
