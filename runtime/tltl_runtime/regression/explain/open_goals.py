"""The goals of a spec that may be reached in any order, and which of them are open in a state."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from tltl_runtime.regression.explain.phrase import quoted_names
from tltl_runtime.regression.explain.stages import MEETS, Subgoal, last_steps, literal_name, subgoal, target_of
from tltlc.api import Fspa, record


@record
class OpenGoals:
    """The goals of a spec that are ``reached`` in a state, and those that are ``open``, both as names.

    A name is that of the entity to approach, if there is one, else that of the atom to make true.
    """

    reached: tuple[str, ...]
    open: tuple[str, ...]


def open_goals(fspa: Fspa, state: int) -> OpenGoals | None:
    """Return the goals of a spec that are reached in a state, and those that are open.

    None if the spec has fewer than two goals in any order, if a goal is more than an atom or the opposite of a
    comparison, or if the label of the state asks for anything but some of these goals and clauses ``always``.
    """
    every, rest = _goals(fspa, 0), _goals(fspa, state)
    if every is None or rest is None or len(every) < 2 or not set(rest) <= set(every):
        return None
    return OpenGoals(tuple(name for name in every if name not in rest), tuple(name for name in every if name in rest))


def subgoal_of_all(fspa: Fspa, states: Collection[int], distance: int) -> Subgoal:
    """Return one subgoal for several states that all have the same ``distance`` from acceptance.

    If the states have different subgoals, the result counts the goals that are reached in the next state:
    ``reaches 2 of the 3 goals `a`, `b` and `c```. If they are not known, it counts the steps of the spec that
    are left then: ``comes to the last 2 steps of the spec``.
    """
    subgoals = {subgoal(fspa, state) for state in states}
    if len(subgoals) == 1:
        return subgoals.pop()
    if distance == 1:
        return MEETS
    names = open_goals(fspa, 0)
    nearer = [state.id for state in fspa.states if state.distance is not None and state.distance < distance]
    counts, counts_nearer = (_reached_counts(fspa, its) for its in (states, nearer))
    if names and len(counts) == 1 and None not in counts | counts_nearer:
        least = min(count for count in counts_nearer if count is not None)
        if least == (counts.pop() or 0) + 1:
            return Subgoal(other=f"reaches {least} of the {len(names.open)} goals {quoted_names(names.open)}")
    return last_steps(distance)


def _reached_counts(fspa: Fspa, states: Collection[int]) -> set[int | None]:
    """Return how many goals are reached in the states; with None if this is not known of one of them."""
    goals = [open_goals(fspa, state) for state in states]
    return {None if its is None else len(its.reached) for its in goals}


def _goals(fspa: Fspa, state: int) -> list[str] | None:
    """Return the goals ``F p`` in the label of a state, as names; None if the label has parts of other kinds."""
    names = list(_parts(fspa, state))
    return None if None in names else [name for name in dict.fromkeys(names) if name]


def _parts(fspa: Fspa, state: int) -> Iterator[str | None]:
    """Yield the name of each goal ``F p`` in the label of a state, and None for each part that is no such goal.

    Parts ``G p`` are left out.
    """
    label: Any = fspa.states[state].label
    if not hasattr(label, "args"):
        yield None
        return
    atoms = {atom.name: row for row, atom in enumerate(fspa.atoms)}
    for part in label.args if label.op == "and" else (label,):
        if part.op == "F" and part.args[0].op in ("atom", "not"):
            (goal,) = part.args
            atom, holds = (goal.args[0], False) if goal.op == "not" else (goal, True)
            name, must_hold = literal_name(fspa, atoms[atom.name], holds) if atom.name in atoms else ("", False)
            yield (target_of(fspa, atoms[atom.name]) if holds else None) or name if must_hold else None
        elif part.op not in ("G", "true"):
            yield None
