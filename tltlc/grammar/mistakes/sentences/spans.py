"""Read rules about a span of time: ``no crash in the first 20 s``, ``no alarm from lap 2 on``."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.sentences.kinds import is_event
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, count_of, state_of
from tltlc.grammar.mistakes.sentences.vocabulary import ALWAYS, COPULAS, FIRST_WITHIN, MODALS, NEVER, SUBJECTS
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_FROM: Final = phrases("from", "starting from", "starting with", "starting at", "beginning with")
_ON: Final = phrases("on", "onwards", "onward", "forward", "forwards")
_FIRST: Final = phrases("before the first", "before first", "before any", "before the very first")


def span_rule_of(words: Words) -> tuple[str, ...] | None:
    """Return the clauses of a rule about a span of time, or None if the words are none."""
    words = words.without([*SUBJECTS, ("keep",)])
    for read in (_from_then_on, _in_the_first, _only_value, _none_of, _counted_first):
        clause = read(words)
        if clause is not None:
            return (clause,)
    return None


def _affirmed(words: Words) -> Words:
    """Return words without `must` before or behind what they are about."""
    words = words.without([*MODALS, ("keep",)])
    end = words.find_last([*MODALS, *((*modal, "be") for modal in MODALS), *phrases("must happen", "happens", "is")])
    return words[: end[0]] if end is not None and end[0] and end[0] + len(end[1]) == len(words) else words


def _from_then_on(words: Words) -> str | None:
    """Return the rule of `a from lap 2 on`: once the number is that large, a must hold to the end."""
    found = words.find(_FROM)
    if found is None or not found[0] or not words[-1:].phrase(0, _ON):
        return None
    event = words[found[0] + len(found[1]) : -1].without(SUBJECTS)
    left = words[: found[0]]
    never = left.phrase(0, (*NEVER, ("no",)))
    always = left.find_last(ALWAYS)
    if always is not None and always[0] + len(always[1]) == len(left):
        left = left[: always[0]]
    state = state_of(left[len(never) :] if never else _affirmed(left))
    declared = event.declared(0)
    number = event.number(1) if declared is not None and declared.type == "int" and len(event) == 2 else ""
    start = State(f"{event[0].text} >= {number}") if number else state_of(event)
    if state is None or start is None:
        return None
    return f"keep {start.at(OR)} implies always {(state.negated() if never else state).at(ATOM)}"


def _in_the_first(words: Words) -> str | None:
    """Return the rule of `no a in the first 20 s` and of `a only in the first 20 s`."""
    found = words.find([*FIRST_WITHIN, *(("only", *phrase) for phrase in FIRST_WITHIN)])
    time = words.time(found[0] + len(found[1])) if found is not None else None
    if found is None or time is None or not found[0] or time[1] < len(words):
        return None
    left = words[: found[0]]
    if found[1][0] == "only":
        state = state_of(_affirmed(left))
        return None if state is None else f"require weak_next after {time[0].text} always {state.negated().at(ATOM)}"
    never = left.phrase(0, (*NEVER, *phrases("no", "avoid", "do not", "don't", "must not")))
    state = state_of(left[len(never) :]) if never else None
    return None if state is None or state.level > ATOM else f"require always for {time[0].text} {state.negated().text}"


def _only_value(words: Words) -> str | None:
    """Return the rule of `weapon is pistol only`: an enum has that value at every step."""
    if words.word(len(words) - 1) == "only":
        words = words[:-1]
    elif words.word(0) == "only":
        words = words[1:]
    else:
        return None
    declared = words.declared(0)
    state = state_of(words) if declared is not None and declared.type == "enum" else None
    return None if state is None or state.level > ATOM else f"keep {state.text}"


def _none_of(words: Words) -> str | None:
    """Return the rule of `no coins`: the number stays at the lower end of its range, 0."""
    declared = words.declared(1)
    is_none = len(words) == 2 and words.word(0) in ("no", "zero") and declared is not None
    if not is_none or declared is None or declared.type != "int" or declared.ends[:1] != ("0",):
        return None
    return f"keep {words[1].text} == 0"


def _counted_first(words: Words) -> str | None:
    """Return the rule of `10 kill before the first reloading`."""
    found = words.find(_FIRST)
    if found is None or not found[0]:
        return None
    left, right = words[: found[0]], state_of(words[found[0] + len(found[1]) :])
    count = count_of(left)
    if count is None and left.number(0) and is_event(left[1:].without(COPULAS)):
        count = State(left[1:].text), "", left.number(0)
    if count is None or right is None or count[1] not in ("", ">=", ">"):
        return None
    return f"require {right.negated().at(ATOM)} until times({count[0].text}) {count[1] or '>='} {count[2]}"
