"""What numbers and their comparisons in English sentences mean."""

from __future__ import annotations

import re
from typing import Final, Literal

from tltlc.core.record import record, replace
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN
from tltlc.grammar.past_words import MOST_STEPS_BACK, SINCE

MIRRORED: Final = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "==", "!=": "!="}
Change = Literal["falls", "rises", "stays", "varies"]
IT: Final = "?"
"""What stands in a clause for an event that is not known yet."""
_FUNCTIONS: Final = ("times(", "times_since(", "total_time(", "time_holding(", "time_since(")
"""The functions whose values are counts and times, which no clause keeps from an event on."""


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
class ChangeBy:
    """By how much a number falls or rises."""

    term: Term
    change: Change
    sign: str
    step: Number

    def compared_with(self, before: str) -> State | None:
        """Return the condition that the number has changed so much since it had the value ``before``."""
        is_exact = self.step.is_int or (self.step.term is None and not self.step.text.endswith("%"))
        kind = self.term if is_exact else Term("REAL", self.term.text)
        now, then = Number(self.term.text, kind), Number(changed_value(self.term, before, self.change, self.step), kind)
        return _change(now, MIRRORED[self.sign] if self.change == "falls" else self.sign, then)


def share_of(term: Term, step: Number) -> float | None:
    """Return 0.3 for a change by 30 %, which is a share of the value before; None for other changes.

    Of a number that is itself a share, or that may be below 0, 30 % are a difference.
    """
    number, _, unit = step.text.partition(" ")
    ends = () if term.declared is None else term.declared.ends
    is_difference = any("%" in end or end == "1" or end.startswith("-") for end in ends)
    return float(number) / 100 if unit == "%" and not is_difference else None


def changed_value(term: Term, before: str, change: Change, step: Number) -> str:
    """Return the value of a number after it has changed: `coins - 3`, or `0.7 * coins` where it falls by 30 %.

    ``before`` is its value before that.
    """
    share = share_of(term, step)
    if share is not None:
        return f"{round(1 - share if change == 'falls' else 1 + share, 10):g} * {before}"
    return f"{before} {'-' if change == 'falls' else '+'} {step.text}"


