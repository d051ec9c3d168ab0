"""What the rules about stretches of play mean: between two events, at least every 5 s, or at most once in 5 s."""

from __future__ import annotations

from math import ceil
from typing import Final

from tltlc.core.record import record, replace
from tltlc.grammar.english.answers import is_negative
from tltlc.grammar.english.events import Counted, Event, Held, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Goals, Reading, Rules, When, are_simple, begun_text, never_held, not_again
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.changes import keeps_values
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_MOST_COUNTED: Final = 2
"""The most events between two others that a clause counts."""
_MOST_TOTAL: Final = 6
"""The most steps of a total that a clause counts."""

_Found = Reading | list[Reading] | None


@record
class Every:
    """A condition that holds at least every so often."""

    state: State
    duration: Duration


@record
class Span:
    """A stretch of play from one event to the next other one, or to the next of its kind."""

    start: State
    end: State


class Intervals(Rules):
    """The meanings of the rules about stretches of play."""

    # Between two events.

    def span(self, start: State, end: State) -> Span:
        return Span(start, end)

    def span_of_two(self, number: Term, state: State) -> Span | None:
        return Span(state, state) if number.text == "2" else None

    def avoid_between(self, state: State, span: Span) -> _Found:
        return _between(state.negated(), span)

    def between_avoid(self, span: Span, state: State) -> _Found:
        return _between(state.negated(), span)

    def keep_between(self, state: State, span: Span) -> _Found:
        return None if "times(" in state.text else _between(state, span)  # it counts from the first step on

    def between_keep(self, span: Span, state: State) -> _Found:
        return self.keep_between(state, span)

    def count_between(self, counted: Counted, span: Span) -> _Found:
        start, end = span.start, span.end
        if max(counted.state.level, start.level, end.level) > ATOM or not counted.number.isdecimal():
            return None
        number = int(counted.number) + {">": 1, "<": -1}.get(counted.sign, 0)
        is_least, is_most = counted.sign in (">=", ">", "=="), counted.sign in ("<=", "<", "==")
        if not is_least <= number <= _MOST_COUNTED:
            return None
        if is_least and is_most:
            forms = [(_exactly_one(state, start, end), condition) for state, condition in _each_or_begun(counted.state)]
            return [Reading((clause,), condition) for clause, condition in forms] if number == 1 else None
        if is_least and number == 1:
            return Reading((_at_the_end([counted.state], start, end),))
        readings = []
        for state, condition in _each_or_begun(counted.state):
            clause = _at_the_end([state] * number, start, end)
            if is_most:
                seen = _seen([state] * number, start, end)
                clause = f"avoid {state.text} and not {end.at(ATOM)} and {seen.text}"
            readings.append(Reading((clause,), condition))
        return readings

    def between_count(self, span: Span, counted: Counted) -> _Found:
        return self.count_between(counted, span)

    def reach_between(self, goals: Goals, span: Span) -> _Found:
        if len(goals.states) > _MOST_COUNTED or max(span.start.level, span.end.level) > ATOM:
            return None
        return Reading((_at_the_end([*goals.states], span.start, span.end),))

    def between_reach(self, span: Span, goals: Goals) -> _Found:
        return self.reach_between(goals, span)

    def must_come_between(self, state: State, span: Span) -> _Found:
        return self.reach_between(Goals((self.settled.get(state.text, state),)), span)

    def avoid_after_until(self, state: State, start: State, end: State) -> _Found:
        return self.keep_after_until(state.negated(), start, end)

    def keep_after_until(self, state: State, start: State, end: State) -> _Found:
        if max(start.level, end.level) > ATOM or start.text == end.text:
            return None
        return Reading((f"keep {start.at(OR)} implies ({state.at(ATOM)} weak_until {end.at(ATOM)})",))

    def after_until_avoid(self, start: State, end: State, state: State) -> _Found:
        return self.avoid_after_until(state, start, end)

    def after_until_keep(self, start: State, end: State, state: State) -> _Found:
        return self.keep_after_until(state, start, end)

    # Until, at first and at last.

    def until_rule(self, state: State, end: State) -> _Found:
        if not are_simple(end) or not (are_simple(state) or keeps_values(state.text)):
            return None
        a, b = state.at(ATOM), end.at(ATOM)
        return [
            Reading((f"require {a} weak_until {b}",), f"if play may end before `{end.text}`"),
            Reading((f"require {a} until {b}",), f"if `{end.text}` must come"),
        ]

    def until_in_time_rule(self, state: State, duration: Duration, end: State) -> Reading | None:
        """Return the rules of `a until within 2 s b`: b in that time, and a up to it."""
        if is_negative(end) or not are_simple(state, end):
            return None
        until = f"require {state.at(ATOM)} until {end.at(ATOM)}"
        return Reading((f"require eventually within {duration.text} {end.at(ATOM)}", until))

    def until_by_rule(self, state: State, end: State, duration: Duration) -> Reading | None:
        return self.until_in_time_rule(state, duration, end)

    def finally_at_end(self, state: State) -> _Found:
        return [
            Reading((f"require eventually always {state.at(ATOM)}",), "if it must hold at the last step"),
            Reading((f"reach {state.text}",), "if once is enough"),
        ]

    # At least every so often.

    def every(self, state: State, duration: Duration) -> Every | None:
        state = self.settled.get(state.text, state)
        return None if is_negative(state) else Every(state, duration)

    def every_first(self, duration: Duration, state: State) -> Every | None:
        return self.every(state, duration)

    def at_least_every(self, every: Every) -> _Found:
        state, duration = every.state, every.duration
        weak = _never_so_long(state.negated(), duration)
        strong = Reading((f"keep eventually within {duration.text} {state.at(ATOM)}",))
        return _weak_or_strong(weak, strong, f"if `{state.text}` must also hold at the last step")

    def at_least_every_while(self, every: Every, when: When, event: Event) -> _Found:
        condition = as_state(event)
        if condition is None or when not in ("when", "while", "as long as"):
            return None
        if max(condition.level, every.state.level) > OR:
            return None
        duration = every.duration
        weak = _never_so_long(joined([condition, every.state.negated()], "and"), duration)
        answer = joined([every.state, condition.negated()], "or")
        clause = f"keep {condition.at(OR)} implies eventually within {duration.text} {answer.at(ATOM)}"
        return _weak_or_strong(weak, Reading((clause,)), f"if play must not end before `{every.state.text}`")

    def while_at_least_every(self, when: When, event: Event, every: Every) -> _Found:
        return self.at_least_every_while(every, when, event)

    def implied_every(self, event: Event, every: Every) -> _Found:
        return self.at_least_every_while(every, "while", event)

    def never_long_without(self, sign: str, duration: Duration, state: State) -> _Found:
        return never_held(Held(state.negated(), ">", duration)) if sign == "<=" else None

    def avoid_long_without(self, *parts: str | Duration | State) -> _Found:
        sign = parts[0] if isinstance(parts[0], str) else ">="
        duration, state = parts[-2:]
        assert isinstance(duration, Duration)
        assert isinstance(state, State)
        return never_held(Held(state.negated(), sign, duration))

    # At most so often in a time, and so long apart.

    def count_within(self, counted: Counted, duration: Duration) -> _Found:
        if "times(" in counted.state.text:
            return None  # a count of its own
        number = int(counted.number) - (counted.sign == "<") if counted.number.isdecimal() else 0
        if counted.sign in ("<=", "<") and number == 1 and counted.state.level == ATOM:
            return apart(counted.state, duration)
        text = f"times_within({counted.state.text}, {duration.text}) {counted.sign} {counted.number}"
        if counted.sign in ("<=", "<"):
            return Reading((f"keep {text}",))
        self.limits.append(
            f"`times_within({counted.state.text}, {duration.text})` is how often it has begun in the last "
            f"{duration.text}, and no short clause says that it is so often in each of them: the first "
            f"{duration.text} have not passed yet"
        )
        return None

    def reach_number_within(self, number: Term | str, state: State, duration: Duration) -> _Found:
        text = number.text if isinstance(number, Term) else number
        return self.reach_count_within(Counted(state, ">=", text), duration)

    def reach_times_within(self, state: State, number: str, duration: Duration) -> _Found:
        return self.reach_count_within(Counted(state, ">=", number), duration)

    def reach_count_within(self, counted: Counted, duration: Duration) -> _Found:
        state, time = counted.state.text, duration.text
        if counted.sign in ("<=", "<"):
            return self.count_within(counted, duration)
        return [
            Reading((f"reach times_within({state}, {time}) {counted.sign} {counted.number}",), f"in any {time}"),
            Reading(
                (f"require eventually within {time} times({state}) {counted.sign} {counted.number}",),
                f"in the first {time} of play",
            ),
        ]

    def avoid_count_within(self, counted: Counted, duration: Duration) -> _Found:
        sign = {">": "<=", ">=": "<"}.get(counted.sign)
        return None if sign is None else self.count_within(Counted(counted.state, sign, counted.number), duration)

    def avoid_number_within(self, number: Term | str, state: State, duration: Duration) -> _Found:
        text = number.text if isinstance(number, Term) else number
        return self.count_within(Counted(state, "<", text), duration)

    def avoid_times_within(self, state: State, number: str, duration: Duration) -> _Found:
        return self.count_within(Counted(state, "<", number), duration)

    def avoid_more_within(self, state: State, sign: str, number: str, duration: Duration) -> _Found:
        return self.avoid_count_within(Counted(state, sign, number), duration)

    def not_more_often(self, state: State, duration: Duration) -> _Found:
        return self.apart(duration, state)

    def again(self, state: State, duration: Duration) -> _Found:
        return not_again(state, state, duration.text) if state.level == ATOM else None

    def apart_beginnings(self, duration: Duration, one: Term, other: Term) -> _Found:
        begun = f"(begins {one.text})"
        return Reading((f"avoid {begun} then within {duration.text} {begun}",)) if one.text == other.text else None

    def apart_behind(self, *found: Term | State | Duration) -> _Found:
        """Return the readings of `a at least 5 s apart`."""
        *rest, duration = found
        assert isinstance(duration, Duration)
        states = [state for state in rest if isinstance(state, State)]
        return self.apart(duration, *(part for part in rest if not isinstance(part, Duration)), *states)

    def apart(self, duration: Duration, *found: Term | State) -> _Found:
        states = [state for state in found if isinstance(state, State)]
        numbers = [number.text for number in found if isinstance(number, Term)]
        if len({state.text for state in states}) != 1 or states[0].level > ATOM or numbers not in ([], ["2"]):
            return None
        if is_edge(states[0]) and not numbers and not states[1:]:
            return None  # the other end of that time is missing
        return apart(states[0], duration)

    # How long.

    def duration_at_least(self, state: State, sign: Term, duration: Duration) -> _Found:
        if sign.text not in (">", ">="):
            return None
        clause = f"reach time_holding({state.text}) {sign.text} {duration.text}"
        each = replace(self.lasts_at_least(state, duration), condition="if it must last so long each time")
        return [Reading((clause,), "if it must last so long once"), each]

    def durations(self, least: Duration, most: Duration) -> tuple[Duration, Duration]:
        return least, most

    def durations_of_unit(self, least: Term, *rest: Term | Duration) -> tuple[Duration, Duration]:
        most = rest[-1]
        assert isinstance(most, Duration)
        return Duration(least.text, most.unit), most

    def lasts_from_to(self, state: State, least: Duration, most: Duration) -> _Found:
        return self.lasts_between(state, (least, most))

    def lasts_exactly_unless(self, state: State, duration: Duration, event: Event) -> Reading | None:
        """Return the rules of `each a lasts exactly 4 s unless b`, which ends it earlier."""
        excuse = as_state(event)
        if excuse is None or duration.is_steps or not are_simple(state, excuse):
            return None
        a = state.at(ATOM)
        lasting = f"(always for {duration.text} {a}) or ({a} until {excuse.at(ATOM)})"
        return Reading(
            (
                f"keep {begun_text(state)} implies {lasting}",
                f"avoid time_holding({state.text}) > {duration.text} and {excuse.negated().at(ATOM)}",
            )
        )

    def stops_after(self, state: State, duration: Duration, event: State) -> list[Reading] | None:
        """Return the readings of `a ends at most 8 s after the last b`: no later a, or an end after each b."""
        if not are_simple(state, event) or state == event or is_edge(state):
            return None
        time = duration.text
        return [
            Reading(
                (f"keep {state.at(OR)} implies once within {time} {event.at(ATOM)}",),
                f"if `{state.text}` may hold only up to {time} after a `{event.text}`, the last one",
            ),
            Reading(
                (f"keep {event.text} and {state.text} implies eventually within {time} {state.negated().at(ATOM)}",),
                f"if it must have ended once within {time} after each `{event.text}`",
            ),
        ]

    def every_about(self, state: State, duration: Duration, *rest: Term | Duration) -> Reading | None:
        """Return the rules of `a every 10 s +- 1 s`: none earlier, and one by then."""
        slack = rest[-1]
        assert isinstance(slack, Duration)
        if duration.is_steps or slack.is_steps or not are_simple(state) or not self._step_s:
            return None
        steps, spare = round(self.steps(duration), 6), round(self.steps(slack), 6)
        if not 0 < spare < steps - 1 or not steps.is_integer() or not spare.is_integer():
            return None
        begun = begun_text(state)
        return Reading(
            (
                f"avoid ({begun}) then within {int(steps - spare) - 1} steps ({begun})",
                f"keep time_holding(not {begun}) <= {(steps + spare - 2) * self._step_s:.10g} s",
            )
        )

    def lasts_up_to(self, state: State, most: Duration, least: Duration) -> _Found:
        return self.lasts_between(state, (least, most))

    def lasts_between(self, state: State, durations: tuple[Duration, Duration]) -> _Found:
        least, most = durations
        longest = never_held(Held(state, ">", most))
        if longest is None:
            return None
        return Reading((*self.lasts_at_least(state, least).clauses, *longest.clauses))

    def avoid_held_while(self, state: State, sign: str, duration: Duration, when: When, event: Event) -> _Found:
        condition = as_state(event)
        if condition is None or when not in ("when", "while", "as long as", "if") or sign not in (">", ">="):
            return None
        counted = never_held(Held(joined([state, condition], "and"), sign, duration))
        held = as_state(Held(state, sign, duration))
        if counted is None or held is None or condition.level > AND:
            return None
        both = f"avoid {condition.text} and {held.at(AND)}"
        return [
            Reading(counted.clauses, f"if the time counts only while `{condition.text}`"),
            Reading((both,), f"if `{state.text}` may have begun before `{condition.text}`"),
        ]

    def while_avoid_held(self, when: When, event: Event, state: State, sign: str, duration: Duration) -> _Found:
        return self.avoid_held_while(state, sign, duration, when, event)

    def short_while(self, state: State, duration: Duration, when: When, event: Event) -> _Found:
        return self.avoid_held_while(state, ">", duration, when, event)

    def while_short(self, when: When, event: Event, state: State, duration: Duration) -> _Found:
        return self.avoid_held_while(state, ">", duration, when, event)

    def total(self, state: State, sign: str, duration: Duration) -> _Found:
        steps = round(self.steps(duration), 6)
        if sign in ("<=", "<") and 0 < steps <= _MOST_TOTAL:
            number = int(steps) if sign == "<=" else ceil(steps) - 1
            return Reading((f"avoid {' then '.join([state.at(OR)] * (number + 1))}",))
        self.limits.append(
            f"no clause can say for how long `{state.text}` holds in total: let the game add the time up, and supply it"
        )
        return None

    def avoid_total(self, state: State, sign: str, duration: Duration) -> _Found:
        opposite = {">": "<=", ">=": "<"}.get(sign)
        return None if opposite is None else self.total(state, opposite, duration)


