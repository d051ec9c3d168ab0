"""The line that commands print for an episode."""

from __future__ import annotations

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.moments import duration_text, has_clock
from tltl_runtime.support.number_text import number, share


def episode_line(episode: RecordedEpisode, result: str) -> str:
    """Describe an episode in a line that ends with ``result``.

    ``result`` says where the recording is, or that there is none. If the episode failed, a second line
    gives the cause.
    """
    seconds = f", {duration_text(episode.times)}" if has_clock(episode.times) else ""
    end = f"seed {episode.seed}: {episode.end} after {len(episode.actions)} steps{seconds}"
    line = f"{end}, progress {share(episode.progress[-1])}, return {number(episode.rewards.sum(), 3)}: {result}"
    return line if episode.success else f"{line}\n  {episode.level.game.cause(episode).text}"
