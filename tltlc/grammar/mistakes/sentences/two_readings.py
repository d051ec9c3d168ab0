"""Sentences with two readings: ``key before door``, ``door needs key``, ``after alarm, hidden``."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.sentences.answers import answer_of
from tltlc.grammar.mistakes.sentences.rules import condition_of
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, state_of
from tltlc.grammar.mistakes.sentences.vocabulary import COPULAS, FROM_THEN, MODALS, SUBJECTS
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_NEEDS: Final = phrases("requires", "needs", "depends on", "is required for")
_FROM_THEN: Final = (
    "write `keep {b} implies {a}` if `{a}` must hold at each step with `{b}`, "
    "`keep {b} implies always {a}` if from then on"
)
_BEFORE: Final = (
    "write `reach {a} then {b}` if both must happen, in this order, "
    "`require not {b} weak_until {a}` if `{b}` must only not come first"
)
_NEEDED: Final = (
    "write `keep {a} implies {b}` if both must hold at the same step, "
    "`keep {a} implies once {b}` if `{b}` may have held before"
)
_UNTIL: Final = "write `require {a} until {b}` if `{b}` must come, `require {a} weak_until {b}` if it need not"


def both_readings(words: Words) -> str | None:
    """Return a help with the two readings of a sentence; None if it has no two that are known."""
    words = words.without(SUBJECTS)
    first = words.phrase(0, FROM_THEN)
    if first:
        border = words.find(phrases(",", "then", ", then"), len(first))
        if border is None:
            return None
        answer = answer_of(words[border[0] + len(border[1]) :])
        condition = condition_of(words[len(first) : border[0]])
        state = None if answer is None or answer.kind != "now" else answer.state
        return _help(_FROM_THEN, state, condition)
    for known, form in (
        (_NEEDS, _NEEDED),
        (phrases("before"), _BEFORE),
        (FROM_THEN, _FROM_THEN),
        ([("until",)], _UNTIL),
    ):
        found = words.find(known)
        if found is None or not found[0] or words.find(known, found[0] + len(found[1])):
            continue
        left, right = words[: found[0]].without(MODALS), words[found[0] + len(found[1]) :]
        modal = left.find(MODALS)
        if modal is not None:
            left = left[: modal[0]].followed_by(left[modal[0] + len(modal[1]) :].without(COPULAS))
        return _help(form, state_of(left), state_of(right))
    return None


def _help(form: str, a: State | None, b: State | None) -> str | None:
    if a is None or b is None or max(a.level, b.level) > ATOM:
        return None
    return form.format(a=a.at(OR), b=b.at(OR))
