"""What rules about periods mean: how often something happens since an event or in each wave, and by how much."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.differences import Period
from tltlc.grammar.english.events import Counted, Event, as_state
from tltlc.grammar.english.intervals import Span, is_edge
from tltlc.grammar.english.quantities import IT, Duration, begun, counted_by
from tltlc.grammar.english.rules import Reading, When, all_readings, are_simple, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.english.totals import Totals, without_brackets
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_COMPARED: Final = re.compile(r"(times\(.*\)) (<=|<|>=|>) (\d+)")
_MOST_COUNTED: Final = 10
"""The highest number that the rule of `every third a` names."""
_WHILE: Final = ("while", "as long as", "when")

_Found = Reading | list[Reading] | None


class Periods(Totals):
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

    def counted_within(self, state: State, *rest: str | Duration) -> State:
        """Return the condition of `three hits within 5 s`: how often it has begun in the last 5 s."""
        *sign, number, duration = rest
        assert isinstance(number, str) and isinstance(duration, Duration)
        counted = state.text.removeprefix("begins ")
        return State(f"times_within({counted}, {duration.text}) {sign[0] if sign else '>='} {number}")

    def counted_first_within(self, *parts: str | Term | State | Duration) -> State:
        *sign, number, state, duration = parts
        assert isinstance(state, (State, Term)) and isinstance(duration, Duration)
        text = number if isinstance(number, str) else number.text
        signs = [part for part in sign if isinstance(part, str)]
        return self.counted_within(State(state.text), *signs, text, duration)

    # Since an event.

    def count_since(self, counted: Counted, event: State) -> _Found:
        """Return the rule of `at most 2 jumps since landed`: the count begins anew at each step with the event."""
        return _limited_since(counted, event)

    def since_count(self, event: State, counted: Counted) -> _Found:
        return self.count_since(counted, event)

    def bool_since(self, term: Term, event: State, sign: Term, number: Term) -> _Found:
        return self.count_since(Counted(State(term.text), sign.text, number.text), event)

    def avoid(self, event: Event) -> _Found:
        if isinstance(event, State) and event.text.startswith("times_within("):
            return None  # `avoid 3 hits within 5 s` is a rule about a count
        if isinstance(event, State) and event.text.startswith(("times_since(", "total_time(")):
            return Reading((f"keep {event.negated().text}",))
        return super().avoid(event)

    def avoid_count_since(self, counted: Counted, event: State) -> _Found:
        avoided = _avoided(counted)
        return None if avoided is None else self.count_since(avoided, event)

    # In each period.

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
            start = period.event.at(OR)
            if "previous(" not in start:  # which holds only where a period has ended
                start = f"{period.event.at(AND)} and previously once {period.event.at(ATOM)}"
            return Reading((f"keep {start} implies previously ({state.text})",))
        return Reading((f"keep ends {period.state.at(ATOM)} implies previously ({state.text})",))

    def most_in_each(self, number: Term, term: Term, period: Period) -> _Found:
        return self.count_in_each(Counted(State(term.text), "<=", number.text), period)

    def number_in_each(self, *parts: Term | str | Period) -> _Found:
        """Return the readings of `one attack per jump`: at most one, or at least one."""
        number = next(_number(part) for part in parts if _number(part))
        term, period = next(part for part in parts if isinstance(part, Term) and part.kind == "BOOL"), parts[-1]
        assert isinstance(period, Period)
        most = self.count_in_each(Counted(State(term.text), "<=", number), period)
        least = self._least_in_each(Counted(State(term.text), ">=", number), period)
        known = most if isinstance(most, list) else [most] if isinstance(most, Reading) else []
        if not known or not isinstance(least, Reading):
            return None
        also = f", and {known[0].condition.removeprefix('if ')}" if known[0].condition else ""
        return [
            replace(known[0], condition=f"if at most {number}{also}"),
            replace(least, condition=f"if at least {number}, asked for where one ends"),
        ]

    def count_without_between(self, state: State, number: str, avoided: State) -> _Found:
        """Return the goal of `jump 3 times without landing in between`: no step from the first to the last has it."""
        if max(state.level, avoided.level) > ATOM or is_negative(state) or begun_text(state) == begun_text(avoided):
            return None
        counted = joined([State(f"({begun_text(state)})"), avoided.negated()], "and")
        return Reading((f"reach times_since({counted.text}, {avoided.text}) >= {number}",))

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
            return None if period is None else self.count_in_each(counted, period)
        one = joined([State(f"({begun_text(counted.state)})"), state], "and")
        together = self.limit_count(Counted(one, counted.sign, counted.number))
        inside = _while(counted, state)
        if not isinstance(together, Reading) or inside is None:
            return None
        return [
            replace(inside, condition=f"if each `{state.text}` begins a new count"),
            replace(together, condition=f"if all steps with `{state.text}` count together"),
        ]

    def so_often_while(self, term: Term, number: str, state: State) -> _Found:
        """Return the readings of `jump twice while airborne`: a goal in one stretch or in all of them, or a limit."""
        counted = Counted(State(term.text), ">=", number)
        goal, limit = _while(counted, state), _while(replace(counted, sign="<="), state)
        together = self.limit_count(Counted(State(f"(begins {term.text}) and {state.at(AND)}", AND), ">=", number))
        if goal is None or limit is None or not isinstance(together, Reading) or number == "1" or state.level > ATOM:
            return None
        return [
            replace(goal, condition=f"if it is a goal, in one stretch with `{state.text}`"),
            replace(together, condition=f"if it is a goal, and all steps with `{state.text}` count together"),
            replace(limit, condition=f"if no more are allowed in each stretch with `{state.text}`"),
        ]

    def while_count(self, when: When, event: Event, counted: Counted) -> _Found:
        return self.count_while(counted, when, event)

    def count_implied(self, event: Event, *answers: State | Counted) -> _Found:
        """Return the readings of `keep a implies b at most once`: b counts from the first step, or from each a."""
        *states, counted = answers
        state, limit = as_state(event), self.limit_count(counted) if isinstance(counted, Counted) else None
        if state is None or not isinstance(limit, Reading) or not isinstance(counted, Counted):
            return None
        others = self.count_while(counted, "while", state)
        if counted.sign not in ("<=", "<") or limit.clauses[0].startswith("avoid ") or not isinstance(others, list):
            return None
        at_start = f"keep {state.at(OR)} implies {limit.clauses[0].removeprefix('keep ')}"
        readings = [Reading((at_start,), "if the count begins with the first step"), *others]
        if not states:
            return readings if counted.state.level <= ATOM else None
        asked = joined([part for part in states if isinstance(part, State)], "and")
        first = f"keep {state.at(OR)} implies {asked.text}"
        return [replace(reading, clauses=(first, *reading.clauses)) for reading in readings]

    def count_in(self, counted: Counted, state: State) -> _Found:
        return self.count_while(counted, "while", state)

    def avoid_count_in(self, counted: Counted, state: State) -> _Found:
        return self.avoid_count_while(counted, "while", state)

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        """Return the readings of `times(hit) <= 3 while airborne`; changes are rules, and no goals."""
        text = answers[0].answer.state.text
        readings = super().last(answers, when, event)
        if not isinstance(readings, list) or when != "while":
            return readings
        if text.startswith("times(") and (compared := _COMPARED.fullmatch(text)) and not answers[1:]:
            counted = self.times_compared(
                Term("INT", compared[1]), Term("SIGN", compared[2]), Term("NUMBER", compared[3])
            )
            return None if counted is None else self.count_while(counted, when, event)
        is_change = "previous(" in text or "value_at(" in text
        return [reading for reading in readings if not (is_change and reading.clauses[0].startswith("reach "))]

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

    def each_nth(self, number: str, term: Term, answers: list[Asked]) -> list[Reading]:
        """Return the rule of `every third a is followed by b`, which counts up to a last one."""
        numbers = range(int(number), _MOST_COUNTED + 1, int(number))
        counted = joined([State(f"times({term.text}) == {each}") for each in numbers], "or")
        event = joined([State(f"begins {term.text}"), counted], "and")
        readings = all_readings(self.first("when", event, answers))
        last = f"up to number {numbers[-1]}: no clause counts for ever"
        return [replace(one, condition=" and ".join(filter(None, (one.condition, last)))) for one in readings]

    def answers_of_each_nth(self, answers: list[Asked], number: str, term: Term) -> list[Reading]:
        return self.each_nth(number, term, answers)

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

    def when_count_before(self, when: When, event: Event, counted: Counted, end: State) -> _Found:
        """Return the rule of `after a, at most 2 b before c`: each beginning of a begins a new count."""
        start = as_state(event)
        if start is None or begun(start).text in (begun(end).text, begun(counted.state).text):
            return None
        return self.count_between(counted, Span(start, end))

    def implied_count_before(self, event: Event, counted: Counted, end: State) -> _Found:
        return self.when_count_before("when", event, counted, end)

    def count_before_when(self, counted: Counted, end: State, when: When, event: Event) -> _Found:
        return self.when_count_before(when, event, counted, end)

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

    def counts_twice(self, state: State, first: str, least: str, second: str, most: str) -> tuple[Counted, Counted]:
        return Counted(state, first, least), Counted(state, second, most)

    def numbers_twice(self, first: str, least: Term, second: str, most: Term, term: Term) -> tuple[Counted, Counted]:
        return self.counts_twice(State(term.text), first, least.text, second, most.text)

    def counts_between(self, counts: tuple[Counted, Counted], span: Span) -> Reading | None:
        """Return the rules of `a at least once and at most 3 times between two b`."""
        return _both_of([self.count_between(counted, span) for counted in counts])

    def counts_from_to(self, counts: tuple[Counted, Counted]) -> Reading | None:
        """Return the rules of `a at least once and at most 3 times`, of which the first is a goal."""
        least, most = counts
        if least.sign not in (">", ">=") or most.sign not in ("<", "<="):
            return None
        goal = Reading((f"reach times({least.state.text}) {least.sign} {least.number}",))
        return _both_of([goal, self.limit_count(most)])

    # Answers to what happens so often.

    def number_counted(self, number: Term, term: Term) -> Counted:
        return Counted(State(term.text), "", number.text)

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        if isinstance(event, Counted):
            return self._after_several(when, event, answers)
        if not isinstance(event, State):
            return super().first(when, event, answers)
        event, named = self._of_it(when, event, answers)
        return super().first(when, event, named)

    def _of_it(self, when: When, event: State, answers: list[Asked]) -> tuple[State, list[Asked]]:
        """Return the event of a rule, and the answers with its name for `it`, which may have begun and ended."""
        base = event.text.removeprefix("ends ").removeprefix("begins ")
        named = [
            replace(asked, answer=replace(asked.answer, state=_with_name(asked.answer.state, base)))
            for asked in answers
        ]
        is_own = any(f", begins {base})" in asked.answer.state.text and not asked.is_formula for asked in named)
        return (State(f"ends {base}") if is_own and when == "after" and base == event.text else event), named

    def _after_several(self, when: When, event: Counted, answers: list[Asked]) -> _Found:
        """Return the readings of `when jump twice, land within 5 s`: each time, or once."""
        answer = answers[0].answer
        is_clear = event.sign in ("", ">=") and event.number != "1" and when != "while"
        again = _times_since(replace(event, sign=">="), answer.state)
        if not is_clear or answers[1:] or answer.kind != "within" or again is None or is_negative(answer.state):
            return super().first(when, event, answers)
        asked = f"eventually within {answer.time} {answer.state.at(ATOM)}"
        return [
            Reading((f"keep {again.text} implies {asked}",), f"if each `{answer.state.text}` begins a new count"),
            Reading((f"keep begins (times({event.state.text}) >= {event.number}) implies {asked}",),
                    "if it counts from the first step on, and asks for it once"),
        ]  # fmt: skip

    # Goals and rules with a second event.

    def avoid_then_without(self, first: State, second: State, between: State) -> _Found:
        """Return the readings of `avoid a then a without b`: a second a, which may last, or a second step with it."""
        if max(first.level, second.level) > ATOM:
            return None
        again = f"previously (not {between.at(ATOM)} since {first.at(ATOM)})"
        second_step = Reading((f"avoid {second.at(AND)} and {again}",))
        if first != second or is_edge(first):
            return second_step
        count = Reading((f"keep times_since({first.text}, {between.text}) <= 1",), "if steps in a row count once")
        return [count, replace(second_step, condition="if each step counts")]

    def avoid_then_within_without(
        self, first: State, duration: Duration, second: State, between: State
    ) -> Reading | None:
        """Return the rule of `avoid a then within 3 s b without c in between`; it looks back from b."""
        steps = round(self.steps(duration), 6)
        if not are_simple(first, second, between) or not steps.is_integer() or steps < 2:
            return None
        if not duration.is_steps and not self._step_s:
            return None
        came = f"previously (not {between.at(ATOM)} since {first.at(ATOM)})"
        recent = f"previously once within {int(steps) - 1} steps {first.at(ATOM)}"
        return Reading((f"avoid {second.at(AND)} and {came} and {recent}",))

    def reach_count_without(self, counted: Counted, between: State) -> _Found:
        """Return the readings of `reach a 3 times without b`: none up to the third, between them, or at all."""
        goal, since = (
            f"times({counted.state.text}) >= {counted.number}",
            _times_since(replace(counted, sign=">="), between),
        )
        if since is None or between.level > ATOM:
            return None
        until = f"require {between.negated().at(ATOM)} until {goal}"
        return [
            Reading((until,), f"if `{between.text}` must not come before the last of them"),
            Reading((f"reach {since.text}",), f"if `{between.text}` must not come between them"),
            Reading((f"reach {goal}", f"avoid {between.text}"), f"if `{between.text}` must never come"),
        ]

    def avoid_after_without(self, second: State, first: State, between: State) -> _Found:
        return self.avoid_then_without(first, second, between)

    def exactly_after(self, state: State, duration: Duration, event: Event) -> _Found:
        asked = self.delayed(state, duration)
        return None if asked is None or asked.late is not None else self.first("when", event, [asked])

    def reach_count_before(self, counted: Counted, end: State) -> _Found:
        state = as_state(counted)
        return None if state is None else self.reach_before(state, end)

    def reach_before(self, goal: State, end: State) -> _Found:
        a, b = goal.at(ATOM), end.negated().at(ATOM)
        own, same = joined([goal, end.negated()], "and").at(ATOM), f"`{end.text}` may come at the same step"
        return [
            Reading((f"require {b} until {own}",), f"if it must come, and `{end.text}` neither before it nor with it"),
            Reading((f"require {b} until {a}",), f"if it must come, and {same}"),
            Reading((f"require {b} weak_until {a}",), f"if it need not come, and {same}"),
            Reading((f"reach {goal.at(AND)} then {end.at(AND)}",),
                    f"if `{end.text}` must follow at a later step, and may come earlier, too"),
        ]  # fmt: skip


def _times_since(counted: Counted, event: State) -> State | None:
    """Return the comparison of how often something has begun since an event; None if it always holds, or never."""
    sign, number = counted.sign or ">=", counted.number
    is_trivial = (sign, number) in ((">=", "0"), ("<", "0"), ("<", "1"), ("<=", "0"))
    if not number.isdecimal() or is_trivial or is_negative(counted.state) or counted.state.text == event.text:
        return None
    count = f"times_since({without_brackets(counted.state.text)}, {without_brackets(event.text)})"
    return State(f"{count} {sign} {number}", ATOM, f"{count} {NEGATED_SIGN[sign]} {number}")


def _number(part: Term | str | Period) -> str:
    """Return the text of a number; "" for other parts."""
    return part if isinstance(part, str) else part.text if isinstance(part, Term) and part.kind == "NUMBER" else ""


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


def _with_name(state: State, name: str) -> State:
    """Return a condition with the name of an event for `it`."""
    return State(state.text.replace(IT, name), state.level, state.opposite.replace(IT, name))


def _both_of(rules: Sequence[_Found]) -> Reading | None:
    """Return the clauses of several rules as one reading; None if one of them has none, or several readings."""
    readings = [all_readings(rule) for rule in rules]
    if any(len(known) != 1 or known[0].condition for known in readings):
        return None
    return Reading(tuple(clause for (known,) in readings for clause in known.clauses))
