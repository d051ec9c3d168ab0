"""Read conditions on one step: ``reloading``, ``ammo is 0``, ``health below 20 and not in cover``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.mistakes.sentences.changes import change_of, loss_of
from tltlc.grammar.mistakes.sentences.kinds import (
    call_end,
    is_arithmetic,
    is_bool,
    is_event,
    is_number,
    is_quantity,
    is_value,
)
from tltlc.grammar.mistakes.sentences.vocabulary import (
    AT_ONCE,
    COMPARISONS,
    COPULAS,
    EQUALITIES,
    NEGATED_SIGN,
    NOT,
    SUBJECTS,
    UNEQUAL,
)
from tltlc.grammar.mistakes.sentences.words import Words, phrases

ATOM, AND, OR, RULE = range(4)
"""How loosely the outermost operator of a text binds."""

_SIGNS: Final = {"LESS": "<", "AT_MOST": "<=", "MORE": ">", "AT_LEAST": ">=", "EQUALS": "==", "UNEQUAL": "!="}
_PAST: Final = ("once", "historically", "previously", "begins", "ends")
_TIMES: Final = phrases("times", "time", "x")
_COUNTED: Final = (*COMPARISONS, ("exactly",), ("once",), ("twice",), ("thrice",))
_OFTEN: Final = {"once": "1", "twice": "2", "thrice": "3"}


@record
class State:
    """A condition on one step, as text of the language, and how loosely it binds.

    ``opposite`` is the text of the opposite condition where a shorter one than `not …` says it.
    """

    text: str
    level: int = ATOM
    opposite: str = ""

    def at(self, level: int) -> str:
        """Return the text as an operand of an operator that binds at most as loosely as ``level``."""
        return self.text if self.level <= level else f"({self.text})"

    def negated(self) -> State:
        """Return the opposite condition."""
        return State(self.opposite or f"not {self.at(ATOM)}", ATOM, self.at(ATOM))


def joined(states: list[State], operator: str) -> State:
    """Return the conjunction or disjunction of some conditions."""
    if len(states) == 1:
        return states[0]
    level = AND if operator == "and" else OR
    return State(f" {operator} ".join(state.at(level) for state in states), level)


def state_of(words: Words) -> State | None:
    """Return the condition that words say, or None if they say none, or it is unclear which."""
    words = _trimmed(words)
    if not words or words.find([("not", "both")]):
        return None
    if _is_in_brackets(words):
        return state_of(words[1:-1])
    if words.word(0) == "between" or words.find([("between",)]):
        return _between(words)
    if words.phrase(0, phrases("neither")) and len(parts := words[1:].split(phrases("nor"))) == 2:
        return _all_of([_negation(part) for part in parts], "and")
    for operator in ("or", "and"):
        parts = words.split(phrases(operator, f", {operator}"))
        if (
            operator == "or"
            and any(part.find(NOT) for part in parts[:-1])
            and (len(parts[-1]) == 1 or any(word.is_renamed for word in parts[-1]))
        ):
            return None  # neither of two values
        if len(parts) > 1:
            # `a, b or c` is a list.
            first = [item for part in parts[:-1] for item in part.split(phrases(","))]
            return _all_of([state_of(part) for part in _with_subject((*first, parts[-1]))], operator)
    if not_ := words.phrase(0, NOT):
        rest = words[len(not_) :]
        inner = state_of(rest)
        is_whole = inner is not None and (inner.level == ATOM or (bool(rest) and _is_in_brackets(rest)))
        return inner.negated() if inner is not None and is_whole else None
    if len(sides := words.split([("^",)])) == 2:
        return _exclusive(*sides)
    return _atom(words)


def count_of(words: Words) -> tuple[State, str, str] | None:
    """Return the event, sign and number of `died at most 3 times` and `at most 3 died`; the sign may be empty."""
    words = words.without(SUBJECTS)
    phrase = words.phrase(0, [*COMPARISONS, ("exactly",), ("only",)])
    number = words.number(len(phrase)) or _OFTEN.get(words.word(len(phrase)), "")
    at = len(phrase) + 1
    if number and (phrase or words.phrase(at, _TIMES) or words.number(0) != words[0].text):
        at += len(words.phrase(at, [*_TIMES, ("different",)]))
        event = words[at:].without([*SUBJECTS, *phrases("of"), *COPULAS])
        if is_event(event) and not words.phrase(0, phrases("once")):
            return State(event.text), _count_sign(phrase), number
    end = call_end(words, 0)
    if is_value(words[:end]):
        end = next((at for at in range(end, len(words)) if words[at:].phrase(0, _COUNTED)), len(words))
    counted = State(words[:end].text) if is_bool(words, 0) else state_of(words[:end]) if end < len(words) else None
    if counted is None or counted.level != ATOM:
        return None
    rest = words[end:].without(COPULAS)
    phrase = rest.phrase(0, [*COMPARISONS, ("exactly",), ("only",), ("<=",), (">=",), ("<",), (">",), ("==",)])
    number, at = rest.number(len(phrase)) or _OFTEN.get(rest.word(len(phrase)), ""), len(phrase) + 1
    spelt = rest.word(len(phrase)) in _OFTEN
    times = () if spelt else rest.phrase(at, _TIMES)
    if not number or not (times or spelt) or at + len(times) != len(rest):
        return None
    return counted, _count_sign(phrase), number


def holding_of(words: Words) -> tuple[State, str, str] | None:
    """Return what holds, a sign and a time of `hidden for at least 3 s`; the sign is empty for `for 3 s`.

    It is `==` for `for exactly 3 s`.
    """
    found = words.find_last([("for",)])
    if found is None:
        end = call_end(words, 0)
        if is_event(words[:end]):
            at, start = end, end + len(words.phrase(end, phrases("lasts", "last")))
        elif words.phrase(0, NOT) and (compared := words.find(COMPARISONS)) is not None:
            at = start = compared[0]
        else:
            return None
    else:
        at, start = found[0], found[0] + 1
    phrase = words.phrase(start, [*COMPARISONS, ("exactly",)])
    time = words.time(start + len(phrase))
    rest = words[time[1] :] if time else words
    if time is None or rest.without(phrases("straight", "in a row", "without a break", "or more", "continuously")):
        return None
    exactly = "==" if phrase == ("exactly",) else ""
    sign = ">=" if rest.phrase(0, phrases("or more")) else COMPARISONS.get(phrase, exactly)
    state = state_of(words[:at])
    if state is None or (found is None and not sign) or not time[0].is_real:
        return None
    return state, sign, time[0].text


def _count_sign(phrase: tuple[str, ...]) -> str:
    if phrase and phrase[0] in ("<=", ">=", "<", ">", "=="):
        return phrase[0]
    return COMPARISONS.get(phrase, "==" if phrase == ("exactly",) else "<=" if phrase == ("only",) else "")


def _trimmed(words: Words) -> Words:
    """Return words without articles, words for the player, and words such as `at the same time` at the end."""
    words = words.without([*SUBJECTS, *phrases("either", "both", "all of", "any of")])
    at = words.find(AT_ONCE)
    if at is not None and at[0] and at[0] + len(at[1]) == len(words):
        return _trimmed(words[: at[0]])
    copula = words.phrase(0, COPULAS)
    return words[len(copula) :] if copula and not words.phrase(len(copula), [("not",)]) else words


def _with_subject(parts: Sequence[Words]) -> Iterator[Words]:
    """Yield the parts of a list, and before each value of an enum the enum: `mode is calm, mode alert`."""
    declared = parts[0].declared(0) if parts[0] else None
    for part in parts:
        is_value_of = declared is not None and len(part) == 1 and part[0].text in declared.values
        yield parts[0][: call_end(parts[0], 0)].followed_by(part) if is_value_of else part


def _is_in_brackets(words: Words) -> bool:
    return words[0].text == "(" and words[-1].text == ")" and 2 <= len(list(words.outer())) <= 2


def _all_of(states: list[State | None], operator: str) -> State | None:
    known = [state for state in states if state is not None]
    return joined(known, operator) if len(known) == len(states) else None


def _exclusive(left: Words, right: Words) -> State | None:
    """Return the condition of `a ^ b`, where one of two conditions holds, and the other does not."""
    a, b = state_of(left), state_of(right)
    if a is None or b is None:
        return None
    return joined([joined([a, b.negated()], "and"), joined([b, a.negated()], "and")], "or")


def _negation(words: Words) -> State | None:
    state = state_of(words)
    return None if state is None else state.negated()


def _between(words: Words) -> State | None:
    """Return the condition of `health between 20 and 80`, perhaps with `is` before `between`."""
    found = words.find([("between",)])
    assert found is not None
    left, right = words[: found[0]], words[found[0] + 1 :]
    ends = right.split(phrases("and"))
    end = call_end(left, 0) if left else 0
    if len(ends) != 2 or not left or left[end:].without(COPULAS) or not is_number(left, 0):
        return None
    if not all(is_quantity(side) for side in ends):
        return None
    name = left[:end].text
    return State(f"{name} >= {ends[0].text} and {name} <= {ends[1].text}", AND)


def _atom(words: Words) -> State | None:
    """Return a condition without `and` and `or`."""
    if words[0].text in _PAST and not words[0].is_name:
        window = words.word(1) in ("within", "for")
        time = words.time(2) if window else None
        start = time[1] if time else 1
        inner = None if window and time is None else state_of(words[start:])
        bound = f" {words.word(1)} {time[0].text}" if time else ""
        return None if inner is None else State(f"{words[0].text}{bound} {inner.at(ATOM)}")
    return _in_the_last(words) or _of_number(words) or _of_bool(words) or _of_enum(words) or _of_group(words)


def _in_the_last(words: Words) -> State | None:
    """Return the condition of `seen within the last 2 s`."""
    found = words.find_last(phrases("within last", "within the last", "in the last", "in last"))
    time = None if found is None else words.time(found[0] + len(found[1]))
    if found is None or time is None or time[1] != len(words) or not found[0]:
        return None
    inner = state_of(words[: found[0]])
    return None if inner is None else State(f"once within {time[0].text} {inner.at(ATOM)}")


def _of_number(words: Words) -> State | None:
    """Return a comparison of numbers, with a sign or in words: `health < 20`, `at least 3 coins`, `lap 2`."""
    sign = next((i for i in words.outer() if words[i].type in _SIGNS), None)
    if sign is not None and sign > 0 and is_arithmetic(words[:sign]) and is_arithmetic(words[sign + 1 :]):
        left, right = words[:sign].text, words[sign + 1 :].text
        declared = words.declared(0) if sign == 1 else None
        is_int = declared is None or declared.type == "int"
        ends = () if is_int or declared is None else tuple(end.replace(" / ", "/") for end in declared.ends)
        if words[sign].type == "EQUALS" and right in ends:
            return _comparison(left, ">=" if right == ends[1] else "<=", right)
        return State(words.text, ATOM, _opposite(left, _SIGNS[words[sign].type], right))
    phrase = words.phrase(0, [*COMPARISONS, ("exactly",)])
    if (phrase or words[0].type == "NUMBER") and is_number(words, len(words) - 1) and len(words) == len(phrase) + 2:
        number = words.number(len(phrase))
        relation = COMPARISONS.get(phrase, "==" if phrase else ">=")
        return _comparison(words[-1].text, relation, number) if number else None
    if len(words) == 2 and is_value(words[1:]) and is_number(words, 1) and (lost := loss_of(words)):
        return _comparison(words[1].text, lost, f"previous({words[1].text})")
    if not is_number(words, 0):
        return None
    end = call_end(words, 0)
    value, rest = words[:end].text, words[end:]
    copula = rest.phrase(0, COPULAS)
    for start in {len(copula), 0}:
        phrase = rest.phrase(start, COMPARISONS)
        if phrase and is_quantity(rest[start + len(phrase) :]):
            return _comparison(value, COMPARISONS[phrase], rest[start + len(phrase) :].text)
    declared = words.declared(0)
    kind = "" if declared is None else declared.type
    if declared is not None and (full := _full(rest, declared.ends)):
        return _comparison(value, ">=", full)
    change = change_of(value, kind, rest)
    if change is not None:
        text, relation = change
        return (
            _comparison(value, relation, f"previous({value})")
            if relation in NEGATED_SIGN
            else State(text, AND * (relation == "and"))
        )
    unequal, equal = rest.phrase(0, UNEQUAL), rest.phrase(0, EQUALITIES)
    phrase = unequal if len(unequal) >= len(equal) else equal
    ends = () if declared is None or kind == "int" or phrase == unequal else declared.ends
    if ends and phrase and rest[len(phrase) :].text in ends:
        return _comparison(value, ">=" if rest[len(phrase) :].text == ends[1] else "<=", rest[len(phrase) :].text)
    if kind == "int" and len(rest) == len(phrase) + 1 and (number := rest.number(len(phrase))):
        return _comparison(value, "!=" if phrase and phrase == unequal else "==", number)
    return None


def _full(words: Words, ends: tuple[str, ...]) -> str:
    """Return the upper end of a range for `maxed out`, perhaps with the number behind it; else ""."""
    phrase = words.phrase(0, phrases("maxed out", "maxed", "is maxed out", "is full", "at max", "at maximum", "is max"))
    rest = words[len(phrase) :]
    is_same = not rest or (len(ends) == 2 and rest.text in (ends[1], f"({ends[1]})"))
    return ends[1] if phrase and is_same and len(ends) == 2 else ""


def _of_bool(words: Words) -> State | None:
    """Return a signal or predicate that is true or false, perhaps with `is true`, or a count of one."""
    end = call_end(words, 0)
    if not is_bool(words, 0):
        return None
    state, rest = State(words[:end].text), words[end:]
    if len(rest) == len(rest.phrase(0, COPULAS)):
        return state
    if rest[0].type == "EQUALS" and rest[1:] and _is_in_brackets(rest[1:]) and (other := state_of(rest[1:])):
        return State(f"{state.text} iff {other.at(OR)}", RULE)
    verb = rest.phrase(0, [*EQUALITIES, *COPULAS, *UNEQUAL])
    if verb and len(rest) == len(verb) + 1 and rest.word(len(verb)) in ("true", "false"):
        is_negated = (verb in UNEQUAL) != (rest.word(len(verb)) == "false")
        return state.negated() if is_negated else state
    count = count_of(words)
    if count is not None and count[1]:
        return _comparison(f"times({count[0].text})", count[1], count[2])
    return None


def _of_enum(words: Words) -> State | None:
    """Return the comparison of an enum with one of its values: `mode is chase`, `mode not chase`."""
    declared = words.declared(0)
    if declared is None or declared.type != "enum":
        return None
    end = call_end(words, 0)
    rest = words[end:]
    ordered = _in_order(words[:end].text, rest, declared.values)
    if ordered is not None:
        return ordered
    unequal, equal = rest.phrase(0, UNEQUAL), rest.phrase(0, EQUALITIES)
    phrase = unequal if len(unequal) >= len(equal) else equal
    value = rest[len(phrase) :].without(phrases("in", "on", "at", "be", "to"))
    if len(value) != 1 or value[0].text not in declared.values:
        return None
    signs = ("is", "is not") if not phrase or phrase != unequal else ("is not", "is")
    text, opposite = (f"{words[:end].text} {sign} {value[0].text}" for sign in signs)
    return State(text, ATOM, opposite)


def _in_order(name: str, words: Words, values: tuple[str, ...]) -> State | None:
    """Return the condition of `mode >= alert`: one of the values of an enum, in the order of their declaration."""
    sign = _SIGNS.get(words[0].type, "") if len(words) == 2 else ""
    if sign not in ("<", "<=", ">", ">=") or words[1].text not in values:
        return None
    at = values.index(words[1].text) + (sign in ("<=", ">"))
    listed = values[at:] if sign in (">", ">=") else values[:at]
    return joined([State(f"{name} is {value}") for value in listed], "or") if 0 < len(listed) < len(values) else None


def _of_group(words: Words) -> State | None:
    """Return a condition on each member of a group: `all guards asleep`, `distance(guards) > 2 m`."""
    quantifier = {"all": "all", "every": "all", "each": "all", "any": "any", "some": "any"}.get(words.word(0), "")
    rest = words[1:].without(phrases("of", "the", "in"))
    declared = rest.declared(0) if quantifier else None
    if declared is None or not declared.members:
        return None
    variable = next(name for name in ("g", "x", "y", "z", "e") if name not in words.names.names)
    body = rest[1:].without([*COPULAS, (":",), (",",)])
    predicate = body.declared(0)
    if predicate is None or len(predicate.parameters) != 1:
        return None
    call = f"{body[0].text}({variable})"
    if len(body) == 1 and predicate.type in ("bool", ""):
        return State(f"{quantifier} {variable} in {rest[0].text}: {call}", RULE)
    if len(body) > 2 and body[1].type in _SIGNS and is_quantity(body[2:]):
        return State(f"{quantifier} {variable} in {rest[0].text}: {call} {body[1:].text}", RULE)
    return None


def _comparison(left: str, sign: str, right: str) -> State:
    return State(f"{left} {sign} {right}", ATOM, _opposite(left, sign, right))


def _opposite(left: str, sign: str, right: str) -> str:
    return f"{left} {NEGATED_SIGN[sign]} {right}" if sign in NEGATED_SIGN else ""
