"""What rules about changes of numbers mean, and how numbers are compared with their values at other steps."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.events import Event, Held, as_state
from tltlc.grammar.english.quantities import (
    MIRRORED,
    Change,
    Duration,
    Number,
    begun,
    changed_value,
    comparison,
    share_of,
)
from tltlc.grammar.english.rules import LASTING, Reading, Rules, When, all_readings, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.changes import keeps_values
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_ONE_WAY: Final = re.compile(r"(\w+) (<=|>=) previous\(\1\)")
"""A number that never rises, or never falls."""

_Found = Reading | list[Reading] | None


class Changes(Rules):
    """The meanings of the rules about changes of numbers."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._kept_enums: set[str] = set()
        """The conditions that an enum keeps its value."""

    def cannot_vary(self, term: Term, change: Change) -> _Found:
        if change in ("rises", "falls"):
            return self.only_changes(term, "falls" if change == "rises" else "rises")
        state = self.changes(term, "stays") if change == "varies" else None
        return None if state is None else Reading((f"keep {state.text}",))

    def change_of_number(self, term: Term) -> State | None:
        """Return the condition of `the last change of x`."""
        return self.changes(term, "varies")

    def keep_change(self, term: Term, change: Change, sign: str, step: Number) -> _Found:
        """Return the rule of `coins change by at most 3`, from each step to the next."""
        state = self._limited_change(term, change, sign, step)
        return None if state is None else Reading((f"keep {state.text}",))

    def keep_change_below(self, term: Term, change: Change, sign: str, step: Number, *_: Duration) -> _Found:
        return self.keep_change(term, change, {">": "<=", ">=": "<"}.get(sign, ""), step)

    def change_limited(self, term: Term, change: Change, sign: str, step: Number) -> Asked | None:
        """Return the answer of `health falls by at most 20`."""
        state = self._limited_change(term, change, sign, step)
        return None if state is None else Asked(Answer("now", state))

    def _limited_change(self, term: Term, change: Change, sign: str, step: Number) -> State | None:
        before = f"previous({term.text})"
        if sign in ("<", "<=") and change == "varies":
            share = share_of(term, step)
            most = step.text if share is None else f"{share:g} * {before}"
            return State(f"abs({term.text} - {before}) {sign} {most}")
        if sign not in ("<", "<=") or change not in ("falls", "rises"):
            return None
        relation = MIRRORED[sign] if change == "falls" else sign
        return State(f"{term.text} {relation} {changed_value(term, before, change, step)}")

    def cannot_stay(self, term: Term, sign: str, duration: Duration) -> _Found:
        before = f"previous({term.text})"
        state = State(f"{term.text} <= {before} and {term.text} >= {before}", AND)
        return self.avoid(Held(state, sign, duration))

    def some_only_when(self, term: Term, event: Event) -> _Found:
        is_from_0 = term.declared is not None and term.declared.ends[:1] == ("0",)
        return self.only_when(State(f"{term.text} > 0"), event) if is_from_0 else None

    def no_number(self, term: Term) -> State | None:
        is_from_0 = term.declared is not None and term.declared.ends[:1] == ("0",)
        return comparison(Number(term.text, term), "==", Number("0")) if is_from_0 else None

    def never_both_ways(
        self, term: Term, first: Change, second: Change, sign: str, step: Number, *during: State
    ) -> _Found:
        """Return the rule of `lap never falls and never rises by more than 1`, perhaps with `while a`."""
        kept = self.not_changing(term, first)
        limited = self._limited_change(term, second, {">": "<=", ">=": "<"}.get(sign, ""), step)
        if kept is None or limited is None or first == second:
            return None
        both = joined([kept, limited], "and")
        return _compared_while(during[0], both) if during else Reading((f"keep {both.text}",))

    def only_changes(self, term: Term, change: Change) -> _Found:
        sign = {"rises": ">=", "falls": "<="}.get(change)
        return None if sign is None else Reading((f"keep {term.text} {sign} previous({term.text})",))

    def only_changes_by(self, term: Term, change: Change, step: Number) -> _Found:
        one_way = self.only_changes(term, change)
        sign, operator, back = (">", "+", "<=") if change == "rises" else ("<", "-", ">=")
        if not isinstance(one_way, Reading):
            return None
        now, before = term.text, f"previous({term.text})"
        if term.kind != "INT":
            return Reading((*one_way.clauses, f"keep {now} {back} {before} {operator} {step.text}"))
        exactly = f"{now} == {before} {operator} {step.text}"
        other = "falls" if change == "rises" else "rises"
        return [
            Reading((f"keep {now} == {before} or {exactly}",), f"if it never {other}"),
            Reading((f"keep {now} {sign} {before} implies {exactly}",), f"if it may {other[:-1]}, too"),
        ]

    def cannot_compare(self, left: Number, sign: str, right: Number) -> _Found:
        state = comparison(left, sign, right)
        return None if state is None else Reading((f"keep {state.negated().text}",))

    def cannot_stay_compared(self, left: Number, sign: str, right: Number, held: str, duration: Duration) -> _Found:
        """Return the rule of `x is never below 20 for more than 10 s`."""
        state = comparison(left, sign, right)
        return None if state is None else self.avoid(Held(state, held, duration))

    def falls_but_never(self, term: Term, limit: Number, sign: str, never: Number) -> _Found:
        return self._reached_but_never(term, "<", limit, sign, never)

    def rises_but_never(self, term: Term, limit: Number, sign: str, never: Number) -> _Found:
        return self._reached_but_never(term, ">", limit, sign, never)

    def _reached_but_never(self, term: Term, reached: str, limit: Number, sign: str, never: Number) -> _Found:
        kept = self.cannot_compare(Number(term.text, term), sign, never)
        goal = comparison(Number(term.text, term), reached, limit)
        if goal is None or not isinstance(kept, Reading):
            return None
        return Reading((f"reach {goal.text}", *kept.clauses))

    # Numbers that stay the same while something holds.

    def enum_stays(self, name: Term, before: Term | None = None) -> State | None:
        state = super().enum_stays(name, before)
        self._kept_enums |= set() if state is None else {state.text}
        return state

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        same = self._same_while(when, event, answers)
        return same or self._changed_since(event, answers, lambda asked: super(Changes, self).first(when, event, asked))

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        same = self._same_while(when, event, answers)
        return same or self._changed_since(event, answers, lambda asked: super(Changes, self).last(asked, when, event))

    def implies(self, event: Event, answers: list[Asked]) -> _Found:
        return self._changed_since(event, answers, lambda asked: super(Changes, self).implies(event, asked))

    def _implied_by(self, event: State, answers: list[Asked]) -> _Found:
        return super().implies(event, answers)

    def _changed_since(self, event: Event, answers: list[Asked], rule: Callable[[list[Asked]], _Found]) -> _Found:
        """Return the rule; `when a, b rises by 3 within 2 s` may be about one step, or about all since a."""
        state, answer = as_state(event), answers[0].answer
        made, found = self.changes_by_amounts.get(answer.state.text), rule(answers)
        if made is None or state is None or answer.kind != "within" or answers[1:]:
            return found
        begun = State(begun_text(state))
        # A number with fractions seldom changes by exactly so much.
        if made.sign == "==" and made.term.kind == "REAL":
            made = replace(made, sign=">=")
        since = made.compared_with(f"value_at({made.term.text}, {begun.text})")
        asked = None if since is None else replace(answers[0], answer=replace(answer, state=since))
        whole = None if asked is None else _only(self._implied_by(begun, [asked]))
        of_step = _only(found)
        if whole is None or of_step is None:
            return found
        before = made.compared_with(f"value_at(previous({made.term.text}), {begun.text})")
        earlier = None
        if before is not None:
            earlier = _only(self._implied_by(begun, [replace(answers[0], answer=replace(answer, state=before))]))
        known = "if it is compared with its value at the step before"
        return [
            replace(whole, condition=f"if it is compared with its value at `{begun.text}`"),
            *([replace(earlier, condition=known)] if earlier is not None else []),
            replace(of_step, condition="if it must change so much from one step to the next"),
        ]

    def implied(self, event: Event, answers: list[Asked]) -> _Found:
        same = None if self.is_again else self._same_while("while", event, answers)
        return same or self.implies(event, answers)

    def _same_while(self, when: When, event: Event, answers: list[Asked]) -> list[Reading] | None:
        """Return the readings of `while a, b stays the same` and `while a, b never falls`: from which step on?"""
        state, asked = as_state(event), answers[0]
        same, kind = asked.answer.state, asked.answer.kind
        is_kept = kind in ("now", "always") and not asked.is_formula and asked.answer.keyword != "reach"
        is_same = same.text in self._kept_enums or keeps_values(same.text) or _ONE_WAY.fullmatch(same.text)
        if when not in LASTING or state is None or answers[1:] or not is_kept or not is_same:
            return None
        if state.text.startswith(("begins ", "ends ")) or "previous" in state.text:
            return None  # a change has no steps within
        return _compared_while(state, same)

    def last_in_value(self, answers: list[Asked], value: Term) -> _Found:
        """Return the readings of `tax is constant in spring`, where one enum has the value."""
        name = self.enum_of(value)
        state = None if name is None else self.enum(name, value)
        return None if state is None else self.last(answers, "while", state)

    def in_value_first(self, value: Term, answers: list[Asked]) -> _Found:
        return self.last_in_value(answers, value)

    def at_condition(self, state: State, answers: list[Asked]) -> _Found:
        return self._same_while("while", state, answers) or self.first("when", state, answers)

    def last_in(self, answers: list[Asked], state: State) -> _Found:
        """Return the readings of `hp above 10 in storm`."""
        return self.last(answers, "while", state)

    # Values at other steps.

    def sum_before(self, number: Number, duration: Duration) -> Number | None:
        """Return the value of a sum so long ago, as in `(x - y) 5 s ago`."""
        return None if number.term is None else self.value_before(Term(number.term.kind, number.text), duration)

    def absolute_before(self, number: Number, duration: Duration) -> Number | None:
        size = self.absolute(number)
        return None if size is None else self.sum_before(size, duration)

    def compared_with_value_before(self, term: Term, sign: str, duration: Duration) -> State | None:
        before = self.value_before(term, duration)
        return None if before is None else comparison(Number(term.text, term), sign, before)

    def apart_from_value_before(self, term: Term, step: Number, sign: str, duration: Duration) -> State | None:
        before = self.value_before(term, duration)
        if before is None:
            return None
        operator, relation = ("+", ">=") if sign == ">" else ("-", "<=")
        return comparison(Number(term.text, term), relation, Number(f"{before.text} {operator} {step.text}", term))

    def compared_with_initial(self, term: Term, sign: str) -> State | None:
        return comparison(Number(term.text, term), sign, self.initial(term))

    # Values at events.

    def moment(self, event: State) -> State:
        return begun(event)

    def last_moment(self, event: State) -> State:
        return event

    def end_moment(self, event: State) -> State:
        return State(f"ends {event.at(ATOM)}")

    def value_moment(self, value: Term) -> State | None:
        """Return the step at which an enum takes a value: `at the start of shift`."""
        name = self.enum_of(value)
        return None if name is None else self.enum_begins(name, value)

    def enum_moment(self, name: Term) -> State | None:
        return self.enum_varies(name)

    def value_at_value(self, term: Term, value: Term) -> Number | None:
        event = self.value_moment(value)
        return None if event is None else self.value_at_last(term, event)

    def value_before_event(self, term: Term, event: State) -> Number | None:
        previous = f"previous({term.text})"
        return None if term.text.startswith("previous(") else self.value_at(Term(term.kind, previous), event)

    def compared_with_value_at(self, term: Term, sign: str | Term, moment: State) -> State | None:
        value = self.value_at_last(term, moment)
        operator = sign if isinstance(sign, str) else sign.text
        return None if value is None else comparison(Number(term.text, term), operator, value)

    def not_compared_with_value_at(self, term: Term, sign: str, moment: State) -> State | None:
        state = self.compared_with_value_at(term, sign, moment)
        return None if state is None else state.negated()

    def not_compared_with_value(self, left: Number, sign: str, right: Number) -> State | None:
        state = self.compared(left, sign, right) if "value_at(" in right.text else None
        return None if state is None else state.negated()

    def more_than_at(self, term: Term, moment: State) -> State | None:
        return self.compared_with_value_at(term, ">", moment)

    def less_than_at(self, term: Term, moment: State) -> State | None:
        return self.compared_with_value_at(term, "<", moment)

    def as_at(self, sign: str, term: Term, moment: State) -> State | None:
        return self.compared_with_value_at(term, sign, moment)

    def as_many_as_at(self, term: Term, moment: State) -> State | None:
        return self.compared_with_value_at(term, ">=", moment)

    def equal_to_value_at(self, term: Term, moment: State) -> State | None:
        return self.compared_with_value_at(term, "==", moment)

    def returned(self, term: Term, moment: State) -> State | None:
        """Return the condition of `hp is back to what it was when the fight began`."""
        state = self.equal_to_value_at(term, moment)
        if state is not None:
            self.returning[state.text] = moment
        return state

    def near_value_at(self, term: Term, step: Number, *rest: Term | State) -> State | None:
        moment = rest[-1]
        assert isinstance(moment, State)
        value = self.value_at_last(term, moment)
        if value is None or any(isinstance(part, Term) and part.text != term.text for part in rest):
            return None
        return comparison(Number(f"abs({term.text} - {value.text})", term), "<=", step)

    def value_after_event(self, term: Term, event: Term, sign: str | Term, own: Term) -> _Found:
        """Return the rule of `score after the level >= score when it began`."""
        begun_ = State(f"begins {event.text}")
        state = self.compared_with_value_at(term, sign, begun_) if own.text == term.text else None
        return None if state is None else Reading((f"keep ends {event.text} implies {state.at(OR)}",))

    def highest(self, term: Term) -> Number:
        return Number(f"highest({term.text})", term)

    def lowest(self, term: Term) -> Number:
        return Number(f"lowest({term.text})", term)

    # How far two numbers are apart.

    def distance(self, one: Number, other: Number) -> Number | None:
        """Return what `the distance between x and y` is."""
        return None if one.text == other.text else self.absolute(self.arithmetic(one, Term("MINUS", "-"), other))

    def apart_by(self, one: Term, other: Term, sign: str, limit: Number) -> State | None:
        distance = self.distance(Number(one.text, one), Number(other.text, other))
        return None if distance is None else comparison(distance, sign, limit)

    def never_apart_by(self, one: Term, other: Term, sign: str, limit: Number) -> State | None:
        state = self.apart_by(one, other, sign, limit)
        return None if state is None else state.negated()

    # Several numbers.

    def unless(self, answers: list[Asked], event: Event) -> _Found:
        """Return the rule of `keep x and y unchanged unless a`, whose exception is about all of them."""
        asked, exception = answers[0], as_state(event)
        same = asked.answer.state
        is_kept = asked.answer.kind == "now" and not asked.is_formula and asked.answer.keyword != "reach"
        if answers[1:] or not is_kept or exception is None or not keeps_values(same.text):
            return super().unless(answers, event)
        return Reading((f"keep {same.at(ATOM)} or {exception.at(OR if exception.level == OR else ATOM)}",))

    def number_names(self, *terms: Term) -> list[tuple[Term, ...]]:
        return [terms]

    def one_number(self, term: Term, *values: Term) -> State | None:
        states = [comparison(Number(term.text, term), "==", Number(value.text)) for value in values]
        return joined([state for state in states if state is not None], "or")

    def at_most_value(self, left: Number, limit: Number) -> State | None:
        return comparison(left, "<=", limit)

    def at_least_value(self, left: Number, limit: Number) -> State | None:
        return comparison(left, ">=", limit)

    def not_changing(self, term: Term, change: Change) -> State | None:
        """Return the condition of `x does not fall`."""
        sign = {"falls": ">=", "rises": "<="}.get(change)
        return None if sign is None else State(f"{term.text} {sign} previous({term.text})")

    def all_change(self, terms: tuple[Term, ...], change: Change) -> State | None:
        return _all([self.changes(term, change) for term in terms])

    def all_stay(self, *terms: Term) -> State | None:
        return self.all_change(terms, "stays")

    def all_compared(self, terms: tuple[Term, ...], sign: str, limit: Number) -> State | None:
        return _all([comparison(Number(term.text, term), sign, limit) for term in terms])

    def all_in_comparison(self, terms: tuple[Term, ...], sign: Term, limit: Number) -> State | None:
        return self.all_compared(terms, sign.text, limit)


def _all(states: list[State | None]) -> State | None:
    known = [state for state in states if state is not None]
    return joined(known, "and") if len(known) == len(states) else None


def _only(found: _Found) -> Reading | None:
    """Return the reading of a rule that has one."""
    readings = all_readings(found)
    return readings[0] if len(readings) == 1 and not readings[0].condition else None


def _compared_while(state: State, compared: State) -> list[Reading]:
    """Return the readings of a rule that compares a number with its value before while something holds."""
    within = joined([state, State(f"previously {state.at(ATOM)}")], "and")
    return [
        Reading((f"keep {within.at(OR)} implies {compared.at(OR)}",), f"within each `{state.text}`"),
        Reading((f"keep {state.at(OR)} implies {compared.at(OR)}",), "also from the step before it begins"),
    ]
