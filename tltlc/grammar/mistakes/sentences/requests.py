"""Read requests without a verb, and lists of them: ``solved with moves <= 12``, ``at_exit, no damage, under 60 s``."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.mistakes.sentences.goals import goal_of, single_goal
from tltlc.grammar.mistakes.sentences.kinds import is_event
from tltlc.grammar.mistakes.sentences.names import is_goal_verb
from tltlc.grammar.mistakes.sentences.rules import Clauses, condition_of, rule_of
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, State, holding_of, joined, state_of
from tltlc.grammar.mistakes.sentences.stems import parts_of, stem
from tltlc.grammar.mistakes.sentences.vocabulary import (
    COPULAS,
    FIRST_WITHIN,
    NEVER,
    PROHIBITIONS,
    SUBJECTS,
    VERBS,
    WITHIN,
)
from tltlc.grammar.mistakes.sentences.words import Words, phrases

_BETWEEN: Final = phrases(",", ", and", ", but", "but", ";", ".", ", then", "and")
_WITHOUT: Final = phrases("without", ", without", "without ever", "and without", "but without", "while never")
_IN_ORDER: Final = phrases("in order", "in this order", "in that order", "in sequence", "one after the other")
_TIMES: Final = (*WITHIN, *FIRST_WITHIN)


def request_of(words: Words, *, is_imperative: bool) -> Clauses | None:
    """Return the clauses of a request, perhaps with what must not be; None if the words are none, or it is unclear.

    ``is_imperative`` says that the sentence begins with a verb, so that it is a goal and no rule.
    """
    if words.word(0) in ("stay", "remain", "stays", "remains"):
        return _staying(words)
    for read in (_in_order, _infinitely_often, _of_each, _with_only, _listed):
        clauses = read(words)
        if clauses is not None:
            return clauses
    return _with_rules(words, is_imperative=is_imperative)


def _staying(words: Words) -> Clauses | None:
    """Return the goal of `stay hidden for 1 min`: a stretch of that time."""
    holding = holding_of(words[1:]) if words.word(0) in ("stay", "remain") else None
    if holding is None or holding[1] not in ("", ">=", ">", "=="):
        return None
    sign = ">" if holding[1] == ">" else ">="
    return (f"reach time_holding({holding[0].text}) {sign} {holding[2]}",)


def _infinitely_often(words: Words) -> Clauses | None:
    """Return the clauses of `reach a infinitely often`, which needs sessions without an end."""
    at = len(words) - 2
    if at < 1 or not words[at:].phrase(0, phrases("infinitely often")):
        return None
    state = state_of(words[:at].without(VERBS))
    return None if state is None else ("semantics infinite", f"require always eventually {state.at(ATOM)}")


def _of_each(words: Words) -> Clauses | None:
    """Return a goal for each value of an enum, or each name of a kind: `kill with every weapon`, `all three levers`."""
    rest = words.without([*VERBS, *SUBJECTS])
    rest = rest[1:] if is_goal_verb(rest.word(0)) else rest
    group = rest.declared(1)
    if rest is not words and group is not None and group.members and rest.word(0) in ("all", "every", "both"):
        is_right = rest.word(0) != "both" or len(group.members) == 2
        return _of_members(rest[1].text, rest[2:].without([*COPULAS, ("to",), ("be",)])) if is_right else None
    with_ = rest.find(phrases("with every", "with each", "in every", "in each", "with all"))
    if with_ is not None and with_[0] and with_[0] + len(with_[1]) + 1 == len(rest):
        event, enum = condition_of(rest[: with_[0]]), rest.declared(len(rest) - 1)
        if event is None or enum is None or enum.type != "enum":
            return None
        return tuple(f"reach {event.at(AND)} and {rest[-1].text} is {value}" for value in enum.values)
    if rest.word(0) not in ("all", "every", "both") or rest is words:
        return None
    number = "2" if rest.word(0) == "both" else rest.number(1)
    kind = rest[2 if rest.number(1) else 1 :].without([("the",), ("of",)])
    if len(kind) != 1 or kind[0].is_name:
        return None
    names = rest.names.names
    found = [
        name
        for name, declared in names.items()
        if declared.type == "bool" and not declared.parameters and _is_one_of(name, kind[0].text)
    ]
    is_all = len(found) > 1 and (not number or number == str(len(found)))
    return tuple(f"reach {name}" for name in found) if is_all else None


def _of_members(group: str, words: Words) -> Clauses | None:
    """Return the goal that each member of a group has what the only word left says: `sleep` for `asleep`."""
    names = words.names.names
    found = (
        [
            name
            for name, declared in names.items()
            if len(declared.parameters) == 1 and declared.type == "bool" and parts_of(name) == (stem(words[0].text),)
        ]
        if len(words) == 1
        else []
    )
    variable = next(name for name in ("g", "x", "y", "z", "e") if name not in names)
    return (f"reach all {variable} in {group}: {found[0]}({variable})",) if len(found) == 1 else None


def _is_one_of(name: str, kind: str) -> bool:
    """Whether a name is that of a kind, and a letter or number: `lever_a`, `checkpoint2`."""
    parts = parts_of(name)
    rest = name[len(name.rstrip("0123456789")) :]
    if len(parts) == 1:
        return bool(rest) and stem(name[: len(name) - len(rest)]) == stem(kind)
    return len(parts) == 2 and parts[0] == stem(kind) and (len(parts[1]) == 1 or parts[1].isdecimal())


def _with_only(words: Words) -> Clauses | None:
    """Return the goal of `wave_cleared using only the weapon is pistol`, and the rule that the enum keeps its value."""
    found = words.find(phrases("using only", "with only", "only using", "only with", "using just", "with nothing but"))
    if found is None or not found[0]:
        return None
    rest = words[found[0] + len(found[1]) :].without(SUBJECTS)
    declared, state = rest.declared(0), state_of(rest)
    goal = _goal(words[: found[0]], is_imperative=True)
    is_value = declared is not None and declared.type == "enum" and state is not None and state.level < AND
    return (*goal, f"keep {state.text}") if goal is not None and state is not None and is_value else None


def _in_order(words: Words) -> Clauses | None:
    """Return the goals of `a, b, c in order`, perhaps with more behind it: `a and b in this order, then c`."""
    found = words.find(_IN_ORDER)
    if found is None:
        return None
    rest = words[found[0] + len(found[1]) :].without([(",",), ("and",)])
    if rest and rest.word(0) != "then":
        return None
    parts = (
        words[: found[0]].without([*VERBS, ("all",)]).split(phrases(",", "and", ", and", "then", ", then", "and then"))
    )
    goals = [
        state_of(part.without(VERBS)) for part in (*parts, *(rest[1:].split(phrases("then", ", then")) if rest else ()))
    ]
    known = [goal for goal in goals if goal is not None]
    is_sequence = len(known) == len(goals) and len(goals) > 1
    return (f"reach {' then '.join(goal.at(AND) for goal in known)}",) if is_sequence else None


def _listed(words: Words) -> Clauses | None:
    """Return the clauses of a list of one goal, of what must not be, and of a time: `a, no b, never c, under 60 s`."""
    parts = _parts(words)
    if len(parts) < 2:
        return None
    goals: list[Words] = []
    rules: list[str] = []
    time: Words | None = None
    for part in parts:
        if _is_time(part):
            if time is not None:
                return None
            time = part
            continue
        if part.phrase(0, phrases("no", "without", "without ever", *map(" ".join, NEVER))) or part.find(NEVER):
            found = _forbidden(part)
            if found is None:
                return None
            rules += found
            continue
        goals.append(part)
    if len(goals) > 1 or not (goals or rules) or (time is not None and not goals) or not (rules or time):
        return None
    if not goals:
        # The condition of `no a and no b while c` is about both.
        is_shared = len(rules) > 1 and rules[0].startswith("avoid ") and not rules[-1].startswith("avoid ")
        return None if is_shared and not words.find(phrases(";", ".")) else tuple(rules)
    goal = goals[0] if time is None else goals[0].followed_by(time)
    request = _goal(goal, is_imperative=True)
    return None if request is None else (*request, *rules)


def _parts(words: Words) -> list[Words]:
    """Return the parts of a list; `and` divides it only before what must not be."""
    parts = words.split([phrase for phrase in _BETWEEN if phrase != ("and",)])
    divided: list[Words] = []
    for part in parts:
        start = 0
        at = part.find([("and",)])
        while at is not None:
            if part[at[0] + 1 :].phrase(0, phrases("no", "never", "without")):
                divided.append(part[start : at[0]])
                start = at[0] + 1
            at = part.find([("and",)], at[0] + 1)
        divided.append(part[start:])
    return [part for part in divided if part]


def _is_time(words: Words) -> bool:
    phrase = words.phrase(0, _TIMES)
    time = words.time(len(phrase)) if phrase else None
    return time is not None and time[1] == len(words)


def _forbidden(words: Words) -> Clauses | None:
    """Return the rule of `no a`, `never a`, `without a`."""
    without = words.phrase(0, phrases("without", "without ever"))
    if not without:
        return rule_of(words)
    state = _avoided(words[len(without) :])
    return None if state is None else (f"avoid {state.text}",)


def _avoided(words: Words) -> State | None:
    """Return what stands after `without`; a list may go on with another goal, or mean all of it together."""
    rest = words.without([*SUBJECTS, *COPULAS, *phrases("any", "ever", "using")])
    return None if rest.find(phrases("and", ",", "then", "before", "until")) else condition_of(rest)


def _with_rules(words: Words, *, is_imperative: bool) -> Clauses | None:
    """Return the goal of `a without b`, `a with b`, `a in under 60 s`, or of a verb alone: `drift for 10 s`."""
    without = words.find(_WITHOUT)
    if without is None or not without[0]:
        begins = words.find([*_TIMES, ("with",), ("at",), ("maxed",)])
        is_request = begins is not None and begins[0] > 0
        return _goal(words, is_imperative=is_imperative) if is_request or is_imperative else None
    left, right = words[: without[0]], words[without[0] + len(without[1]) :]
    is_first = left.without([*phrases("reach"), *SUBJECTS])
    is_goal = is_imperative or left.word(0) == "reach"
    if left.find(
        phrases("or", "and", ",", "until", "before", "after", "when", "if", "while", *map(" ".join, PROHIBITIONS))
    ):
        return None
    sequence = left.find(phrases("then"))
    if sequence is not None and without[1] == ("without",):
        return None  # it may be about the last goal alone
    state = _avoided(right)
    goal = None
    if sequence is not None and state is not None:
        goal = goal_of(left)
    elif state is not None and is_first:
        goal = _goal(left.without([("reach",)]), is_imperative=is_goal)
    return None if goal is None or state is None else (*goal, f"avoid {state.text}")


def _value_with_unit(words: Words) -> str:
    """Return the comparison of `90 m/s` with the only number that has this unit; "" if there are several or none."""
    unit = [word.text for word in words[1:]]
    if not words.number(0) or not unit or words[1].type != "UNIT":
        return ""
    names = [
        name
        for name, declared in words.names.names.items()
        if declared.ends and declared.ends[1].split()[1:] == unit and not declared.parameters
    ]
    return f"{names[0]} >= {words.text}" if len(names) == 1 else ""


def _goal(words: Words, *, is_imperative: bool) -> Clauses | None:
    """Return the clauses of one goal; an action that goes on, as `running`, may be a rule without a verb before it."""
    words = words.without(SUBJECTS)
    verb = words.phrase(0, VERBS)
    if is_imperative and not verb and is_goal_verb(words.word(0)):
        verb = (words[0].text,)
    words = words[len(verb) :].without(SUBJECTS)
    if not words or words.phrase(0, [*PROHIBITIONS, ("not",)]):
        return None
    if verb == ("buy",) and words.find([("with",)]):
        return None  # the price, or what is left
    if words.find([("and",)]):
        return None  # at the same step, or one after the other
    if (verb or is_imperative) and (value := _value_with_unit(words)):
        return (f"reach {value}",)
    if words.number(0) and is_event(words[1:]):
        return (f"reach times({words[1:].text}) >= {words.number(0)}",)
    is_action = words[0].is_name and words[0].text.endswith("ing")
    if is_action and not verb and not is_imperative:
        return None
    while_ = words.find(phrases("while", "during", "as", "when", "on", "at"))
    if while_ is not None and while_[0]:
        left, right = condition_of(words[: while_[0]]), condition_of(words[while_[0] + 1 :])
        more = words[while_[0] + 1 :].find(phrases("while", "during", "on", "at"))
        if more is not None and more[0]:
            rest = words[while_[0] + 1 :]
            states = [left, condition_of(rest[: more[0]]), condition_of(rest[more[0] + 1 :])]
        else:
            states = [left, right]
        known = [state for state in states if state is not None]
        is_known = len(known) == len(states) and (is_imperative or verb or while_[1][0] in ("at", "on"))
        return (f"reach {joined(known, 'and').text}",) if is_known else None
    return single_goal(words)
