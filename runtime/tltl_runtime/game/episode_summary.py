"""The summary of a recorded episode, whatever the game."""

from __future__ import annotations

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.api import label_text


def summary_of(episode: RecordedEpisode, index: int = 0) -> EpisodeSummary:
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
        seconds=float(episode.times[-1]),
        state=states[-1],
        label=label_text(episode.fspa, unmet),
    )