def _between(state: State, span: Span) -> Reading | None:
    start, end = span.start, span.end
    if start.level > ATOM or end.level > OR:
        return None
    if start.text == end.text:  # from one to the next
        inside = f"not {start.at(ATOM)} and previously once {start.at(ATOM)}"
        if is_negative(state):
            return Reading((f"avoid {state.negated().at(ATOM)} and {inside}",))
        return Reading((f"keep {inside} implies {state.at(OR)}",))
    return Reading((f"keep {begun_text(start)} implies ({state.at(ATOM)} weak_until {end.at(ATOM)})",))


def is_edge(state: State) -> bool:
    """Whether a condition is the beginning or the end of one."""
    return state.text.startswith(("begins ", "ends "))


def _each_or_begun(state: State) -> list[tuple[State, str]]:
    """Return an event, and its beginning where it may last for several steps, with what tells them apart."""
    if is_edge(state):
        return [(state, "")]
    return [(State(begun_text(state)), "if steps in a row count once"), (state, "if each step counts")]


def _seen(states: list[State], start: State, end: State) -> State:
    """Return that some events came one after the other since the start of a stretch, with no end of it since."""
    no_end = f"not {end.at(ATOM)}"
    began = f"once {start.at(ATOM)}" if start.text == end.text else f"({no_end} since {start.at(ATOM)})"
    seen = State(f"previously {began}")
    for state in states:
        seen = State(f"previously ({no_end} since ({state.at(AND)} and {no_end} and {seen.text}))")
    return seen


