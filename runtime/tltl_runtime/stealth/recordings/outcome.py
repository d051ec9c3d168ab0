"""What reports count of an episode."""

from __future__ import annotations

from tltl_runtime.stealth.recordings.episode import End, Episode
from tltlc.core.record import record


@record
class Outcome:
    """How an episode went, in numbers and names that can be counted over many."""

    success: bool
    end: End
    verdict: str
    """Of the last step: ``holding``, ``pending``, ``satisfied`` or ``violated``."""
    steps: int
    """Decisions that were made."""
    seconds: float
    """Of the game, from the reset on."""
    progress: float
    """The best, in [0, 1]."""
    reward: float
    """The sum over the steps."""
    health: float
    """At the end, in [0, 1]."""
    seen_steps: int
    """Moments, that of the reset included, at which the player was in the sight of an enemy."""
    chased: bool
    """Whether an enemy gave chase."""
    opened: tuple[str, ...]
    """The barriers that were open at the end, in the level's order."""


def outcome(episode: Episode) -> Outcome:
    """How the episode went."""
    last = episode.snapshots[-1]
    return Outcome(
        success=episode.success,
        end=episode.end,
        verdict=episode.verdict,
        steps=len(episode.actions),
        seconds=last.time,
        progress=float(episode.progress[-1]),
        reward=float(episode.rewards.sum()),
        health=last.health,
        seen_steps=sum(any(shot.sees) for shot in episode.snapshots),
        chased=any("chase" in shot.modes for shot in episode.snapshots),
        opened=tuple(
            barrier.name for barrier, is_open in zip(episode.level.barriers, last.open, strict=True) if is_open
        ),
    )
