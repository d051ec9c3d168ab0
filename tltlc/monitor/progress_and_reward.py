"""Progress, reward and the end of an episode: Algorithm 1 of Gutiérrez-Sánchez et al. 2024.

The paper is in IEEE Trans. Games 2024. "The listing" is the algorithm as the paper prints it, and
"line 11" is a line of the listing. A ▲ marks where the code deviates from the listing.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Final, Literal, get_args

from tltlc.core.record import record
from tltlc.monitor.guards import robustness
from tltlc.monitor.tables import MonitorTables

_FOLDER: Final = os.path.join(os.path.dirname(__file__), "reward_modes")  # noqa: PTH118, PTH120
MODES: Final = ("progress", *sorted(module.name for module in iter_modules([_FOLDER])))
"""All reward modes.

``progress`` is Algorithm 1. The others are the modules of :mod:`tltlc.monitor.reward_modes`.
"""
if TYPE_CHECKING:
    Mode = str
else:
    Mode = Literal[MODES]
Termination = Literal["entry", "paper"]
TerminalPenalty = Literal["undiscounted", "discounted"]


@record
class RewardOptions:
    """How steps are rewarded and when episodes end (``docs/semantics.md``, "Reward").

    - ``mode`` is the name of the reward, one of :data:`MODES`.
    - ``termination`` says when an episode ends. With ``entry``, it ends as soon as it enters a trap
      or an accepting state. But if the spec says ``judge at limit``, or has this by default, the
      episode goes on until the verdict is final or the limit is reached. With ``paper``, the
      episode ends one step later, as in the printed algorithm, and every spec is judged as with
      ``judge at goal``.
    - ``terminal_penalty`` says what a violation costs: the sum of the penalties of all remaining
      steps (``undiscounted``), or this sum discounted by ``gamma`` (``discounted``).
    - ``gamma`` in (0, 1] is the discount of mode ``potential`` and of the ``discounted`` terminal
      penalty.

    Raises:
        ValueError: an option has a value that is not named here.
    """

    mode: Mode = "progress"
    termination: Termination = "entry"
    terminal_penalty: TerminalPenalty = "undiscounted"
    gamma: float = 1.0

    def __post_init__(self) -> None:
        for name, choice in (("mode", Mode), ("termination", Termination), ("terminal_penalty", TerminalPenalty)):
            value, choices = getattr(self, name), get_args(choice)
            if value not in choices:
                raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r:.40}")
        if not isinstance(self.gamma, (float, int)) or not 0.0 < self.gamma <= 1.0:
            raise ValueError(f"gamma must be a number above 0 and at most 1, not {self.gamma!r:.40}")


@record
class RewardStep:
    """The outcome of one step.

    ``reward`` is the reward of this step, and ``progress`` the best progress so far, in [0, 1].
    ``done`` says whether the episode ends with this step. ``success`` is true if the episode ends
    in success, and false if the episode fails or goes on.
    """

    reward: float
    progress: float
    done: bool
    success: bool


def reward_step(
    tables: MonitorTables,
    state: int,
    target: int,
    values: Sequence[float],
    best: float,
    step: int,
    options: RewardOptions | None = None,
    last: bool = False,
) -> RewardStep:
    """Return the outcome of one step from ``state`` to ``target``: one pass through lines 11 to 29 of Algorithm 1.

    ``values`` are the atoms' values at the sample of this step (line 8). ``best`` is the best
    progress before this sample (``episode progress``). ``step`` is the number of this sample in the
    episode, from 1. If ``last``, the episode ends here whatever the spec says, for example because
    the game is over early. With ``T`` the spec's limit in steps, the reward is computed in this order::

        reward = max(0, progress - best)          lines 25 to 28
        reward = reward - 1 / T                   line 29, if there is a limit
        reward = reward - terminal penalty        line 20, on a violation, if there is a limit;
                                                  also if ``last`` makes an unfinished episode a
                                                  failure

    Deviations from the listing:

    ▲ line 10: the caller took the edge whose guard is true, and not the edge with the highest
    robustness.
    ▲ lines 12 to 23: the episode ends on entry into an accepting or trap state, not one step later;
    ``termination="paper"`` runs the lines as printed.
    ▲ line 11: if ``spec_size`` is 0, which the line divides by, the progress in a goal state is 1.
    ▲ line 11: a trap has the progress 0, so nothing is gained by entering it.
    ▲ line 14: the robustness that is added is at most 0.
    ▲ a spec that is judged at its limit ends the episode at T, or earlier if its verdict becomes
    final. Its progress is the share of T that the episode has survived.
    """
    options = options or RewardOptions()
    limit = tables.fspa.limit_steps
    done = ends_episode(tables, state, target, options) or (limit is not None and step >= limit)
    success = done and tables.fspa.states[target].accepting
    progress = max(best, step_progress(tables, state, target, values, step, options))
    if last and not done:
        done, success = True, _succeeds_early(tables, target, options)
        progress = 1.0 if success else progress
    reward = progress - best
    if limit is not None:
        reward -= 1 / limit
        if done and (tables.fspa.states[target].verdict == "violated" or (last and not success)):
            reward -= terminal_penalty(limit, step, options)
    return RewardStep(reward, progress, done, success)


def step_progress(
    tables: MonitorTables, state: int, target: int, values: Sequence[float], step: int, options: RewardOptions
) -> float:
    """Return the progress of this step alone (``step progress``, lines 11 to 18), in [0, 1].

    The step leads from ``state`` to ``target``. ``values`` are the values of the atoms at its
    sample, and ``step`` is the number of this sample in the episode, from 1.
    """
    if tables.fspa.judge == "limit" and options.termination == "entry":
        return _share_survived(tables, target, step)
    progress = tables.base_progress[target]
    if state == target and tables.improving[target]:
        progress += approach(tables, target, values)
    return progress


def approach(tables: MonitorTables, state: int, values: Sequence[float]) -> float:
    """Return how near the automaton is to taking an edge from ``state`` towards a goal, in [0, 1 / spec_size].

    Line 14 of Algorithm 1 adds this number to the progress. At least one such edge must exist.
    """
    nearest = max(robustness(edge.guard, values) for edge in tables.improving[state])
    return (1.0 + min(0.0, nearest)) / tables.fspa.spec_size


def _share_survived(tables: MonitorTables, target: int, step: int) -> float:
    """Return the share of the spec's limit in steps that the episode has survived, in [0, 1].

    The share is 1 if the spec is satisfied, and 0 if it is violated, or if it has no limit and is
    still undecided.
    """
    verdict, limit = tables.fspa.states[target].verdict, tables.fspa.limit_steps
    if verdict == "satisfied":
        return 1.0
    if verdict == "violated" or limit is None:
        return 0.0
    return min(step, limit) / limit


def ends_episode(tables: MonitorTables, state: int, target: int, options: RewardOptions) -> bool:
    """Whether the step from ``state`` to ``target`` ends the episode, whatever the limit of steps is."""
    if options.termination == "paper":
        # Lines 12 to 21: the episode ends if the state did not change and no edge leads nearer to a goal.
        return state == target and not tables.improving[target]
    return tables.ends_on_entry[target]


def _succeeds_early(tables: MonitorTables, target: int, options: RewardOptions) -> bool:
    """Whether an episode that is cut off in the state ``target`` is a success.

    It is a success if the state is accepting. But if the spec has a limit and is judged at this
    limit, an episode that is cut off earlier is a failure. With ``termination="paper"``, every spec
    is judged at its goal.
    """
    at_goal = tables.fspa.judge == "goal" or options.termination == "paper"
    return tables.fspa.states[target].accepting and (at_goal or tables.fspa.limit_steps is None)


def terminal_penalty(limit: int, step: int, options: RewardOptions) -> float:
    """Return the penalty for an episode that fails after ``step`` of ``limit`` steps.

    Each step that is left costs ``1 / limit``, so the penalty is ``(limit - step) / limit``. If
    ``options.terminal_penalty`` is ``discounted``, the cost of the n-th step that is left (n from
    0) is multiplied by ``gamma ** n``.
    """
    left, gamma = limit - step, options.gamma
    if options.terminal_penalty == "undiscounted" or gamma == 1.0:
        return left / limit
    return float((1 - gamma**left) / ((1 - gamma) * limit))
