"""Find the step at which a run came nearest to leaving a state towards acceptance."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.guards import bounding_literal, robustness
from tltlc.monitor.tables import tables


@record
class NearestEdge:
    """The step, of some steps in one state, that came nearest to an edge towards acceptance.

    ``row`` is the index of the step; of several equally near steps, the last. ``robustness``, in
    [-1, 1], is the greatest robustness of a guard of these edges at this step. ``atom`` is the
    index of the atom that limits this robustness, and ``wanted`` the truth value of the atom that
    the guard needs. ``reached`` says whether the atom had this truth value at another of the steps.
    """

    row: int
    robustness: float
    atom: int
    wanted: bool
    reached: bool


def nearest_edge(fspa: Fspa, state: int, rows: Sequence[Sequence[float]]) -> NearestEdge | None:
    """Return the step, of some steps in one state, that came nearest to an edge towards acceptance.

    Such an edge leads to a state with a smaller distance to an accepting state. ``rows`` has the
    values of all atoms, in [-1, 1], at each step. Returns None if there is no step, or if no such
    edge leaves the state.
    """
    guards = [edge.guard for edge in tables(fspa).improving[state]]
    if not guards or not rows:
        return None
    nearness = [max(robustness(guard, values) for guard in guards) for values in rows]
    greatest = max(nearness)
    row = max(index for index, value in enumerate(nearness) if value == greatest)
    atom, wanted = bounding_literal(guards, rows[row])
    return NearestEdge(row, greatest, atom, wanted, any((values[atom] > 0.0) == wanted for values in rows))
