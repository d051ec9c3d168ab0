"""The line that commands print for an episode."""

from __future__ import annotations

from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.support.number_text import number, share


def episode_line(episode: Episode, then: str) -> str:
    """Describe an episode; ``then`` says what was done with it.  A failed episode has a second line with the cause."""
    steps, seconds = len(episode.actions), episode.snapshots[-1].time
    ended = f"seed {episode.seed}: {episode.end} after {steps} steps, {seconds:.2f} s"
    line = f"{ended}, progress {share(episode.progress[-1])}, return {number(episode.rewards.sum(), 3)}: {then}"
    return line if episode.success else f"{line}\n  {cause(episode).text}"
