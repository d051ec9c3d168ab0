"""Reward the robustness of the whole trace, once, at the end of the episode."""

from __future__ import annotations

from tltlc.monitor.guards import robustness
from tltlc.monitor.progress_and_reward import RewardOptions
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import MonitorTables

Widths = dict[int, float]
"""For each state that a trace of this length can reach, the width of the widest run to it.

The width of a run is its least edge robustness.
"""


def reward(
    tables: MonitorTables, transition: Transition, _: RewardOptions, memory: Widths | None
) -> tuple[float, Widths]:
    """Return 0, and at the end of the episode the robustness of its trace, in [-1, 1].

    The robustness is the signed distance from the trace to the nearest trace with the opposite
    judgement; the distance of two traces is the greatest difference of an atom's value. The
    robustness is positive if and only if the trace is accepted. The least robust edge of a run
    gives the least change that makes the run possible. So the nearest trace with the opposite
    judgement belongs to the widest run to a state with the opposite acceptance. If there is no such
    state, the robustness is 1 or -1.

    ▲ The paper uses the robustness of the formula. Both values agree if no atom's value is 0 and no
    other way to write the formula gives a value nearer to 0.
    """
    widths = _widen(tables, {0: 1.0} if memory is None else memory, transition)
    if not transition.done:
        return 0.0, widths
    accepted = tables.fspa.states[transition.target].accepting
    opposite_widths = [width for state, width in widths.items() if tables.fspa.states[state].accepting != accepted]
    distance = -min(0.0, max(opposite_widths, default=-1.0))
    return distance if accepted else -distance + 0.0, widths


def _widen(tables: MonitorTables, widths: Widths, transition: Transition) -> Widths:
    """Return the widths after one more sample."""
    widened: Widths = {}
    for state, width in widths.items():
        for edge in tables.edges[state]:
            width_through_edge = min(width, robustness(edge.guard, transition.values))
            if width_through_edge > widened.get(edge.target, -2.0):
                widened[edge.target] = width_through_edge
    return widened
