"""Read `unless the recording ends` behind an answer: what the end of play cuts off is not asked for."""

from __future__ import annotations

from itertools import product
from typing import Final

from tltlc.grammar.english.ends import is_about_past, state_of
from tltlc.grammar.mistakes.sentences.states import ATOM, joined
from tltlc.grammar.mistakes.sentences.validity import parsed_clause
from tltlc.grammar.mistakes.sentences.words import Words, phrases
from tltlc.grammar.tree import BinaryExpr, GroupExpr, Unary

_PLAYS: Final = ("play", "recording", "session", "trace", "episode", "run")
_EXCUSES: Final = ("unless", "or", "except when", "except if", "except")
_ENDS: Final = phrases(
    *(
        f"{excuse} {article}{play} {ends}"
        for excuse, article, play, ends in product(_EXCUSES, ("", "the "), _PLAYS, ("ends", "ends first", "is over"))
    ),
    *(
        f"if {article}{play} {lasts}"
        for article, play, lasts in product(
            ("", "the "), _PLAYS, ("lasts that long", "lasts long enough", "goes on that long")
        )
    ),
)
_SECONDS: Final = ("ms", "s", "min", "h")
_WEAK: Final = "weak_eventually"


def uncut(words: Words) -> Words | None:
    """Return the words before `unless the recording ends`; None if a sentence does not end so."""
    ending = words.find_last(_ENDS)
    if ending is None or ending[0] + len(ending[1]) < len(words):
        return None
    before = words[: ending[0]]
    return before[:-1] if before.word(len(before) - 1) == "," else before


def strong_clause(words: Words) -> str:
    """Return the clause with `eventually` in place of `weak_eventually`, a word that others expect; "" without it."""
    text = words.text
    return text.replace(_WEAK, "eventually") if _WEAK in text.split() else ""


def without_cut_off(clause: str) -> str:
    """Return a clause that asks for the same where play goes on, and for nothing where play ends before an answer.

    For `keep a implies eventually within 3 s b`, the time that b has been missing since a stays below 3 s. "" if the
    clause has no such answer.
    """
    tree = parsed_clause(clause)
    value = tree.value if tree is not None and tree.kind == "keep" else None
    if not isinstance(value, BinaryExpr) or value.op != "implies" or not is_about_past(value.left):
        return ""
    answer = value.right
    while isinstance(answer, GroupExpr):
        answer = answer.inner
    if isinstance(answer, BinaryExpr) and answer.op == "U":
        return f"{clause[: answer.op_span.start]}weak_until{clause[answer.op_span.end :]}"
    if isinstance(answer, Unary) and answer.op == "X":
        return f"{clause[: answer.op_span.start]}weak_next{clause[answer.op_span.end :]}"
    if not isinstance(answer, Unary) or answer.op != "F" or answer.bound is None or not is_about_past(answer.operand):
        return ""
    before = clause[answer.op_span.end : answer.operand.span.start].split()
    if before[:1] != ["within"] or before[-1] not in _SECONDS or before[1].strip("0.") == "":
        return ""
    missing = state_of(answer.operand, clause).negated()
    start = joined([state_of(value.left, clause), missing], "and")
    return f"avoid time_holding({missing.at(ATOM)} since ({start.text})) >= {' '.join(before[1:])}"