def _exactly_one(state: State, start: State, end: State) -> str:
    """Return the clause that asks for one event from each start of a stretch to its end, if that comes."""
    no_more = f"weak_next (not {state.at(ATOM)} weak_until {end.at(ATOM)})"
    one = f"{state.at(AND)} and not {end.at(ATOM)} and {no_more}"
    none = f"(not {state.at(ATOM)} and not {end.at(ATOM)})"
    return f"keep {start.at(OR)} implies weak_next ({none} weak_until ({one}))"


def _at_the_end(states: list[State], start: State, end: State) -> str:
    """Return the clause that asks, at each end of a stretch, for events in it."""
    if len(states) == 1 and start.text == end.text and not is_edge(end) and end.level == ATOM:
        begun = begun_text(end)
        inside = joined([states[0], State(f"not {begun}")], "and")
        came = f"previously (not {begun} since {inside.at(ATOM)})"
        return f"keep {begun} and previously once {end.at(ATOM)} implies {came}"
    if len(states) == 1 and _is_gap(start, end):
        state = changing(end)
        inside = joined([states[0], state.negated()], "and")
        came = f"previously ({state.negated().at(ATOM)} since {inside.at(ATOM)})"
        return f"keep {end.at(AND)} and previously once {state.at(ATOM)} implies {came}"
    return f"keep {end.at(AND)} and {_seen([], start, end).text} implies {_seen(states, start, end).text}"


