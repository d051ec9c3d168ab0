"""Read goals: ``collect 100 coins``, ``finish in under 90 s``, ``first the key, then the door``."""

from __future__ import annotations

from tltlc.grammar.mistakes.sentences.rules import COUNTED, Clauses, condition_of
from tltlc.grammar.mistakes.sentences.states import (
    ATOM,
    OR,
    State,
    count_of,
    joined,
    state_of,
)
from tltlc.grammar.mistakes.sentences.vocabulary import (
    ALWAYS,
    COMPARISONS,
    COPULAS,
    FIRST_WITHIN,
    MODALS,
    NOT,
    PROHIBITIONS,
    SEQUENCE,
    SUBJECTS,
    VERBS,
    WITHIN,
)
from tltlc.grammar.mistakes.sentences.words import Words, phrases


def goal_of(words: Words) -> Clauses | None:
    """Return the clauses for a goal in English, or None if the words are no goal, or it is unclear which."""
    words = words.without([*SUBJECTS, *MODALS])
    is_first = words.word(0) in ("first", "firstly")
    if is_first:
        words = words[1:]
    if words.find(phrases("followed by")):
        return None  # a rule about each time, or two goals
    verb = words.phrase(0, VERBS)
    parts = words[len(verb) :].split(SEQUENCE)
    if words[len(verb) :].phrase(0, [*NOT, *PROHIBITIONS]) or (verb == ("buy",) and words.find([("with",)])):
        return None
    if not verb and words.phrase(0, [*NOT, *PROHIBITIONS]):
        return None
    if not verb and not is_first and len(parts) < 2:
        is_one = not words.find(
            phrases("and")
        )  # the time of two goals begins at the first of them, or at the first step
        goal = single_goal(words) if is_one and words.find([*WITHIN, *FIRST_WITHIN]) else None
        return goal if goal is not None and goal[0].startswith("require eventually") else None
    goals = [_goal(part.without([*VERBS, (",",)])) for part in parts]
    if len(parts) > 1:
        known = [goal for goal in goals if goal is not None]
        if any(COUNTED.intersection(goal.text.replace("(", " ").split()) for goal in known[1:]):
            return None  # the count begins at the first step, not at the goal before
        return (f"reach {' then '.join(goal.at(OR) for goal in known)}",) if len(known) == len(goals) else None
    return single_goal(parts[0])


def _goal(words: Words) -> State | None:
    """Return a goal of a sequence."""
    at = words.find(phrases("in any order", "in whatever order"))
    if at is not None and at[0] + len(at[1]) == len(words):
        states = [state_of(part) for part in words[: at[0]].split(phrases("and", ","))]
        known = [State(f"once {state.at(ATOM)}") for state in states if state is not None]
        return joined(known, "and") if len(known) == len(states) else None
    count = count_of(words)
    if count is not None and count[1] not in ("", ">=", ">"):
        return None
    if COMPARISONS.get(words.phrase(0, COMPARISONS), ">") in ("<=", "<"):
        return None  # `at most 50 coins` may be a rule
    return _all_of_a_number(words) or condition_of(words)


def _all_of_a_number(words: Words) -> State | None:
    """Return the goal of `all coins` and `all 10 coins`: the number, or the upper end of its range."""
    rest = words[1:].without(phrases("of", "the"))
    declared = rest.declared(0) if words.word(0) in ("all", "every") else None
    number = rest.number(0) if words.word(0) in ("all", "every") and len(rest) == 2 else ""
    counted = rest.declared(1) if number else None
    if counted is not None and counted.type == "int":
        return State(f"{rest[1].text} >= {number}")
    if declared is None or len(rest) != 1 or declared.type != "int" or not declared.ends:
        return None
    return State(f"{rest[0].text} == {declared.ends[1]}")


def single_goal(words: Words) -> Clauses | None:
    """Return the clauses of one goal, perhaps with a time, or with what must hold there or all the time."""
    words = words.without(SUBJECTS)
    with_ = words.find([*phrases("with", "while having", "having")])
    if with_ is not None and with_[0]:
        return _with(words[: with_[0]], words[with_[0] + len(with_[1]) :])
    goal, time = words, ""
    if words.find([*WITHIN, *FIRST_WITHIN]) and COUNTED.intersection(word.text for word in words):
        return None  # the time of a count is that of its steps, or begins at the first step
    first = words.phrase(0, [*WITHIN, *FIRST_WITHIN])
    start = words.time(len(first)) if first else None
    if start is not None:
        state = _goal(words[start[1] :].without([(",",), *VERBS]))
        return None if state is None else (f"require eventually within {start[0].text} {state.at(ATOM)}",)
    found = words.find_last([*WITHIN, *FIRST_WITHIN])
    written = None if found is None else words.time(found[0] + len(found[1]))
    if found is not None and written is not None and written[1] == len(words):
        goal, time = words[: found[0]], written[0].text
    limited = None if time or found is None else _limited(words, found[0], found[0] + 1)
    if limited is not None:
        return limited
    state = _goal(goal)
    if state is None:
        return None
    return (f"require eventually within {time} {state.at(ATOM)}",) if time else (f"reach {state.text}",)


def _limited(words: Words, at: int, stop: int) -> Clauses | None:
    """Return the goal of `solved in at most 50 moves`: the state, and a number that is small enough there."""
    rest = words[stop:]
    phrase = rest.phrase(0, COMPARISONS)
    goal = state_of(words[:at])
    comparison = state_of(rest) if phrase or rest.number(0) else None
    if goal is None or comparison is None or COMPARISONS.get(phrase, "") not in ("<=", "<"):
        return None
    return (f"reach {joined([goal, comparison], 'and').text}",)


def _with(left: Words, right: Words) -> Clauses | None:
    """Return the goal of `a with b`, where b must hold there, or all the time."""
    goal = _goal(left)
    if goal is None:
        return None
    for phrase in ALWAYS:
        if len(right) > len(phrase) and right.phrase(len(right) - len(phrase), [phrase]):
            state = state_of(right[: len(right) - len(phrase)])
            return None if state is None else (f"reach {goal.text}", f"keep {state.text}")
    parts = right.split(phrases("and"))
    here, rules = [], []
    for part in parts:
        if part.word(0) in ("no", "never", "without"):
            state = state_of(part[1:].without(COPULAS))
            rules.append(state)
        else:
            state = condition_of(part)
            here.append(state)
        if state is None:
            return None
    together = joined([goal, *(state for state in here if state is not None)], "and")
    return (f"reach {together.text}", *(f"avoid {state.text}" for state in rules if state is not None))
