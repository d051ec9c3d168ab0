"""Choose the states and edges that a picture of an automaton shows, and write the sentences of its legend."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.backends.drawing.counting_states import fold_parallel_runs
from tltlc.backends.drawing.folding import Drawing, fold_runs


def folded_drawing(fspa: Fspa) -> Drawing:
    """Return a drawing in which long runs of states that differ only in a count are drawn as one state.

    Fold single runs (:func:`fold_runs`) or runs that count at the same time
    (:func:`fold_parallel_runs`), whichever leaves fewer states.
    """
    return min(fold_runs(fspa), fold_parallel_runs(fspa), key=lambda drawing: len(drawing.states))


def distance_note(drawing: Drawing, place: str, outline: str) -> str:
    """Return the sentence of the legend that explains the number in each state: ``Corner: distance to a goal.``

    ``place`` says where the number is (``Corner``), and ``outline`` how the outlines of goal states
    look (``double outline``).
    """
    goal = f" ({outline})" if any(state.accepting for state in drawing.states) else ""
    none = ", ∞ if none can be reached" if any(state.distance is None for state in drawing.states) else ""
    return f"{place}: distance to a goal{goal}{none}."


def notes(fspa: Fspa, drawing: Drawing) -> tuple[str, ...]:
    """Return the sentences of the legend that explain folded states and the marks of Rabin pairs.

    A sentence is left out if the drawing has nothing of the kind.
    """
    return tuple(filter(None, (_folding_note(fspa, drawing), _pairs_note(fspa))))


def _folding_note(fspa: Fspa, drawing: Drawing) -> str:
    folded_states = sum(map(len, drawing.folded.values()))
    return f"Dashed: {folded_states} of the {len(fspa.states)} states, folded." if folded_states else ""


def _pairs_note(fspa: Fspa) -> str:
    """Return the sentence that explains which marks of Rabin pairs an accepted trace must have on its steps.

    The sentence is empty over finite traces, and if no trace is accepted.
    """
    if not any(pair.inf for pair in fspa.acceptance):
        return ""
    some, which = (", for some n,", "n") if len(fspa.acceptance) > 1 else ("", "0")
    seldom = f", and [fin {which}] only finitely often" if any(pair.fin for pair in fspa.acceptance) else ""
    return f"A trace is accepted if{some} its steps are marked [inf {which}] again and again for ever{seldom}."
