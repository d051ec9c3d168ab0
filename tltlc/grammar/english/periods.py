"""What rules about periods mean: how often something happens since an event or in each wave, and by how much."""

from __future__ import annotations

from math import ceil
from typing import Final

from tltlc.core.record import record, replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.events import Counted, Event, as_state
from tltlc.grammar.english.intervals import Intervals, Span
from tltlc.grammar.english.quantities import MIRRORED, Change, Duration, Number, begun, comparison, counted_by
from tltlc.grammar.english.rules import Reading, When, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_MOST_TOTAL: Final = 6
"""The most steps of a total of which a clause counts each."""
_WHILE: Final = ("while", "as long as", "when")

_Found = Reading | list[Reading] | None


@record
class Period:
    """Where each period of a kind begins, and what holds in it; nothing that is known for `in each wave`."""

    event: State
    state: State | None = None


@record
class Amount:
    """By how much a number changes: ``hp falls by at most 20``. The sign is empty for ``falls by 20``."""

    term: Term
    change: Change
    sign: str
    step: Number


class Periods(Intervals):
    """The meanings of the rules about what happens since an event, or in each period of its kind."""

    # What is counted.

    def times_compared(self, times: Term, sign: Term, number: Term) -> Counted | None:
        """Return what `times(p) <= 2` counts."""
        counted = counted_by(times)
        return None if counted is None else Counted(counted, sign.text, number.text)

    def most_behind(self, number: Term, term: Term) -> Counted:
        return Counted(State(term.text), "<=", number.text)

    def count_behind(self, state: State | Term, sign: str, number: str | Term) -> Counted:
        counted = State(state.text) if isinstance(state, Term) else state
        return Counted(counted, sign, number.text if isinstance(number, Term) else number)

    def counted_since(self, state: State, *rest: str | State) -> State | None:
        sign, number = rest[0] if len(rest) > 2 else ">=", rest[-2]
        event = rest[-1]
        assert isinstance(sign, str) and isinstance(number, str) and isinstance(event, State)
        return _times_since(Counted(state, sign, number), event)

    def counted_first_since(self, *parts: str | Term | State) -> State | None:
        *sign, number, state, event = parts
        assert not isinstance(state, str) and isinstance(event, State)
        text = number if isinstance(number, str) else number.text
        return self.counted_since(State(state.text), *(part for part in sign if isinstance(part, str)), text, event)

    # Since an event.

    def count_since(self, counted: Counted, event: State) -> _Found:
        """Return the rule of `at most 2 jumps since landed`: the count begins anew at each step with the event."""
        return _limited_since(counted, event)

    def since_count(self, event: State, counted: Counted) -> _Found:
        return self.count_since(counted, event)

    def avoid_count_since(self, counted: Counted, event: State) -> _Found:
        avoided = _avoided(counted)
        return None if avoided is None else self.count_since(avoided, event)

    # In each period.

    def stretch_of(self, state: State) -> Period | None:
        """Return the period of a condition: it begins where the condition does."""
        if state.level > ATOM or is_negative(state):
            return None
        return Period(begun(state), None if begun(state) == state else state)

    def number_period(self, term: Term) -> Period | None:
        """Return the period of a number such as `wave`: one for each of its values."""
        state = self.changes(term, "varies") if term.kind == "INT" and term.declared is not None else None
        return None if state is None else Period(state)

    def enum_period(self, name: Term) -> Period | None:
        state = self.enum_varies(name)
        return None if state is None else Period(state)

    def count_in_each(self, counted: Counted, period: Period) -> _Found:
        """Return the readings of `at most 2 pings per dive`: from each beginning on, or only while it holds."""
        rule = _limited_since(counted, period.event)
        if rule is None or counted.sign not in ("<=", "<"):
            return self._least_in_each(counted, period)
        if period.state is None:
            return rule
        inside = _while(counted, period.state)
        if " is " in period.state.text or inside is None:
            return inside and Reading(inside.clauses)
        return [
            replace(rule, condition=f"if each `{period.event.text}` begins a new count"),
            replace(inside, condition=f"if it counts only while `{period.state.text}` holds"),
        ]

    def _least_in_each(self, counted: Counted, period: Period) -> _Found:
        """Return the rule of `at least 2 pings per dive`, which is asked for where the period ends."""
        state = _times_since(counted, period.event)
        if state is None or counted.sign not in (">=", ">", "=="):
            return None
        if period.state is None:
            start = f"{period.event.at(AND)} and previously once {period.event.at(ATOM)}"
            return Reading((f"keep {start} implies previously ({state.text})",))
        return Reading((f"keep ends {period.state.at(ATOM)} implies previously ({state.text})",))

    def in_each_count(self, period: Period, counted: Counted) -> _Found:
        return self.count_in_each(counted, period)

    def avoid_count_in_each(self, counted: Counted, period: Period) -> _Found:
        avoided = _avoided(counted)
        return None if avoided is None else self.count_in_each(avoided, period)

    # While something holds.

    def count_while(self, counted: Counted, when: When, event: Event) -> _Found:
        state = as_state(event)
        if state is None or when not in (*_WHILE, "each") or state.level > ATOM:
            return None
        if when == "each":
            period = self.stretch_of(state)
            return period and self.count_in_each(counted, period)
        one = joined([State(f"({begun_text(counted.state)})"), state], "and")
        together = self.limit_count(Counted(one, counted.sign, counted.number))
        inside = _while(counted, state)
        if not isinstance(together, Reading) or inside is None:
            return None
        return [
            replace(inside, condition=f"if each `{state.text}` begins a new count"),
            replace(together, condition=f"if all steps with `{state.text}` count together"),
        ]

    def while_count(self, when: When, event: Event, counted: Counted) -> _Found:
        return self.count_while(counted, when, event)

    def times_while(self, times: Term, state: State, sign: Term, number: Term) -> _Found:
        counted = self.times_compared(times, sign, number)
        return None if counted is None else self.count_while(counted, "while", state)

    def avoid_count_while(self, counted: Counted, when: When, event: Event) -> _Found:
        avoided = _avoided(counted)
        return None if avoided is None else self.count_while(avoided, when, event)

    # One of several.

    def four(self) -> str:
        return "4"

    def five(self) -> str:
        return "5"

    def each_nth(self, number: str, term: Term, state: State) -> None:
        self.limits.append(
            f"no clause can say what holds at each {number}th `{term.text}`: let the game count, and supply the number; "
            f"`times({term.text}) == {number}` is about one of play, `times_since({term.text}, q) == {number}` about one "
            "since each `q`"
        )

    # Up to an event.

    def count_until(self, counted: Counted, end: State) -> _Found:
        """Return the readings of `at least 3 pings before a dive`: from the first step on, or from the last dive."""
        if counted.sign not in (">=", ">") or _times_since(counted, end) is None or is_negative(end):
            return None
        since = _times_since(counted, begun(end))
        assert since is not None
        first = f"keep {end.at(OR)} implies times({counted.state.text}) {counted.sign} {counted.number}"
        return [
            Reading((first,), "if it counts from the first step on"),
            Reading((f"keep {begun(end).at(OR)} implies previously ({since.text})",),
                    f"if each `{begun(end).text}` begins a new count"),
        ]  # fmt: skip

    def count_from_to(self, counted: Counted, end: State, start: State) -> _Found:
        return self.count_between(counted, Span(start, end))

    def count_between(self, counted: Counted, span: Span) -> _Found:
        """Return the rule of `at most 2 jumps between two landings`; each one begins a new count."""
        start, end = begun(span.start), span.end
        state, number = _times_since(counted, start), counted.number
        if state is None or max(span.start.level, end.level) > ATOM or is_negative(start) or is_negative(end):
            return None
        if span.start.text != end.text:
            inside = f"(not {end.at(ATOM)} since {start.at(ATOM)})"
            if counted.sign in ("<=", "<"):
                return Reading((f"keep {inside} implies {state.text}",))
            if number == "1":
                return super().count_between(counted, span)
            return Reading((f"keep {begun(end).at(AND)} and previously {inside} implies previously ({state.text})",))
        if counted.sign in ("<=", "<"):
            return _limited_since(counted, end)
        so_far = span.start.at(ATOM).removeprefix("begins ")
        at_next = f"keep {start.at(AND)} and previously once {so_far} implies previously ({state.text})"
        if counted.sign != "==":
            return Reading((at_next,))
        most = _times_since(replace(counted, sign="<="), start)
        assert most is not None
        return Reading((at_next, f"keep once {so_far} implies {most.text}"))

    # By how much a number changes.

    def amount(self, term: Term, change: Change, *rest: str | Number) -> Amount | None:
        step = rest[-1]
        assert isinstance(step, Number)
        return Amount(term, change, rest[0] if isinstance(rest[0], str) else "", step)

    def lost(self, *parts: str | Number | Term) -> Amount | None:
        *sign, step, term = parts
        assert isinstance(term, Term) and isinstance(step, Number)
        return self.amount(term, "falls", *(part for part in sign if isinstance(part, str)), step)

    def gained(self, *parts: str | Number | Term) -> Amount | None:
        found = self.lost(*parts)
        return None if found is None else replace(found, change="rises")

    def change_in(self, amount: Amount, period: Period) -> _Found:
        """Return the rule of `hp falls by at most 20 in each fight`, or of `gain at least 100 score per wave`."""
        value = self.value_at_last(amount.term, period.event)
        if value is None or amount.change not in ("falls", "rises") or not amount.sign:
            return None
        if amount.sign in ("<", "<="):
            rule = _changed(amount, value)
            if rule is None:
                return None
            inside = "" if period.state is None else f"{period.state.at(OR)} implies "
            return Reading((f"keep {inside}{rule.text}",))
        if period.state is not None:
            rule = _changed(amount, value)
            return rule and Reading((f"keep ends {period.state.at(ATOM)} implies {rule.text}",))
        rule = _changed(amount, Number(f"previous({value.text})", value.term))
        return rule and Reading((f"keep {period.event.at(OR)} implies {rule.text}",))

    def change_while(self, amount: Amount, period: Period) -> _Found:
        """Return the readings of `hull falls by at most 15 during a storm`: since it began, or at each step."""
        whole = self.change_in(amount, period)
        if not isinstance(whole, Reading) or period.state is None or amount.sign not in ("<", "<="):
            return whole
        step = _changed(amount, Number(f"previous({amount.term.text})", amount.term))
        assert step is not None
        return [
            Reading(whole.clauses, f"if it counts from where `{period.state.text}` began"),
            Reading((f"keep {period.state.at(OR)} implies {step.text}",), "if at each step"),
        ]

    def while_change(self, period: Period, amount: Amount) -> _Found:
        return self.change_while(amount, period)

    def in_each_change(self, period: Period, amount: Amount) -> _Found:
        return self.change_in(amount, period)

    def avoid_change_in(self, amount: Amount, period: Period) -> _Found:
        sign = {">": "<=", ">=": "<", "": "<"}.get(amount.sign)
        return None if sign is None else self.change_in(replace(amount, sign=sign), period)

    def must_not_change_in(self, term: Term, change: Change, sign: str, step: Number, period: Period) -> _Found:
        return self.avoid_change_in(Amount(term, change, sign, step), period)

    def change_since(self, amount: Amount, event: State) -> _Found:
        value = self.value_at_last(amount.term, event)
        rule = None if value is None else _changed(amount, value)
        if rule is None or not amount.sign:
            return None
        return Reading((f"{'keep' if amount.sign in ('<', '<=') else 'reach'} {rule.text}",))

    # In total.

    def total(self, state: State, sign: str, duration: Duration) -> _Found:
        """Return the rule of `seen at most 30 s in total`; for a few steps, also the one that counts each step."""
        if duration.is_steps or sign not in ("<=", "<", ">=", ">") or is_negative(state) or state.level > AND:
            return super().total(state, sign, duration) if duration.is_steps else None
        keyword = "keep" if sign in ("<=", "<") else "reach"
        whole = Reading((f"{keyword} total_time({state.text}) {sign} {duration.text}",))
        steps = round(self.steps(duration), 6)
        if keyword == "reach" or not 0 < steps <= _MOST_TOTAL:
            return whole
        number = int(steps) if sign == "<=" else ceil(steps) - 1
        return [
            replace(whole, condition="if the first step of each stretch counts 0 s"),
            Reading((f"avoid {' then '.join([state.at(OR)] * (number + 1))}",), "if each step counts"),
        ]

    def total_first(self, sign: str, duration: Duration, state: State) -> _Found:
        return self.total(state, sign, duration)

    # Answers to what happens so often.

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        answer = answers[0].answer
        is_clear = isinstance(event, Counted) and event.sign in ("", ">=") and event.number != "1" and when != "while"
        if not is_clear or not isinstance(event, Counted) or answers[1:] or answer.kind != "within":
            return super().first(when, event, answers)
        again = _times_since(replace(event, sign=">="), answer.state)
        asked = f"eventually within {answer.time} {answer.state.at(ATOM)}"
        if again is None or is_negative(answer.state):
            return super().first(when, event, answers)
        return [
            Reading((f"keep {again.text} implies {asked}",), f"if each `{answer.state.text}` begins a new count"),
            Reading((f"keep begins (times({event.state.text}) >= {event.number}) implies {asked}",),
                    "if it counts from the first step on, and asks for it once"),
        ]  # fmt: skip

    # Goals and rules with a second event.

    def avoid_then_without(self, first: State, second: State, between: State) -> _Found:
        if max(first.level, second.level, between.level) > ATOM:
            return None
        again = f"previously (not {between.at(ATOM)} since {first.at(ATOM)})"
        return Reading((f"avoid {second.at(AND)} and {again}",))

    def avoid_after_without(self, second: State, first: State, between: State) -> _Found:
        return self.avoid_then_without(first, second, between)

    def exactly_after(self, state: State, duration: Duration, event: Event) -> _Found:
        asked = self.delayed(state, duration)
        return None if asked is None else self.first("when", event, [asked])

    def reach_before(self, goal: State, end: State) -> _Found:
        a, b = goal.at(ATOM), end.negated().at(ATOM)
        return [
            Reading((f"require {b} until {a}",), f"if it must come, and `{end.text}` not before it"),
            Reading((f"require {b} weak_until {a}",), "if it need not come"),
            Reading(
                (f"reach {goal.at(AND)} then {end.at(AND)}",), f"if `{end.text}` must follow, and may come earlier, too"
            ),
        ]


