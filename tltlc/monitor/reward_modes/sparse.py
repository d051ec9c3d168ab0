"""The robustness of the whole trace, once, at the end of the episode."""

from __future__ import annotations

from tltlc.monitor.guards import robustness
from tltlc.monitor.reward import RewardOptions
from tltlc.monitor.reward_modes import Transition
from tltlc.monitor.tables import Tables

Widths = dict[int, float]
"""The greatest least edge robustness of a run to each state that a trace of this length can reach."""


def reward(tables: Tables, transition: Transition, _: RewardOptions, memory: Widths | None) -> tuple[float, Widths]:
    """0, and at the end of the episode the robustness of its trace, in [-1, 1].

    The robustness is the signed distance, in the greatest difference of an atom's value, from the trace
    to the nearest one that is judged otherwise: positive iff the trace is accepted.  The least change that
    makes a run possible is that of its least robust edge, so the nearest trace is that of the
    widest run to a state with the other acceptance.  Where there is none, it is 1 or -1.

    ▲ The paper speaks of the robustness of the formula.  The two agree where no atom's value is 0 and no
    other way to write the formula gives a value nearer to 0.
    """
    widths = _widened(tables, {0: 1.0} if memory is None else memory, transition)
    if not transition.done:
        return 0.0, widths
    accepted = tables.fspa.states[transition.target].accepting
    others = [width for state, width in widths.items() if tables.fspa.states[state].accepting != accepted]
    distance = -min(0.0, max(others, default=-1.0))
    return distance if accepted else -distance + 0.0, widths


def _widened(tables: Tables, widths: Widths, transition: Transition) -> Widths:
    """The widths after one more sample."""
    result: Widths = {}
    for state, width in widths.items():
        for edge in tables.edges[state]:
            through = min(width, robustness(edge.guard, transition.values))
            if through > result.get(edge.target, -2.0):
                result[edge.target] = through
    return result