class Quantities:
    """The meanings of the rules for numbers, conditions, and what lasts or is counted.

    ``names`` are what the file declares.
    """

    def __init__(self, names: DeclaredNames) -> None:
        self._step_s = names.step_s
        self._declared = names
        self.limits: list[str] = []
        """Why no clause can say a sentence."""
        self.settled: dict[str, State] = {}
        """Maps the texts of changes to what holds after them: `begins a` to a."""
        self.exclusive: set[str] = set()
        """The conditions that exactly one of several holds: as a goal, they may be about the whole episode."""
        self.parts_of_exclusive: dict[str, tuple[State, ...]] = {}
        """Maps the texts of conditions such as `exactly one of a and b` to these."""
        self.assigned: set[str] = set()
        """The conditions that are written with `is true` or `is false`."""
        self.is_lasting = False
        """Whether the sentence says `stays`, `must` or `never`."""
        self.counts: set[str] = set()
        """The conditions of which `count(a)` may count the steps, or how often they begin."""
        self.values: dict[str, tuple[str, State]] = {}
        """Maps the value of a number at an event to the two: `value_at(x, begins a)` to x and `begins a`."""
        self.returning: dict[str, State] = {}
        """Maps the conditions of numbers that return to a value to the event at which they had it."""
        self.changing: set[str] = set()
        """The conditions that a number changes, which no first step meets."""
        self.changes_by_amounts: dict[str, ChangeBy] = {}
        """Maps the texts of conditions such as `coins rises by at least 3` to these."""

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

    def multiple(self, number: Term, term: Term) -> Number:
        return Number(f"{number.text} * {term.text}", term)

    def double(self, term: Term) -> Number:
        return Number(f"2 * {term.text}", term)

    def half(self, term: Term) -> Number:
        return Number(f"{term.text} / 2", Term("REAL", term.text))

    def reset(self, term: Term, value: Number) -> State | None:
        """Return the step of `x is reset to 0`."""
        state = comparison(self.variable(term), "==", value)
        if state is None:
            return None
        event = begun(state)
        self.settled[event.text] = state
        return event

    def half_before(self, term: Term, duration: Duration) -> Number | None:
        before = self.value_before(term, duration)
        return None if before is None else Number(f"{before.text} / 2", Term("REAL", term.text))

    def share(self, percent: Term, unit: Term, of: Number) -> Number | None:
        """Return `80 % of x`."""
        if unit.text != "%" or of.term is None:
            return None
        return Number(f"{float(percent.text) / 100:g} * {of.text}", Term("REAL", of.text))

    def previous(self, term: Term) -> Number:
        return Number(f"previous({term.text})", term)

    def value_at(self, term: Term, event: State) -> Number | None:
        """Return the value of a number at the last beginning of a condition."""
        return self.value_at_last(term, begun(event))

    def value_at_end(self, term: Term, event: State) -> Number | None:
        return self.value_at_last(term, State(f"ends {event.at(ATOM)}"))

    def value_at_last(self, term: Term, event: State) -> Number | None:
        if event.text.startswith(("not ", "begins not ")) or term.text.startswith(_FUNCTIONS):
            return None
        text = f"value_at({term.text}, {event.text})"
        self.values[text] = (term.text, event)
        return Number(text, Term(term.kind, text, term.declared))

    def is_of_another(self, left: Number, right: Number) -> bool:
        """Whether one side is the value of a number at an event, and the other side is about other numbers alone."""
        for one, other in ((left, right), (right, left)):
            name = next((name for text, (name, _) in self.values.items() if text in one.text), "")
            if name and other.term is not None and name not in other.text:
                return True
        return False

    def value_after(self, term: Term, duration: Duration) -> None:
        self.limits.append(
            f"no clause can say what `{term.text}` is {duration.text} later or earlier: let the game supply that "
            f"number as a signal, and compare `{term.text}` with it"
        )

    def initial_at(self, term: Term, number: Term) -> Number | None:
        return self.initial(term) if number.text in ("0", "zero") else None

    def count_of(self, state: State) -> Number:
        self.counts.add(state.text)
        return Number(f"times({state.text})", Term("INT", f"times({state.text})"))

    def count_condition(self, text: str) -> str:
        """Return when `times(a)` in a clause is what `count(a)` counts; "" if that was not typed."""
        counted = next((event for event in sorted(self.counts) if f"times({event})" in text), "")
        return f"if it counts how often `{counted}` begins: no clause can count its steps" if counted else ""

    def duration_of(self, state: State) -> Number:
        return Number(f"time_holding({state.text})", Term("REAL", f"time_holding({state.text})"))

    def total_of(self, state: State) -> Number:
        return Number(f"total_time({state.text})", Term("REAL", f"total_time({state.text})"))

    def total_of_bool(self, term: Term) -> Number:
        return self.total_of(State(term.text))

    def value_at_own(self, term: Term) -> Number | None:
        """Return the value of a number when `it` began, which the condition of the rule names."""
        return self.value_at_last(term, State(f"begins {IT}"))

    def count_of_since(self, term: Term, event: State) -> Number | None:
        return self.number_since(Term("INT", f"times({term.text})"), event)

    def number_since(self, term: Term, event: State) -> Number | None:
        """Return what `times(p) since q` and `highest(x) since q` mean; None for other numbers before `since`."""
        name, bracket, inner = term.text.partition("(")
        if name not in ("times", "highest", "lowest") or not bracket:
            return None
        since = event if name == "times" else begun(event)
        text = f"{SINCE[name]}({inner[:-1].strip()}, {since.text})"
        return Number(text, Term(term.kind, text, term.declared))

    def highest_since(self, term: Term, event: State) -> Number | None:
        return self.number_since(Term(term.kind, f"highest({term.text})", term.declared), event)

    def lowest_since(self, term: Term, event: State) -> Number | None:
        return self.number_since(Term(term.kind, f"lowest({term.text})", term.declared), event)

    def absolute(self, number: Number) -> Number | None:
        if number.term is None:
            return None
        return Number(f"abs({number.text})", Term(number.term.kind, f"abs({number.text})"))

    def change_size(self, *parts: Term) -> Number | None:
        term, other = (part for part in parts if part.kind in ("INT", "REAL"))
        if term.text != other.text:
            return None
        return self.absolute(Number(f"{term.text} - previous({term.text})", Term(term.kind, term.text)))

    def initial(self, term: Term) -> Number:
        return Number(f"initial({term.text})", term)

    def in_brackets(self, number: Number) -> Number:
        return Number(f"({number.text})", number.term)

    def arithmetic(self, *parts: Number | Term) -> Number:
        *_, sign, right = parts
        if sign.text in ("*", "/") and isinstance(right, Number) and any(s in right.text for s in (" * ", " / ")):
            parts = (*parts[:-1], Number(f"({right.text})", right.term))
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

    # Comparisons.

    def comparison(self, left: Number, sign: Term, right: Number) -> State | None:
        return None if self.is_of_another(left, right) else comparison(left, sign.text, right)

    def compared(self, left: Number, sign: str, right: Number) -> State | None:
        return None if self.is_of_another(left, right) else comparison(left, sign, right)

    def equal(self, left: Number, right: Number) -> State | None:
        return None if self.is_of_another(left, right) else comparison(left, "==", right)

    def unequal(self, left: Number, right: Number) -> State | None:
        return None if self.is_of_another(left, right) else comparison(left, "!=", right)

    def chain(self, low: Number, first: Term, middle: Number, second: Term, high: Number) -> State | None:
        one, other = comparison(low, first.text, middle), comparison(middle, second.text, high)
        return None if one is None or other is None else joined([one, other], "and")

    def between(self, middle: Number, low: Number, high: Number) -> State | None:
        if middle.ends[:1] == (low.text,):
            return comparison(middle, "<=", high)
        if middle.ends[1:] == (high.text,):
            return comparison(middle, ">=", low)
        return State(f"{middle.text} >= {low.text} and {middle.text} <= {high.text}", AND)

    def outside(self, middle: Number, low: Number, high: Number) -> State:
        return State(f"{middle.text} < {low.text} or {middle.text} > {high.text}", OR)

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
        state = _change(now, signs[change], before)
        if state is not None and change != "stays":
            self.changing.add(state.text)
        return state

    def value_before(self, term: Term, duration: Duration) -> Number | None:
        """Return the value of a number so long ago; a limit if that is too many steps."""
        steps = round(self.steps(duration), 6)
        if steps == 1:
            return Number(f"previous({term.text})", term)
        if 0 < steps <= MOST_STEPS_BACK:
            return Number(f"previous({term.text}, {duration.text})", term)
        self.limits.append(
            f"no clause can say what `{term.text}` was {duration.text} ago, unless that is {MOST_STEPS_BACK} steps or "
            f"less: let the game supply that number as a signal, and compare `{term.text}` with it"
        )
        return None

    def never_changes(self, term: Term, change: Change) -> State | None:
        state = self.changes(term, change)
        return None if state is None else state.negated()

    def changes_by(self, term: Term, change: Change, step: Number) -> State | None:
        return self.changes_by_compared(term, change, "==", step)

    def changes_by_compared(self, term: Term, change: Change, sign: str, step: Number) -> State | None:
        if change not in ("falls", "rises") or sign in ("<", "<="):
            return None  # a change by at most that much is none, too
        made = ChangeBy(term, change, sign, step)
        state = made.compared_with(f"previous({term.text})")
        if state is not None:
            self.changes_by_amounts[state.text] = made
        return state