def _times_since(counted: Counted, event: State) -> State | None:
    """Return the comparison of how often something has begun since an event; None if it always holds, or never."""
    sign, number = counted.sign or ">=", counted.number
    is_trivial = (sign, number) in ((">=", "0"), ("<", "0"), ("<", "1"), ("<=", "0"))
    if not number.isdecimal() or is_trivial or is_negative(counted.state) or counted.state.text == event.text:
        return None
    count = f"times_since({counted.state.text}, {event.text})"
    return State(f"{count} {sign} {number}", ATOM, f"{count} {NEGATED_SIGN[sign]} {number}")


def _limited_since(counted: Counted, event: State) -> Reading | None:
    state = _times_since(counted, event)
    keyword = {"<=": "keep", "<": "keep", ">=": "reach", ">": "reach"}.get(counted.sign)
    return None if state is None or keyword is None else Reading((f"{keyword} {state.text}",))


def _while(counted: Counted, during: State) -> Reading | None:
    """Return the rule about how often something happens in each stretch of steps with a condition."""
    state = _times_since(counted, begun(during))
    if state is None or counted.sign not in ("<=", "<", ">=", ">"):
        return None
    if counted.sign in ("<=", "<"):
        return Reading((f"keep {during.at(OR)} implies {state.text}",))
    return Reading((f"reach {during.at(AND)} and {state.text}",))


def _avoided(counted: Counted) -> Counted | None:
    """Return what the opposite of a count at least so high counts."""
    sign = {">": "<=", ">=": "<", "": "<"}.get(counted.sign)
    return None if sign is None else replace(counted, sign=sign)


def _changed(amount: Amount, before: Number) -> State | None:
    """Return that a number has changed by so much since it had a value."""
    operator, sign = ("-", MIRRORED[amount.sign]) if amount.change == "falls" else ("+", amount.sign)
    then = Number(f"{before.text} {operator} {amount.step.text}", amount.term)
    return comparison(Number(amount.term.text, amount.term), sign, then)
