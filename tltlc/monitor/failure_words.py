"""Say in words why a trace fails: at which step, by which atoms, against which clause."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import Speaker, spoken
from tltlc.automaton.text import label_text
from tltlc.core.names import ComparisonName
from tltlc.logic import formula as f
from tltlc.logic.text.phrases import with_opposites
from tltlc.logic.text.printer import words_text
from tltlc.monitor.failure import Cause, Failure
from tltlc.resolve.spec import Atom

_SIGN: Final = re.compile("[!&|]|->")
"""A sign of an operator in the name of an atom."""
_LONGEST: Final = 300
"""A line shows at most this many characters of what remains to be satisfied."""


def failure_words(fspa: Fspa, failed: Failure, steps: int | None = None, time: str = "") -> str:
    """Return a phrase such as "violated at step 3 of 5: `at(boss)` without `has(sword)`, clause 2".

    ``steps`` is the number of steps of the trace; if it is None, the phrase says nothing of it. ``time`` stands
    behind the number of the step: `` (1.03 s)``. Clauses are counted from 1.
    """
    place = f"violated at step {failed.step}{time}" + (f" of {steps}" if steps is not None else "")
    if failed.cause is None:
        return f"{place}: no trace can meet the spec"
    words = cause_words(fspa, failed.cause)
    if failed.cause.clause is not None:
        return f"{place}: {words}, clause {failed.cause.clause + 1}"
    return f"{place}: {words}" + (", against several clauses together" if len(fspa.clauses) > 1 else "")


def cause_words(fspa: Fspa, cause: Cause) -> str:
    """Return what is true at the step that breaks a clause: "`at(boss)` without `has(sword)`"."""
    literals = {_literal(fspa, atom, holds=polarity): (atom, polarity) for atom, polarity in cause.prime}
    turns, rest = Speaker(fspa).turns(tuple(literals))
    true = [
        *(turn.text for turn in turns),
        *(atom_words(fspa, atom) for atom, polarity in map(literals.__getitem__, rest) if polarity),
    ]
    false: list[str] = []
    for atom, polarity in map(literals.__getitem__, rest):
        if not polarity:
            if fspa.atoms[atom].opposite is None:
                false.append(atom_words(fspa, atom))
            else:
                true.append(atom_words(fspa, atom, holds=False))
    if not false:
        return _listed(true, "and") if true else "this step comes too late"
    if not true:
        return f"{_listed(false, 'and')} {'does' if len(false) == 1 else 'do'} not hold"
    return f"{_listed(true, 'and')} without {_listed(false, 'or')}"


def atom_words(fspa: Fspa, atom: int, *, holds: bool = True) -> str:
    """Return an atom in words: its name, or for one that remembers the trace, "answers later than 5 s after alarm".

    Unless it ``holds``, return its negation.
    """
    return words_text(with_opposites(spoken(_literal(fspa, atom, holds=holds), fspa)))


def _literal(fspa: Fspa, atom: int, *, holds: bool) -> f.Formula:
    literal = f.atom(fspa.atoms[atom].name)
    return literal if holds else f.not_(literal)


def atom_titles(fspa: Fspa) -> tuple[str, ...]:
    """Return a short title of each atom: its name, with words where a condition in the name has signs such as `!`."""
    speaker = Speaker(fspa)
    return tuple(_title(item, speaker) for item in fspa.atoms)


def _title(item: Atom, speaker: Speaker) -> str:
    if _SIGN.search(item.name) is None:
        return item.name
    if isinstance(item.base, ComparisonName):
        return speaker.quantity_text(item.name)
    return words_text(with_opposites(speaker.spoken(f.atom(item.name))))


def unmet_words(fspa: Fspa, failed: Failure) -> str:
    """Return what remained to be satisfied before the step that failed, in words."""
    return label_text(fspa, failed.state)


def shortened(words: str) -> str:
    """Return a text of at most 300 characters unchanged, and of a longer one the words that fit, and "…"."""
    if len(words) <= _LONGEST:
        return words
    start = words[: _LONGEST - 2]
    return f"{start.rpartition(' ')[0] or start} …"


def _listed(names: Sequence[str], conjunction: str) -> str:
    quoted = [f"`{name}`" for name in names]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} {conjunction} {quoted[-1]}"
