"""Read rules: ``jumping only if on_ground``, ``when died, respawned within 5 s``, ``never boosting in the pit``."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.mistakes.sentences.answers import Answer, answer_of, clause_of
from tltlc.grammar.mistakes.sentences.kinds import is_event, is_value
from tltlc.grammar.mistakes.sentences.limits import bounded_count, bounded_time
from tltlc.grammar.mistakes.sentences.spans import span_rule_of
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, RULE, State, count_of, holding_of, joined, state_of
from tltlc.grammar.mistakes.sentences.stretches import stretch_rule_of
from tltlc.grammar.mistakes.sentences.vocabulary import (
    ALWAYS,
    AT_ONCE,
    COPULAS,
    FROM_THEN,
    LASTING,
    MODALS,
    NEVER,
    ONLY_AFTER,
    ONLY_WHEN,
    PROHIBITIONS,
    SAME_STEP,
    SUBJECTS,
    UNLESS,
    UNTIL,
)
from tltlc.grammar.mistakes.sentences.words import Words, phrases

Clauses = tuple[str, ...]
COUNTED: Final = frozenset(("times", "time_since", "time_holding"))
"""The functions whose values depend on all steps before."""
_BECOMES: Final = phrases("becomes", "turns", "changes to", "turns to", "starts", "begins", "goes to", "switches to")
_EACH: Final = (*LASTING, *phrases("whenever", "every time", "each time", "any time", "anytime"))
"""Words before a condition, at each step of which what follows must hold."""
_EITHER: Final = phrases("while", "during")
"""Words between an event and a condition that may say a goal, or a rule."""


def rule_of(words: Words) -> Clauses | None:
    """Return the clauses for a rule in English, or None if the words are no rule, or it is unclear which."""
    readers = (span_rule_of, stretch_rule_of, _scenario, _implication, _condition_first, _condition_last)
    for read in (*readers, _unconditional):
        clauses = read(words)
        if clauses is not None:
            return clauses
    return None


def condition_of(words: Words) -> State | None:
    """Return the condition of a rule, which may last or be counted, too: `aiming for 1 s`, `died 3 times`."""
    becomes = words.find(_BECOMES)
    if becomes is not None and becomes[0]:
        state = state_of(words[: becomes[0]].followed_by(words[becomes[0] + len(becomes[1]) :].without([("true",)])))
        return None if state is None or state.level > ATOM else State(f"begins {state.text}")
    holding = holding_of(words)
    if holding is not None and holding[1] == "==":
        return State(f"begins (time_holding({holding[0].text}) >= {holding[2]})")  # the step at which it is over
    if holding is not None:
        held = State(f"time_holding({holding[0].text}) {holding[1] or '>='} {holding[2]}")
        # A time that is not yet over is also 0 while the condition does not hold.
        return joined([holding[0], held], "and") if holding[1] in ("<", "<=") else held
    count = count_of(words)
    if count is not None:
        return State(f"times({count[0].text}) {count[1] or '>='} {count[2]}")
    parts = words.split(phrases("and"))
    if len(parts) > 1 and not words.find([("between",), ("or",)]):
        states = [condition_of(part) for part in parts]
        known = [state for state in states if state is not None]
        return joined(known, "and") if len(known) == len(states) else None
    return state_of(words)


def _scenario(words: Words) -> Clauses | None:
    """Return the rule of a scenario: `given a when b then c`."""
    if words.word(0) != "given":
        return None
    found, then = words.find(phrases("when")), words.find(phrases("then"))
    if then is None or (found is not None and found[0] > then[0]):
        return None
    steps = [words[1 : then[0]]] if found is None else [words[1 : found[0]], words[found[0] + 1 : then[0]]]
    states = [condition_of(_steps(step)) for step in steps]
    known = [state for state in states if state is not None]
    return _answered_by(joined(known, "and"), words[then[0] + 1 :]) if known and len(known) == len(states) else None


def _answered_by(event: State, words: Words) -> Clauses | None:
    """Return the rule that asks for an answer on the same step, perhaps with `unless c` behind it."""
    words = _steps(words)
    unless = words.find(UNLESS)
    if unless is not None and unless[0]:
        exception = condition_of(words[unless[0] + len(unless[1]) :])
        if exception is None:
            return None
        event, words = joined([event, exception.negated()], "and"), words[: unless[0]]
    answer = answer_of(words)
    return None if answer is None else answered(event, answer, is_from_then=False)


def _steps(words: Words) -> Words:
    return words[:-1] if words and words[-1].text in (",", ".") else words


def _implication(words: Words) -> Clauses | None:
    """Return the rule of `keep a implies b within 5 s`, whose answer is in the words of English."""
    is_always = words.word(0) == "always" and words.word(1) in ("begins", "ends")
    words = words[1:] if is_always else words  # an event that always holds is hardly meant
    parts = words.without([("keep",)]).split([("implies",), ("=", ">")])
    if len(parts) != 2 or words.word(0) == "not" or parts[1].phrase(0, NEVER):
        return None
    event, answer = condition_of(parts[0].without([*SUBJECTS, *phrases("every", "each", "any")])), answer_of(parts[1])
    return None if event is None or answer is None else answered(event, answer, is_from_then=False)


def _condition_first(words: Words) -> Clauses | None:
    """Return the rule of a sentence that begins with its condition: `when a, b`, `once a, never b`."""
    phrase = words.phrase(0, [*SAME_STEP, *FROM_THEN])
    if not phrase:
        return _unless_first(words)
    for start, stop in _borders(words, len(phrase)):
        event, answer = condition_of(words[len(phrase) : start]), answer_of(words[stop:])
        if phrase == ("if",) and words[stop:].find(UNTIL):
            return None  # the rule may end there, or what it asks for
        if event is not None and phrase in SAME_STEP and words[stop:].find(UNLESS):
            return _answered_by(event, words[stop:])
        if event is None or answer is None or (answer.keyword == "reach" and phrase in LASTING):
            continue
        if answer.keyword == "keep" and answer.kind not in ("now", "lasting", "always"):
            return None  # `after a, keep b within 5 s` may ask for one step, or for all of that time
        if answer.kind == "now" and event.text in (f"begins {answer.state.text}", f"begins ({answer.state.text})"):
            return None  # it holds there already
        is_each = phrase in (_EACH if answer.kind == "now" else LASTING)
        return answered(event, answer, is_from_then=phrase in FROM_THEN, is_each=is_each)
    return None


def _unless_first(words: Words) -> Clauses | None:
    """Return the rule of `unless a, never b`."""
    phrase = words.phrase(0, UNLESS)
    for start, stop in _borders(words, len(phrase)) if phrase else ():
        condition, prohibited = condition_of(words[len(phrase) : start]), _prohibited(words[stop:])
        if condition is not None and prohibited is not None:
            return (f"keep {prohibited.at(OR)} implies {condition.at(OR)}",)
    return None


def _borders(words: Words, first: int) -> list[tuple[int, int]]:
    """Return where the condition at the beginning of a sentence may end, and what is asked for may begin."""
    border = words.find(phrases(",", "then", ", then", ":", "=>", "->", "implies"), first)
    if border is not None:
        return [(border[0], border[0] + len(border[1]))]
    keyword = words.find(phrases("reach", "keep", "avoid"), first + 1)
    if keyword is not None:
        return [(keyword[0], keyword[0])]
    ends = [at for at in range(first + 1, len(words)) if words.word(at) not in ("begins", "ends")]
    known = [at for at in ends if condition_of(words[first:at]) is not None and answer_of(words[at:]) is not None]
    return [(known[0], known[0])] if len(known) == 1 else []


def answered(event: State, answer: Answer, *, is_from_then: bool, is_each: bool = False) -> Clauses | None:
    """Return the rule that asks for an answer, if the kind of the condition leaves one reading.

    ``is_from_then`` says that the condition is an event that comes before, ``is_each`` that the answer is about
    the steps with the condition alone.
    """
    is_reached = answer.keyword == "reach"
    conditions = event.text.split(" and ")
    is_ending = answer.state.negated().text in conditions
    if answer.kind == "lasting" and answer.state == event:
        return (f"keep begins {event.at(ATOM)} implies always for {answer.time} {answer.state.at(ATOM)}",)
    if answer.kind == "lasting" and answer.state.negated().text in (event.text, event.text.removeprefix("begins ")):
        return None  # the time may count from the beginning, or from the end
    if answer.state == event and (answer.kind == "always" or (answer.keyword == "keep" and answer.kind == "now")):
        return (f"keep {event.at(OR)} implies always {event.at(ATOM)}",)
    if is_each and answer.kind in ("now", "always") and not is_ending and (answer.keyword or answer.is_negative):
        return (clause_of(event, replace(answer, kind="now")),)
    if answer.state == event or (is_ending and not is_reached and answer.kind not in ("within", "next")):
        return None  # an event that answers itself begins again
    if answer.is_open and not is_ending:
        return None  # `not b within 5 s` may ask for one step without b, or for no step with it
    if is_ending and answer.kind == "within" and answer.is_negative:
        return None  # an event that must not come again
    if is_ending and answer.kind == "within":
        return (f"keep {event.at(OR)} implies eventually within {answer.time} {answer.state.at(ATOM)}",)
    if is_reached and answer.kind == "eventually" and is_from_then:
        return None  # each event needs an answer, or both are goals
    if answer.keyword == "keep" and answer.kind == "now":
        # Without `after`, b may have to hold at that step alone. A count is that of all steps.
        is_clear = is_from_then and not COUNTED.intersection(answer.state.text.replace("(", " ").split())
        return (clause_of(event, replace(answer, kind="always")),) if is_clear else None
    if is_from_then and answer.kind == "now" and not answer.state.text.startswith("(not "):
        return None  # at that step, or from then on
    if not is_from_then and answer.kind == "always":
        return None  # always while the condition holds, or from then on
    return (clause_of(event, answer),)


def _condition_last(words: Words) -> Clauses | None:
    """Return the rule of a sentence that ends with its condition: `a only if b`, `b within 5 s after a`."""
    words = words.without(SUBJECTS)
    for known, read in (
        (ONLY_AFTER, _only_after),
        (ONLY_WHEN, _only_when),
        (UNLESS, _unless),
        (phrases("iff", "if and only if", "exactly when", "exactly if"), _exactly_when),
        (UNTIL, _until),
        ((*SAME_STEP, *FROM_THEN, ("of",)), _whenever),
        (phrases("on", "at", "in"), _never_at),
    ):
        found = words.find_last(known)
        if found is None or not found[0] or words.time(found[0] + len(found[1])):
            continue
        left, right = words[: found[0]], condition_of(words[found[0] + len(found[1]) :])
        clauses = None if right is None else read(left, right, found[1])
        if clauses is not None:
            return clauses
    return None


def _subject(words: Words) -> State | None:
    """Return what a rule is about, without words such as `must` and `keep` around it."""
    words = words.without([*SUBJECTS, *MODALS, ("keep",)])
    end = words.find_last([*MODALS, *((*modal, "be") for modal in MODALS), *phrases("can", "may", "can be", "may be")])
    if end is not None and end[0] and end[0] + len(end[1]) == len(words):
        words = words[: end[0]]
    return state_of(words)


def _only_after(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    state = _subject(left)
    if state is not None and right.text.startswith("time_holding("):
        begun = state.text if state.text.startswith("begins ") else f"begins {state.at(ATOM)}"
        return (f"keep {begun} implies {right.at(OR)}",)  # `once` would forget when that was
    return None if state is None else (f"keep {state.at(OR)} implies once {right.at(ATOM)}",)


def _only_when(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    state = _subject(left)
    return None if state is None else (f"keep {state.at(OR)} implies {right.at(OR)}",)


def _unless(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    prohibited = _prohibited(left)
    if prohibited is not None:
        return (f"keep {prohibited.at(OR)} implies {right.at(OR)}",)
    state = _subject(left)
    return None if state is None or not _is_rule(left) else (f"keep {state.at(OR)} or {right.at(OR)}",)


def _exactly_when(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    state = _subject(left)
    return None if state is None else (f"keep {state.at(OR)} iff {right.at(OR)}",)


def _until(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    """Return the rule of `no a until b`; `a until b` has two readings, as b may have to come or not."""
    prohibited = _prohibited(left)
    if prohibited is None or (left.word(0) in ("avoid", "forbid", "prevent") and phrase != ("before",)):
        return None
    return (f"require {prohibited.negated().at(ATOM)} weak_until {right.at(ATOM)}",)


def _whenever(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    """Return the rule of `b if a`, `never b while a`, `b within 5 s after a`."""
    is_from_then = phrase in FROM_THEN or phrase == ("of",)
    prohibited = _prohibited(left)
    if prohibited is not None and prohibited.text.startswith("time_holding("):
        return None  # the time may count only while the condition holds
    if prohibited is not None:
        answer = Answer("always" if is_from_then else "now", prohibited.negated())
        return None if phrase == ("of",) else answered(right, answer, is_from_then=is_from_then)
    if left.word(0) in ("reach", "avoid", "require"):
        return None
    found = answer_of(left)
    if phrase in _EITHER and is_event(left):
        return None  # a goal, or a rule
    if found is None or (phrase == ("of",) and found.kind != "within"):
        return None
    return answered(right, found, is_from_then=is_from_then)


def _never_at(left: Words, right: State, phrase: tuple[str, ...]) -> Clauses | None:
    """Return the rule of `no a on lap 5`."""
    prohibited = _prohibited(left)
    return None if prohibited is None else answered(right, Answer("now", prohibited.negated()), is_from_then=False)


def _prohibited(words: Words) -> State | None:
    """Return what a sentence forbids: `never a`, `a must not happen`, `no a allowed`."""
    words = words.without(SUBJECTS)
    phrase = words.phrase(0, PROHIBITIONS)
    if phrase and (phrase != ("no",) or words.find_last([("no",)]) == (0, phrase)):
        rest = words[len(phrase) :]
        end = rest.find(phrases("allowed", "permitted", "ever", "at all", "at any time", "at any point"))
        if end is not None and end[0] and end[0] + len(end[1]) == len(rest):
            rest = rest[: end[0]]
        holding = holding_of(rest)
        if holding is not None and holding[1] not in (">", ">="):
            return None  # it may not hold all that time, or not at any step of it
        state = condition_of(rest)
        # `never a or b` may go on with another rule.
        return state if state is None or state.level == ATOM or rest.find_last(AT_ONCE) else None
    found = words.find([*PROHIBITIONS, *((*verb, *word) for verb in phrases("is", "are") for word in phrases("never"))])
    if found is None or not found[0]:
        return None
    rest = words[found[0] + len(found[1]) :]
    verb = rest.phrase(0, [*COPULAS, *AT_ONCE, *phrases("occur", "be allowed", "be true", "allowed", "permitted")])
    if found[1] == ("no",):
        return None
    if len(verb) == len(rest) or rest.without([*COPULAS, ("occur",)]).text in map(" ".join, AT_ONCE):
        return state_of(words[: found[0]])
    # `health never drops below 20`: the comparison after `never` is what is forbidden.
    left = words[: found[0]].without([*SUBJECTS, ("keep",)])
    copula = left[-1:].phrase(0, COPULAS)
    left = left[: len(left) - len(copula)]
    return state_of(left.followed_by(rest.without(COPULAS))) if is_value(left) else None


def _is_rule(words: Words) -> bool:
    """Whether words say that they are a rule, as `keep` does, and `must` or `always` after what they are about."""
    words = words.without(SUBJECTS)
    found = words.find([*MODALS, *ALWAYS])
    return words.word(0) in ("keep", "ensure", "assert", "invariant") or (found is not None and found[0] > 0)


def _unconditional(words: Words) -> Clauses | None:
    """Return a rule about every step: a prohibition, a bound of a count, of a time or of a value."""
    words = words.without(SUBJECTS)
    for limited in (bounded_count(words), bounded_time(words)):
        if limited is not None:
            return limited
    prohibited = _prohibited(words)
    if prohibited is not None and not (words.find(phrases("and", "or")) and words.find(NEVER, 1)):
        return (f"avoid {prohibited.text}",)
    if len(words) == 3 and words[0].text.startswith("times(") and words[1].text in ("<", "<=") and words.number(2):
        return (f"keep {words.text}",)
    return _kept(words)


def _kept(words: Words) -> Clauses | None:
    """Return the rule of `a must always hold`, `keep a between 3 and 5`, `all guards must be asleep`."""
    if not _is_rule(words):
        return None
    words = words.without([*MODALS, *phrases("keep", "ensure", "assert", "invariant")])
    is_code = words.has_signs
    if words.word(0) == "that":
        words = words[1:]
    for known in ((*((*modal, *word) for modal in MODALS for word in ALWAYS), *MODALS), ALWAYS):
        found = words.find_last(known)
        if found is not None:
            words = words[: found[0]].followed_by(words[found[0] + len(found[1]) :])
    state = state_of(words)
    # `keep a and b is not true` has several readings.
    is_one = state is not None and (state.level in (ATOM, RULE) or is_code or words.find([("between",)]))
    return (f"keep {state.text}",) if state is not None and is_one else None
