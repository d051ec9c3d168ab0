"""How near some steps in a state came to an edge that leads towards acceptance."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.guards import bounding_literal, robustness
from tltlc.monitor.tables import tables


@record
class NearestEdge:
    """The step that came nearest to an edge that leads from a state towards acceptance.

    ``row`` is the index of the step, the first one if several are equally near. ``robustness``, in
    [-1, 1], is the greatest robustness of the guards of these edges at this step. ``atom`` is the
    index of the atom that limits it, and ``wanted`` the truth value that the guard needs.
    """

    row: int
    robustness: float
    atom: int
    wanted: bool


def nearest_edge(fspa: Fspa, state: int, rows: Sequence[Sequence[float]]) -> NearestEdge | None:
    """Return which of some steps in a state came nearest to an edge that leads towards acceptance.

    ``rows`` has the values of all atoms at each of these steps. None if there is no step, or if no
    edge leads from the state towards acceptance.
    """
    guards = [edge.guard for edge in tables(fspa).improving[state]]
    if not guards or not rows:
        return None
    nearness = [max(robustness(guard, values) for guard in guards) for values in rows]
    greatest = max(nearness)
    row = nearness.index(greatest)
    atom, wanted = bounding_literal(guards, rows[row])
    return NearestEdge(row, greatest, atom, wanted)
