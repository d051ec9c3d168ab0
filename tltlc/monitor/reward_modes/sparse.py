"""Reward the robustness of the whole trace, once, at the end of the episode."""

from __future__ import annotations

from tltlc.monitor.guards import robustness
from tltlc.monitor.progress_and_reward import RewardOptions
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import MonitorTables

Widths = dict[int, float]
"""The width of the widest run to each state, after the samples so far.

A run is any path in the automaton with one edge for each sample, whether or not the guards of these
edges are true at the samples. Its width is the least robustness of its edges at their samples.
States that no run reaches are left out.
"""


def reward(
    tables: MonitorTables, transition: Transition, _: RewardOptions, memory: Widths | None
) -> tuple[float, Widths]:
    """Return the reward: 0 before the end of the episode, and the robustness of its trace at the end.

    The caller passes the second result as ``memory`` at the next step. The robustness, in [-1, 1],
    is at least 0 if the trace is accepted, and at most 0 if it is rejected. Its absolute value is
    the distance to the nearest trace with the opposite judgement. The distance of two traces is the
    greatest difference between the values of an atom at a sample.

    The distance is computed from runs. A run is any path in the automaton with one edge for each
    sample. Its width, the least robustness of its edges, tells how much the values must change for
    the trace to take this run. The widest of the runs that end in the opposite judgement gives the
    distance. If there is no such run, the robustness is 1 or -1.

    ▲ The paper uses the robustness of the formula. Both values agree if no atom's value is 0 and no
    equivalent formula has a robustness nearer to 0.
    """
    widths = _widen(tables, {0: 1.0} if memory is None else memory, transition)
    if not transition.done:
        return 0.0, widths
    accepted = tables.fspa.states[transition.target].accepting
    opposite_widths = [width for state, width in widths.items() if tables.fspa.states[state].accepting != accepted]
    distance = -min(0.0, max(opposite_widths, default=-1.0))
    return distance if accepted else -distance + 0.0, widths


def _widen(tables: MonitorTables, widths: Widths, transition: Transition) -> Widths:
    """Return the width of the widest run to each state after the sample of ``transition``.

    ``widths`` are the widths before this sample. A run is a path in the automaton with one edge for
    each sample, and its width is the least robustness of its edges.
    """
    widened: Widths = {}
    for state, width in widths.items():
        for edge in tables.edges[state]:
            width_through_edge = min(width, robustness(edge.guard, transition.values))
            if width_through_edge > widened.get(edge.target, -2.0):
                widened[edge.target] = width_through_edge
    return widened
