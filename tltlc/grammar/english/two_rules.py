"""What two rules in one line mean, and rules about two events: `no a for more than 5 s and keep b while c`."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.conditions import Members
from tltlc.grammar.english.events import Counted, Event, Held, as_state
from tltlc.grammar.english.intervals import Intervals, changing, is_edge
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, When, are_simple, begun_text, never_held, not_again
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined

_MOST_PAIRS: Final = 6
"""The most rules that one sentence stands for."""
_Found = Reading | list[Reading] | None


class TwoRules(Intervals):
    """The meanings of two rules in one line, of the time between two events, and of an answer at one of two steps."""

    # A rule with a time, and one with a condition.

    def held_rule(self, state: State, sign: str, duration: Duration) -> Held | None:
        return Held(state, sign, duration) if sign in (">", ">=") else None

    def short_rule(self, state: State, duration: Duration) -> Held:
        return Held(state, ">", duration)

    def held_rule_and_conditional(self, held: Held, state: State, when: When, event: Event) -> _Found:
        """Return the readings of `no a for more than 5 s and keep b while c`: c is for b alone, or for both."""
        condition, first, second = as_state(event), never_held(held), self._kept_while(state, when, event)
        if condition is None or first is None or second is None:
            return None
        alone = Reading((*first.clauses, *second.clauses), f"if `{condition.text}` is for `{state.text}` alone")
        both = never_held(replace(held, state=joined([held.state, condition], "and")))
        if both is None or is_edge(condition):
            return Reading(alone.clauses)
        return [alone, Reading((*both.clauses, *second.clauses), "if it is for both rules")]

    def conditional_and_held_rule(self, state: State, when: When, event: Event, held: Held) -> Reading | None:
        first, second = self._kept_while(state, when, event), never_held(held)
        return None if first is None or second is None else Reading((*first.clauses, *second.clauses))

    def _kept_while(self, state: State, when: When, event: Event) -> Reading | None:
        """Return the rule of `keep b while c` if it has one reading."""
        rule = self.last([self.keep_now(state)], when, event)
        return rule if isinstance(rule, Reading) and not rule.condition else None

    # How often something happens, and a condition.

    def number_and(self, sign: str, number: Term, state: State, condition: State) -> Reading | None:
        """Return the rules of `at most 5 a and b`, where b does not say which a count."""
        limit = self.limit_count(Counted(state, sign, number.text))
        if not isinstance(limit, Reading) or sign not in ("<=", "<"):
            return None
        return Reading((*limit.clauses, f"keep {condition.text}"), f"if `{condition.text}` must hold at every step")

    def avoid_several(self, members: Members) -> Reading | None:
        """Return the rules of `never more than one of a, b and c`: one for each two of them."""
        states = members.states
        pairs = [joined([a, b], "and") for at, a in enumerate(states) for b in states[at + 1 :]]
        return Reading(tuple(f"avoid {pair.text}" for pair in pairs)) if len(pairs) <= _MOST_PAIRS else None

    def reach_one_of_two(self, one: State, other: State) -> _Found:
        """Return the rules of `reach either a or b but never both`, if that is about all of play."""
        if max(one.level, other.level) > ATOM:
            return None
        either, both = (joined([one, other], operator).text for operator in ("or", "and"))
        return [
            Reading((f"reach {either}", f"avoid {both}"), "if both must never hold together"),
            Reading((f"keep {one.text} iff {other.negated().text}",), "if one of them must hold at every step"),
        ]

    def at_end_without(self, state: State, absent: State) -> list[Reading]:
        """Return the readings of `finish with a and no b`: at the last step alone, or at every step."""
        both = joined([state, absent], "and").at(ATOM)
        at_end, never = f"require eventually always {state.at(ATOM)}", f"avoid {absent.negated().text}"
        return [
            Reading((f"require eventually always {both}",), "if all of it is about the last step"),
            Reading((at_end, never), f"if `{absent.negated().text}` must never hold"),
        ]

    def no_two_until(self, when: When, event: Event, one: State, other: State, end: State) -> Reading | None:
        """Return the rule of `after a, no b and no c until d`."""
        state = as_state(event)
        if state is None or not are_simple(one.negated(), other.negated(), end):
            return None
        both = joined([one.negated(), other.negated()], "or").text
        return Reading((f"keep {state.at(OR)} implies (not ({both}) weak_until {end.at(ATOM)})",))

    def implies_no_two_until(self, event: Event, one: State, other: State, end: State) -> Reading | None:
        return self.no_two_until("when", event, one, other, end)

    def neither_until(self, one: State, other: State, end: State) -> Reading | None:
        if not are_simple(one.negated(), other.negated(), end):
            return None
        either = joined([one.negated(), other.negated()], "or").text
        return Reading((f"require not ({either}) weak_until {end.at(ATOM)}",))

    def no_two_for(self, when: When, event: Event, one: State, other: State, duration: Duration) -> Reading | None:
        """Return the rules of `after a, no b and no c for 5 s`; a itself may be one of them, and come again later."""
        state = as_state(event)
        if state is None or duration.is_steps or not are_simple(one.negated(), other.negated()):
            return None
        clauses: list[str] = []
        for denied in (one.negated(), other.negated()):
            if begun_text(denied) == begun_text(state):
                clauses += not_again(state, denied, duration.text)[0].clauses
            else:
                clauses.append(f"keep {state.at(OR)} implies always for {duration.text} not {denied.at(ATOM)}")
        return Reading(tuple(clauses), "if the time is for both")

    def implies_no_two_for(self, event: Event, one: State, other: State, duration: Duration) -> Reading | None:
        return self.no_two_for("when", event, one, other, duration)

    # The time between two events.

    def apart(self, duration: Duration, *events: Term | State) -> _Found:
        """Return the readings of `at least 3 s between a and b`: from a to b, or in either order."""
        states = [state for state in events if isinstance(state, State)]
        if len({state.text for state in states}) < 2 or any(state.level > ATOM for state in states):
            return super().apart(duration, *events)
        first, second = states
        if is_edge(first) and is_edge(second) and changing(first) == changing(second):
            is_pause = first.text.startswith("ends ")
            pause = Reading((_free_after(first, second, duration),))
            return pause if is_pause else self.lasts_at_least(changing(first), duration)
        begun, following = State(begun_text(first)), State(begun_text(second))
        from_first, from_second = _free_after(begun, following, duration), _free_after(following, begun, duration)
        readings = [Reading((from_first,), f"from `{begun.text}` to a later `{following.text}`")]
        if not is_edge(first):
            ended = State(begun.text.replace("begins ", "ends ", 1))
            from_end = _free_after(ended, following, duration)
            readings.append(Reading((from_end,), f"from `{ended.text}` to a later `{following.text}`"))
        return [*readings, Reading((from_first, from_second), "if either may come first")]

    def apart_each(self, duration: Duration, *events: Term | State) -> _Found:
        """Return the readings of `at least 3 s between each begins a`, which is about two of its kind."""
        return self.apart(duration, *events, events[-1])

    # An answer at this step or the next.

    def now_or_next_unless(self, state: State, following: State, event: Event) -> list[Asked] | None:
        """Return the answers of `b or next b unless c`: c counts at this step, or at the next one, too."""
        exception = as_state(event)
        if exception is None:
            return None
        later = f"next {joined([following, exception], 'or').at(ATOM)}"
        either = f"{state.at(OR)} or next {following.at(ATOM)} or {exception.at(OR)}"
        also_later = f"{state.at(OR)} or {exception.at(OR)} or {later}"
        what = f"if `{exception.text}`"
        return [
            Asked(Answer("now", State(either, OR)), f"{what} counts at the step of the condition", is_formula=True),
            Asked(Answer("now", State(also_later, OR)), f"{what} at the next step is enough, too", is_formula=True),
        ]


def _free_after(event: State, other: State, duration: Duration) -> str:
    """Return the clause that another event comes neither at the step of an event nor in a time after it."""
    return f"keep {event.text} implies always for {duration.text} not ({other.text})"
