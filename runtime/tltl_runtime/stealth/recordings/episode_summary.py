"""The summary of a recorded episode, and figures that only the stealth game has."""

from __future__ import annotations

from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.api import label_text


def summary_of(episode: Episode, index: int = 0) -> EpisodeSummary:
    """Return the summary of an episode; ``index`` is its number in an evaluation."""
    states = episode.states.tolist()
    unmet = states[-2] if episode.verdict == "violated" and len(states) > 1 else states[-1]
    return EpisodeSummary(
        index=index,
        seed=episode.seed,
        success=episode.success,
        end=episode.end,
        progress=float(episode.progress[-1]),
        reward=float(episode.rewards.sum()),
        steps=len(episode.actions),
        unmet=unmet,
        verdict=episode.verdict,
        seconds=episode.snapshots[-1].time,
        state=states[-1],
        label=label_text(episode.fspa, unmet),
    )


def seen_steps(episode: Episode) -> int:
    """Return the number of moments, including the reset, at which an enemy saw the player."""
    return sum(any(shot.sees) for shot in episode.snapshots)


def was_chased(episode: Episode) -> bool:
    """Return whether an enemy chased the player."""
    return any("chase" in shot.modes for shot in episode.snapshots)


def opened_barriers(episode: Episode) -> tuple[str, ...]:
    """Return the names of the barriers that were open at an episode's end, in the level's order."""
    barriers = zip(episode.level.barriers, episode.snapshots[-1].open, strict=True)
    return tuple(barrier.name for barrier, is_open in barriers if is_open)
