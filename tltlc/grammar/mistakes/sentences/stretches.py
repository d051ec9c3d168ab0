"""Read rules about stretches of play: ``keep a between b and c``, ``each nap lasts at least 4 s``, ``at the end a``."""

from __future__ import annotations

from itertools import combinations
from typing import Final

from tltlc.grammar.mistakes.sentences.kinds import call_end, is_event, is_value
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined, state_of
from tltlc.grammar.mistakes.sentences.vocabulary import FOR, MODALS, NEVER, PROHIBITIONS, SUBJECTS, UNLESS
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_FORBIDDEN: Final = (*NEVER, *phrases("avoid", "no", "forbid", "prevent", "must not"))
_AT_END: Final = phrases("at the end", "in the end", "at the last step", "on the last step", "end with", "ends with")
_STEPS: Final = phrases("step", "steps", "frame", "frames", "tick", "ticks")
_LONGER: Final = phrases("for more than", "for longer than", "more than", "longer than")


def stretch_rule_of(words: Words) -> tuple[str, ...] | None:
    """Return the clauses of a rule about a stretch of play, or None if the words are none."""
    for read in (_between, _each_lasts, _at_the_end, _at_most_one, _too_many_steps, _without_before):
        clauses = read(words)
        if clauses is not None:
            return clauses
    return None


def _between(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `between a and b keep c` and `avoid c between a and b`: from each a to the next b."""
    found = words.find([("between",)])
    joint = None if found is None else words.find([("and",)], found[0])
    if found is None or joint is None:
        return None
    start = words[found[0] + 1 : joint[0]]
    if found[0]:
        rule, stop = words[: found[0]], words[joint[0] + 1 :]
    else:
        keyword = words.find([("keep",), (",",), *_FORBIDDEN], joint[0])
        if keyword is None:
            return None
        stop = words[joint[0] + 1 : keyword[0]]
        rule = words[keyword[0] :].without([(",",)])
    forbidden = rule.phrase(0, _FORBIDDEN)
    if not (forbidden or rule.word(0) == "keep") or is_value(rule[1:]):
        return None  # `keep health between 20 and 80`
    state = state_of(rule[len(forbidden) or 1 :])
    first, last = state_of(start), state_of(stop)
    if state is None or first is None or last is None or max(first.level, last.level) > ATOM or first == last:
        return None
    begun = first.text if first.text.startswith(("begins ", "ends ")) else f"begins {first.at(ATOM)}"
    held = (state.negated() if forbidden else state).at(ATOM)
    return (f"keep {begun} implies ({held} weak_until {last.at(ATOM)})",)


def _each_lasts(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `each a lasts at least 4 s`."""
    if words.word(0) not in ("each", "every"):
        return None
    found = words.find(phrases("lasts", "must last", "should last", "lasts for", "must last for"))
    if found is None or not is_event(words[1 : found[0]]):
        return None
    rest = words[found[0] + len(found[1]) :]
    least = rest.phrase(0, phrases("at least", "for at least"))
    time = rest.time(len(least)) if least else None
    event = words[1 : found[0]].text
    is_whole = time is not None and time[1] == len(rest)
    return (f"keep begins {event} implies always for {time[0].text} {event}",) if time and is_whole else None


def _at_the_end(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `at the end a`, about the last step."""
    words = words.without([*SUBJECTS, ("keep",), ("reach",)])
    first, last = words.phrase(0, _AT_END), words.find_last(_AT_END)
    if first:
        rest = words[len(first) :].without([(",",), *SUBJECTS, *MODALS])
    elif last is not None and last[0] and last[0] + len(last[1]) == len(words):
        rest = words[: last[0]].without(MODALS)
    else:
        return None
    state = None if rest.find([*PROHIBITIONS, *UNLESS]) else state_of(rest)
    return None if state is None else (f"require eventually always {state.at(ATOM)}",)


def _at_most_one(words: Words) -> tuple[str, ...] | None:
    """Return the rules of `keep at most one of (a, b, c)`: no two of them hold at the same step."""
    words = words.without([("keep",), *SUBJECTS])
    phrase = words.phrase(0, phrases("at most one of", "no more than one of", "not more than one of", "only one of"))
    rest = words[len(phrase) :]
    if not phrase or not rest:
        return None
    if rest[0].text == "(" and rest[-1].text == ")":
        rest = rest[1:-1]
    states = [state_of(part) for part in rest.split(phrases(",", ", and", "and", ", or", "or"))]
    known = [state for state in states if state is not None and state.level == ATOM]
    if len(known) != len(states) or len(known) < 2:
        return None
    return tuple(f"avoid {one.text} and {other.text}" for one, other in combinations(known, 2))


def _too_many_steps(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `avoid a for more than 20 steps in a row`, perhaps with `except while b` behind it."""
    forbidden = words.phrase(0, _FORBIDDEN)
    rest = words[len(forbidden) :]
    unless = rest.find(UNLESS)
    exception = None if unless is None else state_of(rest[unless[0] + len(unless[1]) :])
    if not forbidden or (unless is not None and exception is None):
        return None
    rest = rest if unless is None else rest[: unless[0]]
    found = rest.find_last(_LONGER)
    number = "" if found is None else rest.number(found[0] + len(found[1]))
    if found is None or not number.isdecimal() or number == "0":
        return None
    after = rest[found[0] + len(found[1]) + 1 :].without(phrases("consecutive", "successive"))
    unit = after.phrase(0, _STEPS)
    if not unit or after[1:].without(phrases("in a row", "straight", "at a stretch", "without a break")):
        return None
    state = state_of(rest[: found[0]])
    if state is None:
        return None
    held = (state if exception is None else joined([state, exception.negated()], "and")).at(ATOM)
    return (f"avoid always for {number} steps {held} and next after {number} steps {held}",)


def _without_before(words: Words) -> tuple[str, ...] | None:
    """Return the rule of `never a without b before`: b has held at that step or before."""
    forbidden = words.phrase(0, _FORBIDDEN)
    found = words.find([("without",)])
    if not forbidden or found is None or words.word(len(words) - 1) not in ("before", "first", "beforehand"):
        return None
    state, condition = state_of(words[len(forbidden) : found[0]]), _lasting(words[found[0] + 1 : -1])
    if state is None or condition is None:
        return None
    return (f"keep {state.at(OR)} implies once {condition.at(ATOM)}",)


def _lasting(words: Words) -> State | None:
    """Return a condition, perhaps one that has held for a time: `(in_zone for at least 5 s)`."""
    if words and words[0].text == "(" and call_end(words.of((words[0], *words)), 0) == len(words) + 1:
        words = words[1:-1]
    found = words.find_last(FOR)
    time = None if found is None else words.time(found[0] + len(found[1]))
    if found is None or time is None or time[1] != len(words) or not time[0].is_real:
        return state_of(words)
    state = state_of(words[: found[0]])
    return None if state is None else State(f"(time_holding({state.text}) >= {time[0].text})")
