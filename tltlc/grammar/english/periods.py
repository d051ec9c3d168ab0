"""What rules about periods mean: how often something happens since an event, or in each mode."""

from __future__ import annotations

from typing import Final

from tltlc.grammar.english.events import Counted, Event
from tltlc.grammar.english.intervals import Intervals
from tltlc.grammar.english.quantities import Change, Duration, Number
from tltlc.grammar.english.rules import Reading, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, State, joined

_MOST_COUNTED: Final = 3
"""The most events of a period that a clause counts."""

_Found = Reading | list[Reading] | None


class Periods(Intervals):
    """The meanings of the rules about what happens since an event, or in each period of its kind."""

    def count_since(self, counted: Counted, event: State) -> _Found:
        """Return the rule of `at most 2 jumps since landed`: the count begins anew at each step with the event."""
        reading = self._counted(counted, event, is_while=False)
        return None if reading is None else Reading(reading.clauses)

    def times_since(self, times: Term, event: State, sign: Term, number: Term) -> _Found:
        counted = _counted(times, sign.text, number)
        return None if counted is None else self.count_since(counted, event)

    def count_in_each(self, counted: Counted, period: State) -> _Found:
        """Return the readings of `at most 2 pings per dive`: each step with it may begin a period, or all be one."""
        is_edge = period.text.startswith(("begins ", "ends "))
        since = None if " is " in period.text else self._counted(counted, period, is_while=False)
        during = None if is_edge else self._counted(counted, period, is_while=True)
        readings = [reading for reading in (since, during) if reading is not None]
        return Reading(readings[0].clauses) if len(readings) == 1 else readings or None

    def times_in_each(self, times: Term, sign: Term, number: Term, period: State) -> _Found:
        counted = _counted(times, sign.text, number)
        return None if counted is None else self.count_in_each(counted, period)

    def _counted(self, counted: Counted, event: State, *, is_while: bool) -> Reading | None:
        number = int(counted.number) - (counted.sign == "<") if counted.number.isdecimal() else 0
        if counted.sign not in ("<=", "<") or number < 1 or max(counted.state.level, event.level) > ATOM:
            return None
        if number > _MOST_COUNTED:
            self.limits.append(
                f"no clause can say that `{counted.state.text}` happens at most {number} times since `{event.text}`: "
                f"let the game count since then, and supply the number"
            )
            return None
        begun = State(begun_text(counted.state))
        going_on = event if is_while else event.negated()
        one = joined([begun, going_on], "and")
        seen = one if is_while else begun
        for _ in range(number):
            seen = State(f"{one.at(AND)} and previously ({going_on.at(ATOM)} since {seen.at(ATOM)})", AND)
        condition = (
            f"if it counts while `{event.text}` holds" if is_while else f"if each `{event.text}` begins a new count"
        )
        return Reading((f"avoid {seen.text}",), condition)

    def change_since(self, term: Term, change: Change, *rest: str | Number | State) -> None:
        event = rest[-1]
        assert isinstance(event, State)
        self.value_at(term, Term("BOOL", event.text))

    def value_at_state(self, term: Term, event: State) -> None:
        self.value_at(term, Term("BOOL", event.text))

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


def _counted(times: Term, sign: str, number: Term) -> Counted | None:
    """Return what `times(p) <= 2` counts."""
    name, bracket, inner = times.text.partition("(")
    if name != "times" or not bracket:
        return None
    text = inner[:-1].strip()
    return Counted(State(text if text.isidentifier() else f"({text})"), sign, number.text)
