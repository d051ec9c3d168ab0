"""What episodes come to: the figures that are reported of them, and where those ended that failed."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.evaluation.outcome import TimedOutcome
from tltl_runtime.evaluation.play import Played
from tltl_runtime.evaluation.statistics import Spread, spread_of, wilson
from tltl_runtime.stealth.recordings.episode import End
from tltlc.core.record import record


@record
class Ended:
    """Failed episodes that ended alike: what remained in ``state`` (``label``), and how they ended.

    Of violated ones it is the state from which they were.  ``share`` is that of all episodes that were played;
    ``episodes`` are their indices.
    """

    state: int
    label: str
    end: End
    count: int
    share: float
    episodes: tuple[int, ...]


@record
class Figures:
    """The figures over so many ``episodes``: ``pass_rate`` with its Wilson interval of 95 %, the spread of the others.

    ``progress`` is the best of an episode, in [0, 1], ``reward`` its undiscounted sum, ``steps`` are decisions.
    """

    episodes: int
    pass_rate: float
    pass_interval: tuple[float, float]
    progress: Spread
    reward: Spread
    steps: Spread


@record
class Evaluation:
    """What an evaluation comes to: figures, how failed episodes ended, and the episodes themselves."""

    figures: Figures
    ended: tuple[Ended, ...]
    episodes: tuple[Played, ...]


def figures_of(episodes: Sequence[TimedOutcome]) -> Figures:
    """The figures over episodes; raises ValueError where there are none."""
    passed = sum(each.success for each in episodes)
    # First, since it says in words what is wrong with none.
    interval = wilson(passed, len(episodes))
    return Figures(
        episodes=len(episodes),
        pass_rate=passed / len(episodes),
        pass_interval=interval,
        progress=spread_of([each.progress for each in episodes]),
        reward=spread_of([each.reward for each in episodes]),
        steps=spread_of([float(each.steps) for each in episodes]),
    )


def evaluation_of(episodes: Sequence[Played]) -> Evaluation:
    """What these episodes come to; raises ValueError where there are none."""
    return Evaluation(figures_of(episodes), _ended(episodes), tuple(episodes))


def _ended(episodes: Sequence[Played]) -> tuple[Ended, ...]:
    """Those that failed, by state and end, the most frequent first."""
    groups: dict[tuple[int, str, End], list[int]] = {}
    for each in episodes:
        if not each.success:
            groups.setdefault((each.unmet, each.label, each.end), []).append(each.index)
    found = [
        Ended(state, label, end, len(indices), len(indices) / len(episodes), tuple(indices))
        for (state, label, end), indices in groups.items()
    ]
    return tuple(sorted(found, key=lambda each: (-each.count, each.state, each.end)))
