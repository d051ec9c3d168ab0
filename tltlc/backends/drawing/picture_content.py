"""Choose the states and edges that a picture of an automaton shows, and write its texts and its legend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.automaton.fspa import Fspa, Notation
from tltlc.backends.drawing.counting_states import fold_parallel_runs
from tltlc.backends.drawing.folding import Drawing, fold_runs
from tltlc.backends.drawing.texts import guards_by_arrow
from tltlc.backends.drawing.timed_guards import OTHERWISE, timed_drawing
from tltlc.backends.drawing.timers import CLOCK, MemoryRow, Timer, memory_rows
from tltlc.core.record import EMPTY, record

MOST_ROWS = 10
"""The most registers in a legend; a further row counts the rest."""


@record
class PictureContent:
    """What a picture shows.

    ``guards`` has the guards of each arrow, by ``(source, target)``. ``timers`` has the timers that
    run in a state, by its number and by the names of their atoms. ``notes`` are the sentences of the
    legend, and ``memory`` its rows of registers.
    """

    drawing: Drawing
    guards: Mapping[tuple[int, int], Sequence[str]]
    timers: Mapping[int, Mapping[str, Timer]]
    notes: tuple[str, ...]
    memory: tuple[MemoryRow, ...]


def picture_content(fspa: Fspa, drawing: Drawing, notation: Notation) -> PictureContent:
    """Return the content of a picture of a drawing.

    The guards of an automaton with registers are in words, whatever the notation: its atoms have
    names that only the compiler knows.
    """
    if not fspa.registers:
        return PictureContent(drawing, guards_by_arrow(drawing.edges, notation), EMPTY, notes(fspa, drawing), ())
    timed = timed_drawing(fspa, drawing)
    guards = guards_by_arrow(timed.drawing.edges, "english")
    return PictureContent(
        timed.drawing,
        guards,
        timed.timers,
        tuple(filter(None, (_timed_note(timed.timers, guards, timed.final_first), *notes(fspa, drawing)))),
        memory_rows(fspa),
    )


def _timed_note(
    timers: Mapping[int, Mapping[str, Timer]], guards: Mapping[tuple[int, int], Sequence[str]], final_first: bool
) -> str:
    """Return the sentences that explain the marks and guards of an automaton with registers."""
    sentences = [f"{CLOCK}: a timer that may run in this state."] if any(timers.values()) else []
    if final_first:
        sentences.append("Arrows to final states come first.")
    if any(OTHERWISE in texts for texts in guards.values()):
        sentences.append("“otherwise”: no other arrow of the state applies.")
    return " ".join(sentences)


def memory_texts(memory: Sequence[MemoryRow]) -> list[str]:
    """Return the rows of registers as sentences, for a legend without a table."""
    texts = [
        f"{row.name}: {row.kind}, {f'at most {row.maximum}, ' if row.maximum else ''}{row.initial} at the start"
        for row in memory[:MOST_ROWS]
    ]
    return ["Memory:", *texts, *more_rows(memory)] if texts else []


def more_rows(memory: Sequence[MemoryRow]) -> list[str]:
    """Return the text that counts the registers that a legend leaves out; an empty list if it leaves out none."""
    return [f"and {len(memory) - MOST_ROWS} more"] if len(memory) > MOST_ROWS else []


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