def begun(event: State) -> State:
    """Return the beginning of a condition that may last; an edge or a change of a number is one itself."""
    is_edge = event.text.startswith(("begins ", "ends ")) or "previous" in event.text
    return event if is_edge else State(f"begins {event.at(ATOM)}")


def counted_by(times: Term) -> State | None:
    """Return what `times(p)` counts."""
    name, bracket, inner = times.text.partition("(")
    return State(inner[:-1].strip()) if name == "times" and bracket else None


_OPEN: Final = re.compile(r"\b(times|total_time)\(([^(),]+)\)")
"""A count or a time that has no greatest value."""
_MOST: Final = {"times": "1000", "total_time": "10 min"}


def _with_most(call: re.Match[str]) -> str:
    return f"{call[1]}({call[2]}, {_MOST[call[1]]})"


def comparison(left: Number, sign: str, right: Number) -> State | None:
    """Return a comparison in the language, which has no equality of real numbers; None of a number with itself."""
    if left.text == right.text:
        return None
    if _OPEN.search(left.text) and _OPEN.search(right.text):
        # Both need a greatest value.
        left, right = (replace(side, text=_OPEN.sub(_with_most, side.text)) for side in (left, right))
    if sign in ("==", "!="):
        return _equality(left, sign, right)
    return State(
        f"{left.text} {sign} {right.text}",
        ATOM,
        f"{left.text} {NEGATED_SIGN[sign]} {right.text}",
    )


def _equality(left: Number, sign: str, right: Number) -> State | None:
    if any(side.text.startswith(("time_since(", "time_holding(", "total_time(")) for side in (left, right)):
        return None  # a time may pass a value between two samples
    is_exact = all(side.is_int or side.term is None for side in (left, right)) and (left.is_int or right.is_int)
    if is_exact or (left.term is None and right.term is None):
        opposite = "!=" if sign == "==" else "=="
        return State(f"{left.text} {sign} {right.text}", ATOM, f"{left.text} {opposite} {right.text}")
    number, other = (left, right) if left.term is not None else (right, left)
    # 0 needs no unit.
    ends = tuple("0" if other.text == "0" == end.split(" ")[0] else end for end in number.ends)
    if len(ends) == 2 and other.text in ends:
        state = comparison(number, ">=" if other.text == ends[1] else "<=", other)
    else:
        if sign == "!=":
            return State(f"{number.text} < {other.text} or {number.text} > {other.text}", OR)
        state = State(f"{number.text} >= {other.text} and {number.text} <= {other.text}", AND)
    return state if sign == "==" or state is None else state.negated()


_SIGN_OF: Final = {"at_most": "<=", "at_least": ">=", "more": ">", "less": "<"}


def _change(now: Number, sign: str, before: Number) -> State | None:
    if sign in ("==", "!=") and not now.is_int:
        state = State(f"{now.text} >= {before.text} and {now.text} <= {before.text}", AND)
        return state if sign == "==" else State(f"{now.text} > {before.text} or {now.text} < {before.text}", OR)
    if sign in ("==", "!="):
        opposite = "!=" if sign == "==" else "=="
        return State(f"{now.text} {sign} {before.text}", ATOM, f"{now.text} {opposite} {before.text}")
    return comparison(now, sign, before)
