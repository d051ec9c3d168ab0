"""What pictures show of an automaton, and what they say of it: every picture takes both from here."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.backends.drawing.counting_states import folded_in_step
from tltlc.backends.drawing.folding import Drawing, folded


def shown(fspa: Fspa) -> Drawing:
    """The drawing with runs of states that count folded, each by itself or in step, whichever leaves fewer states."""
    return min(folded(fspa), folded_in_step(fspa), key=lambda each: len(each.states))


def on_distances(drawing: Drawing, place: str, outline: str) -> str:
    """A sentence on the number at a state, which stands at a ``place``; goals have an ``outline``."""
    goal = f" ({outline})" if any(state.accepting for state in drawing.states) else ""
    none = ", ∞ if none can be reached" if any(state.distance is None for state in drawing.states) else ""
    return f"{place}: distance to a goal{goal}{none}."


def notes(fspa: Fspa, drawing: Drawing) -> tuple[str, ...]:
    """In sentences, which states are folded, and what the marks of pairs mean."""
    return tuple(filter(None, (_on_folding(fspa, drawing), _on_pairs(fspa))))


def _on_folding(fspa: Fspa, drawing: Drawing) -> str:
    inside = sum(map(len, drawing.folded.values()))
    return f"Dashed: {inside} of the {len(fspa.states)} states, folded." if inside else ""


def _on_pairs(fspa: Fspa) -> str:
    """When a trace is accepted, in the marks that guards have; nothing over finite traces, nor where none is."""
    if not any(pair.inf for pair in fspa.acceptance):
        return ""
    some, which = (", for some n,", "n") if len(fspa.acceptance) > 1 else ("", "0")
    seldom = f", and [fin {which}] only finitely often" if any(pair.fin for pair in fspa.acceptance) else ""
    return f"A trace is accepted if{some} its steps are marked [inf {which}] again and again for ever{seldom}."