def _is_gap(start: State, end: State) -> bool:
    """Whether a stretch goes from `ends a` to `begins a`, and so has all steps without a."""
    is_edge_pair = start.text.startswith("ends ") and end.text.startswith("begins ")
    return is_edge_pair and changing(start) == changing(end)


def _never_so_long(state: State, duration: Duration) -> Reading | None:
    """Return the rule that a condition holds for less than a time: with `within`, the step at its end counts."""
    if not duration.is_steps:
        return Reading((f"keep time_holding({state.text}) < {duration.text}",))
    return never_held(Held(state, ">", duration))


def _weak_or_strong(weak: Reading | None, strong: Reading, condition: str) -> _Found:
    if weak is None:
        return None
    return [Reading(weak.clauses, "if play may end in the middle of that time"), Reading(strong.clauses, condition)]


def changing(edge: State) -> State:
    """Return the condition of which an edge is the beginning or the end."""
    return State(edge.text.partition(" ")[2])


def apart(state: State, duration: Duration) -> list[Reading]:
    """Return the readings of `at least 5 s between two a`, for one that may last, or for each step."""
    readings = []
    for event, condition in _each_or_begun(state):
        text = f"({event.text})" if is_edge(event) else event.text
        readings.append(Reading((f"avoid {text} then within {duration.text} {text}",), condition))
    return readings
