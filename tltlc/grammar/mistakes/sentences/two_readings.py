"""Sentences with two readings: ``key before door``, ``door needs key``, ``after alarm, hidden``."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.counts_in_words import COMPARE_COUNT
from tltlc.grammar.mistakes.sentences.answers import answer_of
from tltlc.grammar.mistakes.sentences.kinds import call_end
from tltlc.grammar.mistakes.sentences.rules import COUNTED, condition_of
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, state_of
from tltlc.grammar.mistakes.sentences.vocabulary import (
    COMPARISONS,
    COPULAS,
    EQUALITIES,
    FROM_THEN,
    MODALS,
    SAME_STEP,
    SUBJECTS,
    UNEQUAL,
    VERBS,
    WITHIN,
)
from tltlc.grammar.mistakes.sentences.words import Phrase, Words, phrases

_NEEDS: Final = phrases("requires", "needs", "depends on", "is required for")
_FROM_THEN: Final = (
    "write `keep {b} implies {a}` if `{a}` must hold at each step with `{b}`, "
    "`keep {b} implies always {a}` if from then on"
)
_WHEN_AVOID: Final = (
    "write `avoid {b} and {a}` to forbid `{a}` at each step with `{b}`, `keep {b} implies always not {a}` "
    "to forbid it from then on"
)
_AGAIN: Final = (
    "write `avoid (begins {b}) then within {time} (begins {b})` if it must not begin again in that time, "
    "`keep ends {b} implies always for {time} {a}` if the time counts from its end"
)
_BEFORE: Final = (
    "write `reach {a} then {b}` if both must happen, in this order, "
    "`require not {b} weak_until {a}` if `{b}` must only not come first"
)
_NEEDED: Final = (
    "write `keep {a} implies {b}` if both must hold at the same step, "
    "`keep {a} implies once {b}` if `{b}` may have held before"
)
_GOALS: Final = (
    "write `keep {b} implies eventually {a}` if `{a}` must follow each `{b}`, "
    "`reach {b} then {a}` if both must come, in this order"
)
_AFTER: Final = (
    "write `keep {b} implies always a` for `{word} {b} keep a`, "
    "`keep {b} implies eventually a` for `{word} {b} reach a`"
)
_SMALL: Final = "write `keep {a}` if it must hold at every step, `reach {a}` if one step with it is enough"
_KEYWORDS: Final = phrases("reach", "keep", "avoid")
_WHILE: Final = (
    "write `reach {a} and {b}` if it is a goal, `keep {b} implies {a}` if it is a rule for each step with `{b}`"
)
_BOTH: Final = "write `reach {a} and {b}` for both at the same step, `reach {a} then {b}` for one after the other"
_FOLLOWED: Final = (
    "write `keep {a} implies eventually within {time} {b}` if it must follow each time, "
    "`reach {a} then within {time} {b}` if both are goals"
)
_UNTIL: Final = "write `require {a} until {b}` if `{b}` must come, `require {a} weak_until {b}` if it need not"


def both_readings(words: Words) -> str | None:
    """Return a help with the two readings of a sentence; None if it has no two that are known."""
    words = words.without(SUBJECTS)
    first = words.phrase(0, FROM_THEN)
    if first:
        return _after(words, first)
    if first := words.phrase(0, SAME_STEP):
        return _when(words, first)
    if (goals := _goals(words)) is not None:
        return goals
    for known, form in (
        (phrases("while", "during"), _WHILE),
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
        state = state_of(left)
        if form == _BEFORE and state is not None and (state.text.startswith("not ") or " is not " in state.text):
            return None  # what must not come before something else
        return _help(form, state, state_of(right))
    return _small_goal(words) or _counted_in_time(words) or _unknown_value(words) or _state_alone(words)


def _goals(words: Words) -> str | None:
    """Return the help for two goals that `and` or a comma joins, perhaps with a time: `seen, then hidden in 10 s`."""
    found = words.find(phrases("and", ",", ", then", ", and", "then"))
    if found is None or not found[0]:
        return None
    a, rest = state_of(words[: found[0]].without(VERBS)), words[found[0] + len(found[1]) :]
    last = rest.find_last(WITHIN)
    time = None if last is None else rest.time(last[0] + len(last[1]))
    if last is not None and time is not None and time[1] == len(rest) and found[1] != (",",):
        b = state_of(rest[: last[0]].without(VERBS))
        readings = _help(_FOLLOWED.replace("{time}", time[0].text), a, b)
        return readings if "then" in found[1] else None
    return _help(_BOTH, a, state_of(rest.without(VERBS))) if "then" not in found[1] else None


def _after(words: Words, first: Phrase) -> str | None:
    """Return the help for a sentence that begins with `after a`: what follows may be asked for in several ways."""
    border = words.find([*phrases(",", "then", ", then"), *_KEYWORDS], len(first))
    if border is None:
        return None
    start = border[0] if border[1] in _KEYWORDS else border[0] + len(border[1])
    answer, condition = answer_of(words[start:]), condition_of(words[len(first) : border[0]])
    is_counted = answer is not None and COUNTED.intersection(answer.state.text.replace("(", " ").split())
    readings = None
    if answer is not None and answer.kind == "now" and not is_counted and not answer.state.text.startswith("always "):
        readings = _help(_FROM_THEN, answer.state, condition)
    elif answer is not None and answer.kind == "eventually" and answer.keyword == "reach":
        readings = _help(_GOALS, answer.state, condition)
    if readings is None and words[start:].phrase(0, _KEYWORDS):
        event = condition.at(OR) if condition is not None else "b"
        return _AFTER.format(b=event, word=" ".join(first))
    return readings


def _when(words: Words, first: Phrase) -> str | None:
    """Return the help for `when a keep b` and `when a avoid b`: at each step with a, or from the first on."""
    keyword = words.find([("keep",), ("avoid",)], len(first))
    if keyword is None:
        return None
    border = words[keyword[0] - 1]
    end = keyword[0] - (border.text in (",", ":", "then"))
    event, rest = condition_of(words[len(first) : end]), words[keyword[0] + 1 :]
    if keyword[1] == ("avoid",):
        return _help(_WHEN_AVOID, state_of(rest), event)
    answer = answer_of(rest)
    if event is None or answer is None or event.level > ATOM:
        return None
    if answer.kind == "lasting" and answer.state == event.negated():
        return _AGAIN.format(b=event.text, time=answer.time, a=answer.state.at(ATOM))
    return _help(_FROM_THEN, answer.state, event) if answer.kind == "now" else None


def _small_goal(words: Words) -> str | None:
    """Return the help for `the player must reach at most 50 coins`, which the first step may meet."""
    rest = words.without([*SUBJECTS, *MODALS, *VERBS])
    is_small = COMPARISONS.get(rest.phrase(0, COMPARISONS), "") in ("<=", "<")
    state = state_of(rest) if is_small else None
    return None if state is None else _SMALL.format(a=state.text)


def _counted_in_time(words: Words) -> str | None:
    """Return the help for `times(a) <= 2 within 5 s`, whose count begins at the first step."""
    found = words.find(WITHIN)
    time = None if found is None else words.time(found[0] + len(found[1]))
    if not time or words[0].text != "times":
        return None
    return COMPARE_COUNT.format(p=words[2 : call_end(words, 0) - 1].text, time=time[0].text)


def _unknown_value(words: Words) -> str | None:
    """Return the help for `mode is three`, where the enum has no such value."""
    declared = words.declared(0)
    value = words[1:].without([*EQUALITIES, *UNEQUAL])
    if declared is None or declared.type != "enum" or len(value) != 1 or value[0].text in declared.values:
        return None
    listed = ", ".join(f"`{name}`" for name in declared.values)
    return f"`{words[0].text}` has no value `{value[0].text}`: its values are {listed}"


def _state_alone(words: Words) -> str | None:
    """Return the help for a condition in words without the keyword of a clause: `lap is three`."""
    state = state_of(words)
    if state is None or state.text == words.text:
        return None
    return f"write `reach {state.text}`, or `keep {state.text}` for every step"


def _help(form: str, a: State | None, b: State | None) -> str | None:
    if a is None or b is None or max(a.level, b.level) > ATOM:
        return None
    return form.format(a=a.at(OR), b=b.at(OR))
