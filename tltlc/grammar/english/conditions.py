"""What the conditions of English sentences mean: each function reads one rule of the grammar."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from tltlc.core.record import record
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_MIRRORED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}
Change = Literal["falls", "rises", "stays", "varies"]


@record
class Number:
    """A number or an expression of numbers: its text, and the terminal of a single name."""

    text: str
    term: Term | None = None

    @property
    def is_int(self) -> bool:
        """Whether equality is exact: for whole numbers, and for counts."""
        return self.term is not None and (self.term.kind == "INT")

    @property
    def ends(self) -> tuple[str, ...]:
        """The ends of the declared range of a real number; () if there is none."""
        declared = None if self.term is None else self.term.declared
        return () if declared is None else tuple(end.replace(" / ", "/") for end in declared.ends)


@record
class Duration:
    """A time such as ``3 s`` or ``20 steps``."""

    number: str
    unit: str

    @property
    def is_steps(self) -> bool:
        """Whether the time is a number of steps."""
        return self.unit in ("step", "steps")

    @property
    def text(self) -> str:
        """The time in the language."""
        return f"{self.number} {self.unit}"


@record
class Held:
    """A condition that has held for a time: ``hidden for more than 3 s``. The sign is empty for ``for 3 s``."""

    state: State
    sign: str
    duration: Duration


@record
class Counted:
    """How often a condition has begun to hold; the sign is empty for ``3 times``."""

    state: State
    sign: str
    number: str


@record
class Crossing:
    """The step at which a number crosses a limit: ``health falls below 20``."""

    state: State


Event = State | Held | Counted | Crossing


def as_state(event: Event) -> State | None:
    """Return the condition that an event is on one step; None if the language has none for it."""
    if isinstance(event, State):
        return event
    if isinstance(event, Crossing):
        return State(f"begins ({event.state.text})")
    if isinstance(event, Counted):
        return State(f"times({event.state.text}) {event.sign or '>='} {event.number}", ATOM,
                     f"times({event.state.text}) {NEGATED_SIGN[event.sign or '>=']} {event.number}")  # fmt: skip
    if event.duration.is_steps:
        return None if event.sign not in ("", ">=") else _held_for_steps(event)
    held = State(f"time_holding({event.state.text}) {event.sign or '>='} {event.duration.text}")
    # A time that is not yet over is also 0 while the condition does not hold.
    return joined([event.state, held], "and") if event.sign in ("<", "<=") else held


def _held_for_steps(event: Held) -> State | None:
    count = event.duration.number
    if not count.isdecimal() or not 0 < int(count) <= 4:
        return None
    if count == "1":
        return event.state
    whole = " ".join(["previously"] * (int(count) - 1) + ["true"])
    return State(f"historically for {count} steps {event.state.at(ATOM)} and {whole}", AND)


def comparison(left: Number, sign: str, right: Number) -> State | None:
    """Return a comparison in the language, which has no equality of real numbers."""
    if sign in ("==", "!="):
        return _equality(left, sign, right)
    return State(
        f"{left.text} {sign} {right.text}",
        ATOM,
        f"{left.text} {NEGATED_SIGN[sign]} {right.text}",
    )


def _equality(left: Number, sign: str, right: Number) -> State | None:
    is_exact = all(side.is_int or side.term is None for side in (left, right)) and (left.is_int or right.is_int)
    if is_exact or (left.term is None and right.term is None):
        opposite = "!=" if sign == "==" else "=="
        return State(f"{left.text} {sign} {right.text}", ATOM, f"{left.text} {opposite} {right.text}")
    number, other = (left, right) if left.term is not None else (right, left)
    ends = number.ends
    if len(ends) == 2 and other.text in ends:
        state = comparison(number, ">=" if other.text == ends[1] else "<=", other)
    else:
        if sign == "!=":
            return State(f"{number.text} < {other.text} or {number.text} > {other.text}", OR)
        state = State(f"{number.text} >= {other.text} and {number.text} <= {other.text}", AND)
    return state if sign == "==" or state is None else state.negated()


_SIGN_OF: Final = {"at_most": "<=", "at_least": ">=", "more": ">", "less": "<"}


class Conditions:
    """The meanings of the rules for numbers, conditions, and what lasts or is counted.

    ``names`` are what the file declares.
    """

    def __init__(self, names: DeclaredNames) -> None:
        self._step_s = names.step_s
        self.limits: list[str] = []
        """Why no clause can say a sentence."""

    def steps(self, duration: Duration) -> float:
        """Return how many steps a time takes; 0 if that is not known."""
        if duration.is_steps:
            return float(duration.number)
        seconds = float(duration.number) * {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}[duration.unit]
        return seconds / self._step_s if self._step_s else 0.0

    # Numbers.

    def variable(self, term: Term) -> Number:
        return Number(term.text, term)

    def constant(self, number: Term, unit: Term | None = None) -> Number | None:
        if unit is not None and unit.text in ("step", "steps"):
            return None
        return Number(number.text if unit is None else f"{number.text} {unit.text}")

    def previous(self, term: Term) -> Number:
        return Number(f"previous({term.text})", term)

    def value_at(self, term: Term, event: Term) -> None:
        self.limits.append(
            f"no clause can say what `{term.text}` was at `{event.text}`: let the game supply that number as a signal, "
            f"and compare `{term.text}` with it"
        )

    def value_when(self, term: Term, name: Term, value: Term) -> None:
        self.value_at(term, Term("BOOL", f"{name.text} becomes {value.text}"))

    def initial(self, term: Term) -> Number:
        return Number(f"initial({term.text})", term)

    def in_brackets(self, number: Number) -> Number:
        return Number(f"({number.text})", number.term)

    def arithmetic(self, *parts: Number | Term) -> Number:
        text = " ".join(part.text for part in parts) if len(parts) > 2 else "".join(part.text for part in parts)
        numbers = [part for part in parts if isinstance(part, Number)]
        is_int = all(number.is_int or number.term is None for number in numbers) and any(n.is_int for n in numbers)
        return Number(text, Term("INT" if is_int else "REAL", text) if any(n.term for n in numbers) else None)

    def duration(self, number: Term, unit: Term) -> Duration:
        return Duration(number.text, unit.text)

    def at_most(self) -> str:
        return "<="

    def at_least(self) -> str:
        return ">="

    def more(self) -> str:
        return ">"

    def less(self) -> str:
        return "<"

    def number(self, number: Term) -> str:
        return number.text

    def one(self) -> str:
        return "1"

    def two(self) -> str:
        return "2"

    def three(self) -> str:
        return "3"

    # Bools and enums.

    def named(self, term: Term) -> State:
        return State(term.text)

    def not_named(self, term: Term) -> State:
        return State(term.text).negated()

    def begins(self, term: Term) -> State:
        return State(f"begins {term.text}")

    def ends(self, term: Term) -> State:
        return State(f"ends {term.text}")

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

    def not_enum(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else state.negated()

    def enum_begins(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else State(f"begins ({state.text})")

    def enum_ends(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else State(f"ends ({state.text})")

    def enum_before(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else State(f"previously ({state.text})")

    def not_enum_before(self, name: Term, value: Term) -> State | None:
        state = self.enum(name, value)
        return None if state is None else State(f"not previously ({state.text})")

    def enum_varies(self, name: Term, before: Term | None = None) -> State | None:
        if name.declared is None or (before is not None and before.text != name.text):
            return None
        ends = [f"ends ({name.text} is {value})" for value in name.declared.values]
        return State(" or ".join(ends), OR)

    def enum_stays(self, name: Term, before: Term | None = None) -> State | None:
        state = self.enum_varies(name, before)
        return None if state is None else state.negated()

    def enum_changes(self, name: Term, start: Term, end: Term) -> State | None:
        before, after = self.enum_before(name, start), self.enum(name, end)
        return None if before is None or after is None else joined([before, after], "and")

    # Comparisons.

    def comparison(self, left: Number, sign: Term, right: Number) -> State | None:
        return comparison(left, sign.text, right)

    def compared(self, left: Number, sign: str, right: Number) -> State | None:
        return comparison(left, sign, right)

    def equal(self, left: Number, right: Number) -> State | None:
        return comparison(left, "==", right)

    def unequal(self, left: Number, right: Number) -> State | None:
        return comparison(left, "!=", right)

    def chain(self, low: Number, first: Term, middle: Number, second: Term, high: Number) -> State | None:
        one, other = comparison(low, first.text, middle), comparison(middle, second.text, high)
        return None if one is None or other is None else joined([one, other], "and")

    def between(self, middle: Number, low: Number, high: Number) -> State | None:
        if middle.ends[:1] == (low.text,):
            return comparison(middle, "<=", high)
        if middle.ends[1:] == (high.text,):
            return comparison(middle, ">=", low)
        return State(f"{middle.text} >= {low.text} and {middle.text} <= {high.text}", AND)

    def amount(self, sign: str, number: Term, term: Term) -> State | None:
        return comparison(Number(term.text, term), sign, Number(number.text))

    def falls(self) -> Change:
        return "falls"

    def rises(self) -> Change:
        return "rises"

    def stays(self) -> Change:
        return "stays"

    def varies(self) -> Change:
        return "varies"

    def changes(self, term: Term, change: Change) -> State | None:
        now, before = Number(term.text, term), Number(f"previous({term.text})", term)
        signs = {"falls": "<", "rises": ">", "stays": "==", "varies": "!="}
        return _change(now, signs[change], before)

    def never_changes(self, term: Term, change: Change) -> State | None:
        state = self.changes(term, change)
        return None if state is None else state.negated()

    def falls_below(self, number: Number, limit: Number) -> Crossing | None:
        return _crossing(comparison(number, "<", limit))

    def rises_above(self, number: Number, limit: Number) -> Crossing | None:
        return _crossing(comparison(number, ">", limit))

    def changes_by(self, term: Term, change: Change, step: Number) -> State | None:
        return self.changes_by_compared(term, change, "==", step)

    def changes_by_compared(self, term: Term, change: Change, sign: str, step: Number) -> State | None:
        if change not in ("falls", "rises"):
            return None
        operator = "-" if change == "falls" else "+"
        kind = term if step.is_int or step.term is None else Term("REAL", term.text)
        now, then = Number(term.text, kind), Number(f"previous({term.text}) {operator} {step.text}", kind)
        return _change(now, _MIRRORED[sign] if change == "falls" else sign, then)

    # Several conditions.

    def negation(self, state: State) -> State:
        return state.negated()

    def bracketed(self, event: Event) -> State | None:
        state = as_state(event)
        return state if state is None or state.level == ATOM else State(f"({state.text})")

    def all_of(self, *events: Event | list[State]) -> State | None:
        return _joined(_flat(events), "and")

    def any_of(self, *events: Event | list[State]) -> State | None:
        return _joined(_flat(events), "or")

    def none_of(self, *events: Event | list[State]) -> State | None:
        states = [as_state(event) for event in _flat(events)]
        return _joined([state.negated() for state in states if state is not None], "and")

    def members(self, *states: State) -> list[State]:
        return [*states]

    def exactly_one(self, states: list[State]) -> State | None:
        if len(states) > 3:
            return None
        cases = [
            joined([state if at == which else state.negated() for at, state in enumerate(states)], "and")
            for which in range(len(states))
        ]
        return State(" or ".join(f"({case.text})" for case in cases), OR)

    def at_most_one(self, states: list[State]) -> State | None:
        pairs = [(a, b) for at, a in enumerate(states) for b in states[at + 1 :]]
        return joined([State(f"not ({joined([a, b], 'and').text})") for a, b in pairs], "and")

    # What lasts, and what is counted.

    def held(self, state: State, *rest: str | Duration) -> Held | None:
        sign = rest[0] if isinstance(rest[0], str) else ""
        duration = rest[-1]
        assert isinstance(duration, Duration)
        return Held(state, str(sign), duration)

    def held_or_more(self, state: State, duration: Duration) -> Held:
        return Held(state, ">=", duration)

    def counted(self, state: State, number: str) -> Counted:
        return Counted(state, "", number)

    def counted_compared(self, state: State, sign: str, number: str) -> Counted:
        return Counted(state, sign, number)

    def compared_counted(self, sign: str, number: str, state: State) -> Counted:
        return Counted(state, sign, number)

    def counted_before(self, number: str, state: State) -> Counted:
        return Counted(state, "", number)

    def number_of(self, sign: str, number: Term, term: Term) -> Counted:
        return Counted(State(term.text), sign, number.text)

    def since_then(self, state: State, start: State) -> State:
        return State(f"({state.at(ATOM)} since {start.at(ATOM)})")

    def since(self, state: State, start: State) -> State:
        return State(f"(not {start.at(ATOM)} since {state.at(ATOM)})")


def _crossing(state: State | None) -> Crossing | None:
    return None if state is None else Crossing(state)


def _is(name: Term, value: Term) -> State:
    return State(f"{name.text} is {value.text}", ATOM, f"{name.text} is not {value.text}")


def _change(now: Number, sign: str, before: Number) -> State | None:
    if sign in ("==", "!=") and not now.is_int:
        state = State(f"{now.text} >= {before.text} and {now.text} <= {before.text}", AND)
        return state if sign == "==" else State(f"{now.text} > {before.text} or {now.text} < {before.text}", OR)
    if sign in ("==", "!="):
        opposite = "!=" if sign == "==" else "=="
        return State(f"{now.text} {sign} {before.text}", ATOM, f"{now.text} {opposite} {before.text}")
    return comparison(now, sign, before)


def _flat(items: Sequence[Event | list[State]]) -> list[Event]:
    found: list[Event] = []
    for item in items:
        if isinstance(item, list):
            found += item
        else:
            found.append(item)
    return found


def _joined(events: Sequence[Event], operator: str) -> State | None:
    states = [as_state(event) for event in events]
    known = [state for state in states if state is not None]
    return joined(known, operator) if len(known) == len(states) else None
