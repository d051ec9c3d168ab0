"""The results of an episode that reports count."""

from __future__ import annotations

from tltl_runtime.spec.episode_summary import End
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.core.record import record


@record
class Outcome:
    """The result of an episode, in numbers and names that can be aggregated over many episodes."""

    success: bool
    end: End
    verdict: str
    """The verdict of the last step: ``holding``, ``pending``, ``satisfied`` or ``violated``."""
    steps: int
    """The number of decisions."""
    seconds: float
    """Game time since the reset."""
    progress: float
    """The best progress, in [0, 1]."""
    reward: float
    """The sum of the rewards."""
    health: float
    """The health at the end, in [0, 1]."""
    seen_steps: int
    """The number of moments, including the reset, at which an enemy saw the player."""
    chased: bool
    """Whether an enemy chased the player."""
    opened: tuple[str, ...]
    """The barriers that were open at the end, in the order of the level."""


def outcome(episode: Episode) -> Outcome:
    """Return the outcome of an episode."""
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
