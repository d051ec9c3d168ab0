"""The report that a training makes after each iteration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.exploration.search_plan import SearchPlan
from tltl_runtime.training.imitation.demonstrations import ImitationSummary
from tltl_runtime.wire.lost_episodes import LostEpisodes
from tltlc.api import record, traces

StopReason = Literal["met", "steps", "minutes"]

Score = tuple[float, float, float]
"""The score of a policy: pass rate, mean progress, mean reward. Greater is better."""


@record
class Iteration:
    """The result of a rollout and the update after it.

    ``number`` counts from 1. ``steps`` counts the decisions of all environments. ``finished`` are
    the episodes that ended. ``losses`` are the losses of the algorithm by name, and the loss of
    self-imitation, if there was any, under ``imitation``. ``collect_s`` and ``learn_s`` are the
    wall-clock seconds of the rollout and of the update. ``lost`` are the episodes that were lost with
    their games, which are not in ``finished``; None without any.
    """

    number: int
    steps: int
    finished: tuple[EpisodeSummary, ...]
    losses: dict[str, float]
    collect_s: float
    learn_s: float
    lost: LostEpisodes | None = None


@record
class EpisodeWindow:
    """Statistics of the last ``count`` episodes, of which ``successes`` met the spec.

    ``progress`` in [0, 1], ``reward`` and ``steps`` are means over the episodes; they are 0 if
    there is no episode. In ``reward``, the terminal penalty of failed episodes is not discounted,
    whatever the settings of the training. ``states`` maps an automaton state to the share of
    episodes that ended in it, or were in it just before they violated the spec. ``violated`` maps a
    state to the share of episodes that were in it just before they violated the spec. Both are
    shares of all episodes, in (0, 1]; states that no episode ended in are left out. ``causes`` are groups
    of episodes that broke the same clauses of the spec. There are none if the clauses are not known of
    all episodes that violated the spec, as after a training was resumed.
    """

    count: int
    successes: int
    progress: float
    reward: float
    steps: float
    states: Mapping[int, float]
    violated: Mapping[int, float]
    causes: tuple[traces.CauseGroup, ...] = ()

    @property
    def pass_rate(self) -> float:
        """The share of successes, in [0, 1]; 0 if there is no episode."""
        return self.successes / self.count if self.count else 0.0


@record
class Confirmation:
    """The result of testing a policy in up to ``of`` new episodes, before a training ends.

    The first ``met`` of these episodes met the spec. If ``met`` is less than ``of``, the next
    episode failed and was the last one.
    """

    met: int
    of: int

    @property
    def passed(self) -> bool:
        """Whether the policy met the spec in all ``of`` episodes."""
        return self.met == self.of


@record
class TrainingReport:
    """An iteration, and the state of the training after it.

    - ``steps`` counts all decisions so far, of all environments and processes. Decisions of
      searches and ``replayed`` decisions do not count.
    - ``seconds`` is the training time so far, over all resumptions, from the starts of the commands.
    - ``setup_s`` are the seconds of it before the first iteration, since the training was started or
      resumed, without the search.
    - ``unbroken`` is the number of successive episodes, up to the last one, that met the spec. It
      starts at 0 again when the policy fails its test in new episodes.
    - ``confirmation`` is the result of testing the policy in new episodes after this iteration;
      None if no test was due.
    - ``best_pass_rate`` is the pass rate of the best policy, and ``best_steps`` the number of steps
      after which it had its weights; None if there is no best policy yet.
    - ``stop`` says why the training ends here; None if it goes on.
    - ``checkpointed`` says whether this process writes a checkpoint for this iteration.
    - ``searched`` is the progress of the searches for demonstrations, None if there was no search.
    - ``replayed`` counts the decisions that were replayed to reach the starts of episodes.
    - ``imitated`` describes the demonstrations that the agent imitates; None if it imitates none.
    - ``plan`` says how the game is searched for demonstrations, or why not; None if the settings ask
      for no search.
    - ``lost`` are the episodes that were lost with their games, since the training was started or
      resumed; None without any.
    """

    iteration: Iteration
    steps: int
    seconds: float
    window: EpisodeWindow
    unbroken: int
    confirmation: Confirmation | None
    best_pass_rate: float | None
    best_steps: int | None
    stop: StopReason | None
    checkpointed: bool
    searched: SearchProgress | None
    replayed: int
    imitated: ImitationSummary | None
    plan: SearchPlan | None = None
    lost: LostEpisodes | None = None
    setup_s: float = 0.0
