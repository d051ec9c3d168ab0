"""What rules about stretches of steps mean: how long a condition holds, how often, and within which time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tltlc.core.record import replace
from tltlc.grammar.english.answers import MOST_STEPS, Asked, is_negative
from tltlc.grammar.english.events import Counted, Event, Held, as_state
from tltlc.grammar.english.intervals import Intervals
from tltlc.grammar.english.orders import Orders
from tltlc.grammar.english.quantities import Duration, Number, comparison
from tltlc.grammar.english.rules import Goals, Reading, When, all_readings, are_simple, begun_text, never_held
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined

_Found = Reading | list[Reading] | None


class Stretches(Intervals, Orders):
    """The meanings of the rules about stretches of steps with a condition, and about what happens in a time."""

    # How long each stretch lasts.

    def cannot_last(self, state: State, sign: str, duration: Duration) -> _Found:
        if sign in ("<", "<="):
            return self.lasts_at_least(state, duration) if sign == "<" else None
        return self.avoid(Held(state, sign, duration))

    def lasts_less(self, state: State, duration: Duration) -> _Found:
        return self.avoid(Held(state, ">=", duration))

    def must_stop_each(self, state: State, duration: Duration) -> _Found:
        stretch = self.keep_short(state, duration)
        return stretch if isinstance(stretch, Reading) else None

    def reached_in_time(self, left: Number, right: Number, duration: Duration) -> _Found:
        """Return the goal of `laps must reach 3 within 60 s`."""
        return each_reading(reached_states(left, right), lambda goal: self.reach_within(goal, duration))

    def must_be_reached(self, left: Number, right: Number) -> _Found:
        """Return the goal of `coins must reach 50`."""
        return each_reading(reached_states(left, right), lambda goal: Reading((f"reach {goal.text}",)))

    def comes_within(self, left: Number, right: Number, duration: Duration) -> list[Asked]:
        """Return the answer of `when a, coins must reach 50 within 3 s`."""
        return [
            replace(asked, condition=condition)
            for goal, condition in reached_states(left, right)
            if isinstance(asked := self.within(goal, duration), Asked)
        ]

    def gone_in_time(self, term: Term, duration: Duration) -> Reading:
        """Return the goal of `the shield is gone within 5 s`."""
        return Reading((f"require eventually within {duration.text} not {term.text}",))

    def avoid_straight(self, state: State, duration: Duration) -> Reading | None:
        """Return the rule of `never a for 3 steps in a row`."""
        return never_held(Held(state, ">=", duration))

    def must_stop(self, state: State, duration: Duration) -> _Found:
        stretch = self.keep_short(state, duration)
        if not isinstance(stretch, Reading):
            return None
        return [
            replace(stretch, condition="for each time"),
            Reading((f"require eventually within {duration.text} {state.negated().at(ATOM)}",),
                    "if the time counts from the first step"),
        ]  # fmt: skip

    def lasts_exactly(self, state: State, duration: Duration) -> _Found:
        if self.steps(duration) <= MOST_STEPS:
            return super().lasts_exactly(state, duration)
        return self.lasts_between(state, (duration, duration))

    def hold(self, state: State, *rest: str | Duration) -> _Found:
        goal, each = self._held_goal(state, rest), self.lasts_at_least(state, _duration(rest))
        if goal is None or not isinstance(each, Reading):
            return None
        return [Reading(goal, "if once is enough"), Reading(each.clauses, "for each time")]

    def hold_without(self, state: State, *rest: str | Duration | State) -> _Found:
        avoided = rest[-1]
        assert isinstance(avoided, State)
        goal = self._held_goal(joined([state, avoided.negated()], "and"), rest[:-1])
        return None if goal is None else Reading(goal)

    def _held_goal(self, state: State, rest: tuple[str | Duration | State, ...]) -> tuple[str, ...] | None:
        sign = rest[0] if isinstance(rest[0], str) else ""
        if sign in ("<", "<="):
            return None
        reading = self.reach(Goals((held,))) if (held := as_state(Held(state, sign, _duration(rest)))) else None
        return reading.clauses if isinstance(reading, Reading) else None

    # The first time of play.

    def avoid_first(self, state: State, duration: Duration) -> _Found:
        return Reading((f"require always for {duration.text} {state.negated().at(ATOM)}",))

    def first_avoid(self, duration: Duration, state: State) -> _Found:
        return self.avoid_first(state, duration)

    def keep_first(self, state: State, duration: Duration) -> _Found:
        return Reading((f"require always for {duration.text} {state.at(ATOM)}",))

    def first_keep(self, duration: Duration, state: State) -> _Found:
        return self.keep_first(state, duration)

    def first_all(self, duration: Duration, *states: State) -> _Found:
        """Return the reading of several rules for the first seconds: `in the first 5 s no a, no b and c`."""
        text = f"require always for {duration.text} {joined([*states], 'and').at(ATOM)}"
        is_negative_last = is_negative(states[-1])
        return Reading((text,), "if it is for all of them" if is_negative_last else "")

    def count_and_only_when(self, counted: Counted, event: Event) -> Reading | None:
        """Return the rules of `a at most once and only when b`."""
        condition, sign = as_state(event), counted.sign or "<="
        if condition is None or sign not in ("<", "<="):
            return None
        count = f"keep times({counted.state.text}) {sign} {counted.number}"
        return Reading((count, f"keep {counted.state.at(OR)} implies {condition.at(OR)}"))

    def count_and_time(self, counted: Counted, sign: str, duration: Duration) -> Reading | None:
        """Return the rules of `a at most 3 times and never for longer than 1 s`."""
        held = as_state(Held(counted.state, sign, duration))
        if held is None or counted.sign not in ("<", "<=") or sign not in (">", ">="):
            return None
        return Reading((f"keep times({counted.state.text}) {counted.sign} {counted.number}", f"avoid {held.text}"))

    def reach_within_and(self, state: State, duration: Duration, other: State) -> list[Reading]:
        """Return the readings of `reach a within 5 s and b`: both at one step, or each at its own."""
        both = joined([state, other], "and").at(ATOM)
        first = f"require eventually within {duration.text} {state.at(ATOM)}"
        until = Reading(
            (first, f"require {other.at(ATOM)} until {state.at(ATOM)}"), f"if `{other.text}` must hold until then"
        )
        return [
            *([until] if is_negative(other) else []),
            Reading((f"require eventually within {duration.text} {both}",), "if all of it must hold at one step"),
            Reading((first, f"reach {other.text}"), f"if `{other.text}` may come at another step"),
        ]

    def stays_until(self, event: State, end: State) -> Reading:
        """Return the rule of `once a begins, it stays on until b`."""
        state = self.settled.get(event.text, event)
        return Reading((f"keep {begun_text(state)} implies ({state.at(ATOM)} weak_until {end.at(ATOM)})",))

    def stays_for(self, event: State, duration: Duration) -> Reading:
        """Return the rule of `once a begins, it stays on for 3 s`."""
        state = self.settled.get(event.text, event)
        return Reading((f"keep {begun_text(state)} implies always for {duration.text} {state.at(ATOM)}",))

    def without_first(self, state: State, *rest: str | Duration | list[Asked]) -> Reading | list[Reading] | None:
        """Return the rule of `without a for 8 s, b within 2 s`."""
        *parts, answers = rest
        event = self.held(state.negated(), *(part for part in parts if isinstance(part, (str, Duration))))
        return None if event is None or not isinstance(answers, list) else self.first("when", event, answers)

    def denial(self, state: State) -> State:
        return state.negated()

    def sometime(self, event: Event) -> _Found:
        state = as_state(event)
        return None if state is None or is_negative(state) else self.reach(Goals((state,)))

    # What is counted while something else holds.

    def counted_while(self, state: State, number: str, during: State) -> Counted | None:
        """Return how often a condition begins while another one holds."""
        if state.text.startswith("not ") or state.level > ATOM:
            return None
        begun = State(f"({begun_text(state)})")
        return Counted(joined([begun, during], "and"), "", number)

    def reach_counted(self, counted: Counted, *events: Event) -> _Found:
        return self.bare_goals(counted, *events)

    # Answers.

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        answer = answers[0].answer
        if isinstance(event, State) and event.text == answer.state.text and answer.kind == "now" and not answers[1:]:
            answers = [Asked(replace(answer, kind="always"))]  # once it holds, it stays so
        return super().first(when, event, answers)

    def each_within(self, event: Event, state: State, duration: Duration) -> _Found:
        asked = self.within(state, duration)
        return self.first("each", event, [asked]) if isinstance(asked, Asked) else None

    def twice_conditional(
        self, when: When, event: Event, when_too: When, event_too: Event, answers: list[Asked]
    ) -> _Found:
        one, other = as_state(event), as_state(event_too)
        if one is None or other is None or "after" in (when, when_too) or when_too == "while":
            return None
        return self.first(when_too, joined([one, other], "and"), answers)

    def followed_by(self, event: Event, answers: list[Asked]) -> _Found:
        if any(asked.answer.kind == "now" and not asked.is_formula for asked in answers):
            return None  # at the same step, or later
        return self.first("when", event, answers)

    def settles(self, state: State, duration: Duration, value: Term | None = None) -> Asked | None:
        """Return the answer of `a within 3 s and stay so`."""
        if value is not None and value.text not in state.text.split():
            return None
        formula = State(f"eventually within {duration.text} always {state.at(ATOM)}")
        return Asked(Answer("now", formula), is_formula=True)

    def settles_first(self, duration: Duration, state: State) -> Asked | None:
        return self.settles(state, duration)

    # Rules that forbid two conditions.

    def neither(self, one: State, other: State) -> State:
        return joined([one.negated(), other.negated()], "and")

    def when_neither(self, when: When, event: Event, state: State) -> _Found:
        return _kept(when, event, state)

    def neither_when(self, state: State, when: When, event: Event) -> _Found:
        condition = as_state(event)
        return _kept(when, event, state, "" if condition is None else f"if `{condition.text}` is a condition of both")

    def not_both(self, one: State, other: State) -> list[tuple[State, str]]:
        """Return both readings of `no a and b`, with what tells them apart."""
        return [
            (joined([one, other], "and").negated(), f"if `{one.text}` and `{other.text}` must not hold together"),
            (joined([one.negated(), other], "and"), f"if `{one.text}` must not hold, and `{other.text}` must"),
        ]

    def when_not_both(self, when: When, event: Event, forbidden: tuple[State, str]) -> _Found:
        return _kept(when, event, *forbidden)

    def not_both_when(self, forbidden: tuple[State, str], when: When, event: Event) -> _Found:
        return _kept(when, event, *forbidden)


def _duration(parts: tuple[object, ...]) -> Duration:
    return next(part for part in parts if isinstance(part, Duration))


def _kept(when: When, event: Event, state: State, what: str = "") -> Reading | None:
    """Return the rule that a condition holds at the steps of an event, or from the first of them on."""
    condition = as_state(event)
    if condition is None or not are_simple(condition):
        return None
    answer = f"always {state.at(ATOM)}" if when == "after" else state.at(OR)
    return Reading((f"keep {condition.at(OR)} implies {answer}",), what)


def reached_states(number: Number, limit: Number) -> list[tuple[State, str]]:
    """Return the condition that a number has reached a limit, and where it comes from if both ways are possible."""
    ends = number.ends
    signs: tuple[tuple[str, str], ...]
    if limit.text in ends and limit.text != (*ends, "")[1]:
        signs = (("<=", ""),)
    elif limit.text in ends:
        signs = ((">=", ""),)
    else:
        signs = (
            (">=", f"if `{number.text}` comes to it from below"),
            ("<=", f"if `{number.text}` comes to it from above"),
        )
    states = ((comparison(number, sign, limit), condition) for sign, condition in signs)
    return [(state, condition) for state, condition in states if state is not None]


def each_reading(goals: Sequence[tuple[State, str]], rule: Callable[[State], _Found]) -> list[Reading]:
    """Return the readings of a rule about each of several goals, which come with conditions."""
    readings: list[Reading] = []
    for goal, condition in goals:
        for reading in all_readings(rule(goal)):
            both = " and ".join(filter(None, (condition, reading.condition)))
            readings.append(replace(reading, condition=both))
    return readings
