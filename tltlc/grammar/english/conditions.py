"""What the conditions of English sentences mean: each function reads one rule of the grammar."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.english.changed_arguments import change_of_enum
from tltlc.grammar.english.events import Counted, Crossing, Event, Held, as_state, joined_events
from tltlc.grammar.english.quantities import Duration, Number, Quantities, begun, comparison
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, RULE, State, joined

_NOTHING: Final = ("none", "nothing", "empty", "idle", "off", "no", "unknown")
"""Values of enums that stand for the absence of a value."""


@record
class Members:
    """The members of a list, as in ``any of a, b``."""

    states: tuple[State, ...]


class Conditions(Quantities):
    """The meanings of the rules for conditions, and for what lasts or is counted."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self.is_again = False
        self.is_before = False
        """Whether the sentence says `again`."""
        self.is_coming = False
        self.edges: frozenset[str] = frozenset()
        """Whether the sentence says `comes`."""
        self._since: dict[str, tuple[State, State]] = {}
        """Maps the texts of conditions such as `a since the last b` to a and b."""
        self.listed: set[str] = set()
        """The conditions such as `a, b or c`."""
        self._recent: dict[str, tuple[State, Duration]] = {}
        """Maps the texts of conditions such as `a in the last 5 s` to a and the time."""
        self.varying: set[str] = set()
        """The conditions that an enum changes."""

    # Bools and enums.

    def named(self, term: Term) -> State:
        return State(term.text)

    def recently(self, term: Term, duration: Duration) -> State:
        recent = State(f"once within {duration.text} {term.text}")
        self._recent[recent.text] = (State(term.text), duration)
        return recent

    def began_recently(self, term: Term, duration: Duration) -> State:
        return State(f"once within {duration.text} begins {term.text}")

    def ended_recently(self, term: Term, duration: Duration) -> State:
        return State(f"once within {duration.text} ends {term.text}")

    def not_named(self, term: Term) -> State:
        return State(term.text).negated()

    def is_true(self, term: Term) -> State:
        self.assigned.add(term.text)
        return State(term.text)

    def is_false(self, term: Term) -> State:
        state = State(term.text).negated()
        self.assigned.add(state.text)
        return state

    def begins(self, term: Term) -> State:
        self.settled[f"begins {term.text}"] = State(term.text)
        return State(f"begins {term.text}")

    def ends(self, term: Term) -> State:
        self.settled[f"ends {term.text}"] = State(term.text).negated()
        return State(f"ends {term.text}")

    def comparison_begins(self, state: State) -> State | None:
        """Return the step at which a comparison becomes true; `coins when a started` is no comparison that starts."""
        return None if "value_at(" in state.text else self.begins_condition(state)

    def comparison_ends(self, state: State) -> State | None:
        return None if "value_at(" in state.text else self.ends_condition(state)

    def begins_condition(self, state: State) -> State:
        edge = State(f"begins ({state.text})")
        self.settled[edge.text] = state
        return edge

    def ends_condition(self, state: State) -> State:
        edge = State(f"ends ({state.text})")
        self.settled[edge.text] = state.negated()
        return edge

    def ever(self, term: Term) -> State:
        return State(f"once {term.text}")

    def previously(self, item: Term | State) -> State:
        return State(f"previously {item.text if isinstance(item, Term) else item.at(ATOM)}")

    def historically(self, state: State) -> State:
        return State(f"historically {state.at(ATOM)}")

    def enum(self, name: Term, *values: Term) -> State | None:
        assert name.declared is not None
        if not all(value.text in name.declared.values for value in values):
            return None
        states = [_is(name, value) for value in values]
        return joined(states, "or")

    def enum_behind(self, value: Term, name: Term) -> State | None:
        return self.enum(name, value)

    def enum_of(self, *values: Term) -> Term | None:
        """Return the only enum that has all these values."""
        texts = {value.text for value in values}
        enums = [
            Term("ENUM", name, declared)
            for name, declared in self._declared.names.items()
            if declared.type == "enum" and texts <= {*declared.values} and not declared.parameters
        ]
        return enums[0] if len(enums) == 1 else None

    def not_enum(self, name: Term, *values: Term) -> State | None:
        state = self.enum(name, *values)
        return None if state is None else state.negated()

    def enum_begins(self, name: Term, *values: Term) -> State | None:
        return self._edge("begins", name, values)

    def enum_ends(self, name: Term, *values: Term) -> State | None:
        return self._edge("ends", name, values)

    def _edge(self, operator: str, name: Term, values: Sequence[Term]) -> State | None:
        states = [self.enum(name, value) for value in values]
        edges = [State(f"{operator} ({state.text})") for state in states if state is not None]
        if len(edges) < len(states):
            return None
        edge, state = joined(edges, "or"), self.enum(name, *values)
        assert state is not None
        self.settled[edge.text] = state if operator == "begins" else state.negated()
        return edge

    def last_enum(self, name: Term, value: Term) -> State | None:
        """Return the condition of `the last note is left`, where an enum has a value for nothing between its values."""
        values = () if name.declared is None else name.declared.values
        others = [other for other in values if other not in (value.text, *_NOTHING)]
        if len(others) > 3 or len(others) > len(values) - 2 or value.text not in values:
            return None
        free = joined([State(f"{name.text} is not {other}") for other in others], "and")
        return State(f"({free.at(ATOM) if others[1:] else f'({free.text})'} since {_is(name, value).text})")

    def enum_left(self, name: Term, before: Term, value: Term) -> State | None:
        """Return the end of a value: `mode was alert and is not alert any more`."""
        return self.enum_ends(name, value) if before.text == value.text else None

    def enum_before(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else State(f"previously ({state.text})")

    def not_enum_before(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else State(f"not previously ({state.text})")

    def enum_varies(self, name: Term, before: Term | None = None) -> State | None:
        if name.declared is None or (before is not None and before.text != name.text):
            return None
        state = State(change_of_enum(name.text, name.declared.values), OR)
        self.varying.add(state.text)
        return state

    def enum_stays(self, name: Term, before: Term | None = None) -> State | None:
        state = self.enum_varies(name, before)
        return None if state is None else state.negated()

    def enum_changes(self, name: Term, start: Term, end: Term) -> State | None:
        before, after = self.enum_before(name, start), self.enum(name, end)
        return None if before is None or after is None else joined([before, after], "and")

    # Several conditions.

    def negation(self, state: State) -> State:
        return state.negated()

    def bracketed(self, event: Event) -> State | None:
        state = as_state(event)
        return state if state is None or state.level == ATOM else State(f"({state.text})")

    def all_of(self, *events: Event) -> list[State]:
        return self._of_all(events, "and")

    def any_listed(self, *events: Event) -> list[State]:
        """Return the condition of `a, b or c`; alone behind `keep` or `reach`, a comma may join what comes in turn."""
        states = self.any_of(*events)
        self.listed |= {state.text for state in states}
        return states

    def any_of(self, *events: Event) -> list[State]:
        return self._of_all(events, "or")

    def _of_all(self, events: Sequence[Event], operator: str) -> list[State]:
        """Return the readings of several conditions: `in the last 5 s` is about the one before it, or about all."""
        state = None if self._has_open_end(events) else joined_events(events, operator)
        if state is None:
            return []
        *others, last = events
        if not isinstance(last, State) or last.text not in self._recent:
            return [state]
        of_all = joined_events([*others, self._recent[last.text][0]], operator)
        assert of_all is not None
        return [state, State(f"once within {self._recent[last.text][1].text} {of_all.at(ATOM)}")]

    def _has_open_end(self, events: Sequence[Event]) -> bool:
        """Whether `is false` stands behind the last condition alone, and may be about all of them."""
        texts = [event.text in self.assigned for event in events if isinstance(event, State)]
        return bool(texts) and texts[-1] and not texts[0]

    def none_of(self, *events: Event) -> State | None:
        states = [as_state(event) for event in events]
        return joined_events([state.negated() for state in states if state is not None], "and")

    def members(self, *states: State) -> Members:
        return Members(states)

    def any_member(self, members: Members) -> State:
        return self._grouped(members, "or")

    def all_members(self, members: Members) -> State:
        return self._grouped(members, "and")

    def no_member(self, members: Members) -> State:
        return self._grouped(Members(tuple(state.negated() for state in members.states)), "and")

    def _grouped(self, members: Members, operator: str) -> State:
        return State(f"({joined([*members.states], operator).text})")

    def exactly_one(self, members: Members) -> State | None:
        states = members.states
        if len(states) > 3:
            return None
        cases = [
            joined([state if at == which else state.negated() for at, state in enumerate(states)], "and")
            for which in range(len(states))
        ]
        state = State(" or ".join(f"({case.text})" for case in cases), OR)
        self.exclusive.add(state.text)
        self.parts_of_exclusive[state.text] = states
        return state

    def at_most_one(self, members: Members) -> State | None:
        states = members.states
        pairs = [(a, b) for at, a in enumerate(states) for b in states[at + 1 :]]
        return joined([State(f"not ({joined([a, b], 'and').text})") for a, b in pairs], "and")

    def same(self, one: Term | State, other: Term | State) -> State | None:
        if any(isinstance(item, Term) and item.declared is None for item in (one, other)):
            return None  # an imported name may be a number
        left, right = (State(item.text) if isinstance(item, Term) else item for item in (one, other))
        return State(f"{left.at(OR)} iff {right.at(OR)}", RULE)

    def possessed(self, state: State) -> State:
        """Return what somebody has: `with the key`."""
        return state

    def one_of_two(self, state: State, other: State) -> State | None:
        if max(state.level, other.level) > ATOM or state.text.startswith("not "):
            return None  # `a and b xor c` may be about b alone
        return State(f"{state.at(OR)} iff {other.negated().at(OR)}", RULE)

    # What lasts, and what is counted.

    def falls_below(self, number: Number, limit: Number) -> Crossing | None:
        return _crossing(comparison(number, "<", limit))

    def rises_above(self, number: Number, limit: Number) -> Crossing | None:
        return _crossing(comparison(number, ">", limit))

    def was_compared(self, left: Number, sign: str | Term, right: Number) -> State | None:
        """Return the condition of `x was >= 60` at the step before."""
        state = self.compared(left, sign if isinstance(sign, str) else sign.text, right)
        return None if state is None else State(f"previously ({state.text})")

    def comes_to(self, number: Number, limit: Number) -> Crossing | None:
        return _crossing(comparison(number, ">=", limit))

    def held(self, state: State, *rest: str | Duration) -> Held | None:
        sign = rest[0] if isinstance(rest[0], str) else ""
        duration = rest[-1]
        assert isinstance(duration, Duration)
        return Held(state, str(sign), duration)

    def not_held(self, term: Term, *rest: str | Duration) -> Held | None:
        """Return the event of `no click for 8 s`."""
        return self.held(State(term.text).negated(), *rest)

    def held_or_more(self, state: State, duration: Duration) -> Held:
        return Held(state, ">=", duration)

    def counted(self, state: State, number: str) -> Counted:
        return Counted(state, "", number)

    def counted_compared(self, state: State, sign: str, number: str) -> Counted:
        return Counted(state, sign, number)

    def compared_counted(self, sign: str, number: str, state: State) -> Counted:
        return Counted(state, sign, number)

    def counted_before(self, number: str, state: State) -> Counted | State:
        return State(f"once {state.at(ATOM)}") if number == "1" else Counted(state, "", number)

    def number_of(self, sign: str, number: Term, term: Term) -> Counted:
        return Counted(State(term.text), sign, number.text)

    def since_then(self, state: State, start: State) -> list[State] | None:
        """Return both readings: the condition holds ever since, or has held at some step since."""
        if start.text.startswith("previously "):
            return None  # `since the previous b`, which `since` reads
        return [State(f"({state.at(ATOM)} since {start.at(ATOM)})"), self.since(state, start)]

    def since_in_brackets(self, state: State, start: State) -> State:
        return State(f"({state.at(ATOM)} since {start.at(ATOM)})")

    def since(self, state: State, start: State) -> State:
        since = State(f"(not {start.at(ATOM)} since {state.at(ATOM)})")
        self._since[since.text] = (state, start)
        return since

    def held_since(self, state: State, *rest: str | Duration | State) -> State | None:
        """Return the condition of `a for 2 s since b`: at some step since the last b, a has held for 2 s in a row."""
        *signs, duration, start = rest
        assert isinstance(duration, Duration) and isinstance(start, State)
        sign = signs[0] if signs else ">="
        if sign not in (">", ">=") or duration.is_steps:
            return None
        times = (
            f"{time} {sign} {duration.text}" for time in (f"time_holding({state.text})", f"time_since({start.text})")
        )
        return State(f"(not {start.at(ATOM)} since ({' and '.join(times)}))")

    def at_steps_of(self, event: State, condition: State) -> State | None:
        """Return a condition at the steps of an event: `since the last event` is since the one before.

        None for one that always holds there: ever since that very step.
        """
        state, start = self._since.get(condition.text, (condition, None))
        if start is not None and begun(start).text == begun(event).text:
            own = joined([state, start.negated()], "and")  # what holds at the event itself came before it
            return State(f"previously (not {start.at(ATOM)} since {own.at(ATOM)})")
        return None if condition.text.endswith(f" since {event.at(ATOM)})") else condition


def _crossing(state: State | None) -> Crossing | None:
    return None if state is None else Crossing(state)


def _is(name: Term, value: Term) -> State:
    return State(f"{name.text} is {value.text}", ATOM, f"{name.text} is not {value.text}")
