"""Print the formula of an automaton, the labels of its states and the guards of its edges, in three notations."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

from tltlc.automaton.fspa import Fspa, Guard, Notation, Text
from tltlc.automaton.memory_phrases import spoken
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.logic.text.counts import NUMBERS, CountPrinter, TimePrinter, foreign_range_text, range_text
from tltlc.logic.text.phrases import with_opposites
from tltlc.logic.text.printer import ascii_text, english_text, unicode_text, words_text

_LONGEST_IN_ENGLISH: Final = 2_000
"""Formulas with more characters get no English sentence: it would be too long to read."""
_GOES_ON: Final = "The play must not end at this step."
_ENDS: Final = "The play must end at this step."


def formula_text(fspa: Fspa, notation: Notation = "english") -> str:
    """Return the formula of an automaton in a notation. In English, times are in seconds if there is a clock."""
    formula, endless = fspa.formula, fspa.semantics == "infinite"
    if notation != "english" or isinstance(formula, Text):
        return _text(formula, notation, endless=endless)
    return _write(spoken(formula, fspa), notation, times_of(fspa), endless=endless)


def times_of(fspa: Fspa) -> CountPrinter:
    """Return the printer of the times of bounds: in seconds if the automaton has a clock."""
    return NUMBERS if fspa.clock_s is None else TimePrinter(fspa.clock_s)


def label_text(fspa: Fspa, state: int, notation: Notation = "english") -> str:
    """Return the label of a state in a notation: what remains to be satisfied.

    ``state`` is the state's id. Over finite traces, two kinds of states get a special English
    sentence. A rejecting state with the label ``true``, as in ``X true``, says that the play must
    not end. An accepting state with the label ``false``, as in ``N false``, says that it must end.
    """
    label, accepting, endless = fspa.states[state].label, fspa.states[state].accepting, fspa.semantics == "infinite"
    if notation == "english" and not endless:
        if label is TRUE and not accepting:
            return _GOES_ON
        if label is FALSE and accepting:
            return _ENDS
    return _text(_in_words(label, fspa) if notation == "english" else label, notation, endless=endless)


def _in_words(label: Formula | Text, fspa: Fspa) -> Formula | Text:
    """Return a formula with phrases for what atoms remember; a formula of another tool is returned unchanged."""
    return label if isinstance(label, Text) else spoken(label, fspa)


def label_range_text(fspa: Fspa, first: int, last: int, notation: Notation = "english") -> str:
    """Return one text for the labels of two states, for people: ``F[0,39…2] p`` for ``F[0,39] p`` and ``F[0,2] p``.

    The negation of ``x < 7`` is written ``x >= 7``, unlike in the labels of artefacts.

    If the labels differ in more than counts of steps, return both with an ellipsis between them.
    ``first`` and ``last`` are the ids of the states.
    """
    texts = _shown_label(fspa, first, notation), _shown_label(fspa, last, notation)
    if texts[0] == texts[1]:
        return texts[0]
    first_label, last_label = (_shown(fspa, state, notation) for state in (first, last))
    if isinstance(first_label, Formula) and isinstance(last_label, Formula):
        endless = fspa.semantics == "infinite"
        text = range_text(
            first_label, last_label, lambda formula, counts: _write(formula, notation, counts, endless=endless)
        )
    else:
        text = foreign_range_text(*texts)
    return " … ".join(texts) if text is None else text


def _shown_label(fspa: Fspa, state: int, notation: Notation) -> str:
    if notation == "english":
        return label_text(fspa, state)
    return _text(_shown(fspa, state, notation), notation, endless=fspa.semantics == "infinite")


def _shown(fspa: Fspa, state: int, notation: Notation) -> Formula | Text:
    """Return the label of a state for people. English sentences write opposite comparisons by themselves."""
    label = fspa.states[state].label
    if notation == "english":
        return _in_words(label, fspa)
    return label if isinstance(label, Text) else with_opposites(label)


def guard_text(guard: Guard, notation: Notation = "ascii") -> str:
    """Return the short formula of a guard in a notation, for people: ``x >= 7`` for ``!(x < 7)``.

    The notation ``english`` writes the operators as words: ``a and not b``.
    """
    if isinstance(guard.formula, Text):
        return _text(guard.formula, notation, endless=False)
    formula = with_opposites(guard.formula)
    return words_text(formula) if notation == "english" else _text(formula, notation, endless=False)


def guard_texts(fspa: Fspa) -> tuple[str, ...]:
    """Return the guard of each edge in the ASCII notation, as artefacts have it, in the order of ``fspa.edges``."""
    texts = {formula: _text(formula, "ascii", endless=False) for formula in {edge.guard.formula for edge in fspa.edges}}
    return tuple(texts[edge.guard.formula] for edge in fspa.edges)


@lru_cache(maxsize=256)
def _text(formula: Formula | Text, notation: Notation, *, endless: bool) -> str:
    """Return a formula in a notation. The texts are cached, since a game may show a label in each frame."""
    if isinstance(formula, Text):
        return {"ascii": formula.ascii, "unicode": formula.unicode, "english": formula.english}[notation]
    return _write(formula, notation, NUMBERS, endless=endless)


def _write(formula: Formula, notation: Notation, counts: CountPrinter, *, endless: bool) -> str:
    if notation == "unicode":
        return unicode_text(formula, counts)
    if notation == "ascii":
        return ascii_text(formula, counts)
    if len(ascii_text(formula)) > _LONGEST_IN_ENGLISH:
        return f"Satisfy {ascii_text(formula, counts)}."
    if endless and not {TRUE, FALSE}.isdisjoint(formula.walk()):
        from tltlc.automaton.infinite.readback import without_constants

        formula = without_constants(formula)
    return english_text(formula, endless=endless, counts=counts)
