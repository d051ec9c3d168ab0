"""What the answers of rules mean: what a rule asks for after its condition."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record, replace
from tltlc.grammar.english.conditions import Conditions
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

MOST_STEPS: Final = 8
"""The most steps after which a condition must hold: a monitor has up to two to the power of them states."""

_LONGEST_WINDOW: Final = 80
"""The most steps of a window after an event: a monitor of a longer one takes too long to build."""

_MOST_STEPS_APART: Final = 20
"""The most steps in which one of two events must come, and not both: a monitor has their square as states."""
_EXACT: Final = 1e-12
_MOST_PREVIOUS: Final = 3
"""The most times that `previously` is repeated."""


@record
class LateWindow:
    """An answer in a window that is too late to look ahead to, and what may excuse it."""

    state: State
    window: tuple[Duration, Duration]
    excuse: State | None = None


@record
class Asked:
    """What a rule asks for after its condition, and when the words mean that.

    ``is_formula`` says that the answer is a formula about later steps, which counts from the step of the condition,
    ``is_once`` that it cannot be asked for at two steps in a row, but only where the condition begins. ``settled``
    is what holds after a change that is asked for: a for `begins a`. ``denied`` is what must not hold for a time,
    and ``until`` what is asked for until something else, which need not come. ``operated`` has the operator and the
    operand of a formula such as ``weak_next always for 1 s a``. ``is_timed`` says that a formula asks for something
    within a time or for a time, and ``late`` is the time of an answer that is due too many steps later to look ahead,
    as ``late_window`` is for a window. ``is_window`` says that a formula is about such a window.
    """

    answer: Answer
    condition: str = ""
    is_formula: bool = False
    is_once: bool = False
    settled: State | None = None
    denied: State | None = None
    until: tuple[State, State] | None = None
    operated: tuple[str, State] | None = None
    is_timed: bool = False
    late: Duration | None = None
    late_window: LateWindow | None = None
    is_window: bool = False


def operated(operator: str, state: State, condition: str = "") -> Asked:
    """Return an answer that is a formula of an operator and a condition."""
    formula = State(f"{operator} {state.at(ATOM)}")
    return Asked(Answer("now", formula), condition, is_formula=True, operated=(operator, state))


class Answers(Conditions):
    """The meanings of the rules for answers."""

    def answers(self, *asked: Asked) -> list[list[Asked]]:
        return [[*asked]]

    def until_in_time(self, state: State, duration: Duration, end: State) -> list[list[Asked]] | None:
        """Return both answers of `not a U[<=20 s] b`: b in that time, and a no more than that until then."""
        if is_negative(end):
            return None
        asked = Asked(Answer("within", self.settled.get(end.text, end), duration.text))
        return [[asked, Asked(Answer("now", State(f"({state.at(ATOM)} until {end.at(ATOM)})")), is_formula=True)]]

    def until_by(self, state: State, end: State, duration: Duration) -> list[list[Asked]] | None:
        return self.until_in_time(state, duration, end)

    def never_until_by(self, state: State, end: State, duration: Duration) -> list[list[Asked]] | None:
        return self.until_in_time(state.negated(), duration, end)

    def now(self, state: State) -> Asked:
        # A change is asked for at the step of the event alone, what holds after it at each such step.
        is_change = state.text in self.settled or state.text in self.changing
        return Asked(Answer("now", state), is_formula=is_change, settled=self.settled.get(state.text))

    def within(self, state: State, duration: Duration) -> Asked | list[Asked]:
        is_typed = any(state.text in (f"begins {name}", f"ends {name}") for name in self.edges)
        state = state if is_typed else self.settled.get(state.text, state)
        if state.text.startswith("times("):
            self.limits.append(
                f"`{state.text}` counts from the first step on: write `times_within(p, {duration.text})` to count in "
                f"the {duration.text} up to a step, or `times_since(p, q)` to count from an event on"
            )
            return []
        if state.text in self.exclusive and (apart := self._one_within(state, duration)):
            return apart
        if is_negative(state):
            never = State(f"not eventually within {duration.text} {state.negated().at(ATOM)}")
            return [
                Asked(Answer("now", never), "if it must hold at no step of that time", True, denied=state.negated()),
                Asked(Answer("within", state, duration.text), "if one step is enough"),
            ]
        return Asked(Answer("within", state, duration.text))

    def _one_within(self, state: State, duration: Duration) -> list[Asked] | None:
        """Return the readings of `exactly one of a and b within 3 s`: one of them in all that time, or at one step."""
        parts = self.parts_of_exclusive.get(state.text, ())
        steps = round(self.steps(duration), 6)
        if len(parts) != 2 or not steps.is_integer() or not 1 <= steps <= _MOST_STEPS_APART:
            return None
        if not duration.is_steps and not self._step_s:
            return None
        time = round((steps + 1) * self._step_s, 6)
        is_exact = abs(time - (steps + 1) * self._step_s) < _EXACT
        longer = f"{time:g} s" if is_exact and not duration.is_steps else f"{steps + 1:g} steps"
        never = [f"(always for {longer} {part.negated().at(ATOM)})" for part in parts]
        either = joined([*parts], "or")
        apart = State(f"(eventually within {duration.text} {either.at(ATOM)}) and ({' or '.join(never)})", AND)
        one, other = (f"`{part.text}`" for part in parts)
        at_once = State(f"eventually within {duration.text} {state.at(ATOM)}")
        return [
            Asked(Answer("now", apart), f"if {one} or {other} must come, and not both in that time", is_formula=True),
            Asked(Answer("now", at_once), "if a step with exactly one of them is enough", is_formula=True),
        ]

    def eventually_within(self, duration: Duration, state: State) -> Asked | list[Asked]:
        return self.within(state, duration)

    def came_before_now(self, state: State) -> list[Asked]:
        """Return the readings of `once before a`: at this step or before it, or before it."""
        once = f"once {state.at(ATOM)}"
        return [
            Asked(Answer("now", State(once)), f"if `{state.text}` may come at the same step"),
            Asked(Answer("now", State(f"previously {once}")), f"if `{state.text}` must come before it"),
        ]

    def eventually_then_until(self, duration: Duration, state: State, kept: State, end: State) -> list[Asked]:
        return self.within_then_until(state, duration, kept, end)

    def reach_in_time(self, state: State, duration: Duration) -> Asked:
        return Asked(Answer("within", self.settled.get(state.text, state), duration.text))

    def within_before(self, state: State, duration: Duration) -> Asked:
        return Asked(Answer("now", State(f"once within {duration.text} {state.at(ATOM)}")))

    def held_before(self, state: State, duration: Duration) -> Asked:
        return Asked(Answer("now", State(f"time_holding({state.text}) >= {duration.text}")))

    def named_held_before(self, term: Term, duration: Duration) -> Asked:
        return self.held_before(State(term.text), duration)

    def value_held_before(self, name: Term, value: Term, duration: Duration) -> Asked:
        return self.held_before(State(f"{name.text} is {value.text}"), duration)

    def held_before_first(self, duration: Duration, state: State) -> Asked:
        return self.held_before(state, duration)

    def window_before(self, state: State, window: tuple[Duration, Duration]) -> Asked | None:
        last, first = window
        steps, length = self.steps(last), difference(last, first)
        if length is None:
            return None
        is_known = last.is_steps or bool(self._step_s)
        if not is_known or not steps.is_integer() or not 0 <= steps <= _MOST_PREVIOUS:
            counted = self._counted_between(state, last, first)
            if counted is not None:
                return counted
            self.limits.append(
                f"no short clause says that `{state.text}` was at least {last.text} ago and at most {first.text}: "
                f"`once within {first.text} {state.at(ATOM)}` is about the {first.text} up to this step, and "
                f"`time_since({state.text}) >= {last.text}` about the last step with `{state.text}`"
            )
            return None
        return Asked(Answer("now", State(f"{'previously ' * int(steps)}once within {length.text} {state.at(ATOM)}")))

    def _counted_between(self, state: State, last: Duration, first: Duration) -> Asked | None:
        """Return whether an event has begun at least 5 s and at most 20 s ago; None if a step has no fixed length."""
        event, steps = State(state.text.removeprefix("begins ")), round(self.steps(last), 6)
        if not self._step_s or not steps.is_integer() or steps < 1 or event.level > ATOM or "previous" in event.text:
            return None
        time = round((steps - 1) * self._step_s, 6)
        is_exact = abs(time - (steps - 1) * self._step_s) < _EXACT
        nearer = f"{time:g} s" if is_exact and not last.is_steps else f"{steps - 1:g} steps"
        counts = [f"times_within({event.text}, {time}, 10)" for time in (first.text, nearer)]
        what = f"if `{event.text}` begins in that time, and fewer than 10 times in {first.text}"
        return Asked(Answer("now", State(" > ".join(counts))), what)

    def window_ahead(self, window: tuple[Duration, Duration], state: State) -> Asked | list[Asked] | None:
        return self.window_after(state, window)

    def window_ago(self, window: tuple[Duration, Duration], state: State) -> Asked | None:
        return self.window_before(state, window)

    def window_after(self, state: State, window: tuple[Duration, Duration]) -> Asked | list[Asked] | None:
        first, last = window
        length = difference(first, last)
        if length is None or is_negative(state):
            return None
        if not 0 < self.steps(first) <= MOST_STEPS or self.steps(length) > _LONGEST_WINDOW:
            return None  # it needs too many states
        text = f"next after {first.text} eventually within {length.text} {state.at(ATOM)}"
        return Asked(Answer("now", State(text)), is_formula=True)

    def within_then_until(self, state: State, duration: Duration, kept: State, end: State) -> list[Asked]:
        return [
            Asked(Answer("within", joined([state, asked.answer.state], "and"), duration.text), asked.condition)
            for asked in _until(kept, end)
        ]

    def within_and_until(self, state: State, duration: Duration, *rest: Term | State) -> list[Asked] | None:
        """Return the answer of `a within 5 s and stays so until b`, perhaps with the name of a or its value."""
        end = rest[-1]
        assert isinstance(end, State)
        if any(isinstance(part, Term) and part.text not in state.text.split() for part in rest):
            return None
        return self.within_then_until(state, duration, state, end)

    def within_first_and_until(self, duration: Duration, state: State, *rest: Term | State) -> list[Asked] | None:
        return self.within_and_until(state, duration, *rest)

    def within_and_while(self, state: State, duration: Duration, *rest: Term | State) -> list[Asked] | None:
        """Return the answer of `a within 5 s and stays so while b`."""
        during = rest[-1]
        assert isinstance(during, State)
        answers = self.within_and_until(state, duration, *rest[:-1], during.negated())
        return None if answers is None else [replace(answers[0], condition="")]

    def within_then_lasting(self, state: State, duration: Duration, kept: State, length: Duration) -> Asked:
        lasting = State(f"always for {length.text} {kept.at(ATOM)}")
        state = lasting if state == kept else joined([state, lasting], "and")
        return Asked(Answer("within", state, duration.text))

    def within_lasting(self, state: State, duration: Duration, length: Duration) -> Asked | None:
        """Return the answer of `a within 1 s for at least 3 s`: it begins in that time, and lasts."""
        if is_negative(state):
            return None
        state = self.settled.get(state.text, state)
        formula = State(f"eventually within {duration.text} always for {length.text} {state.at(ATOM)}")
        return Asked(Answer("now", formula), is_formula=True)

    def reach_in_time_unless(self, state: State, duration: Duration, event: Event) -> Asked | None:
        exception = as_state(event)
        if exception is None or state.level > OR:
            return None
        return Asked(Answer("within", joined([state, exception], "or"), duration.text))

    def within_then_until_it(self, duration: Duration, state: State, end: State) -> list[Asked]:
        """Return the readings of `within 1 s a until b`: a begins in that time and holds until b, or b comes in it."""
        a, b, time = state.at(ATOM), end.at(ATOM), duration.text
        first = f"if `{state.text}` must begin within {time}"
        ended = State(f"({a} until {b}) and eventually within {time} {b}", AND)
        return [
            Asked(
                Answer("within", State(f"({a} weak_until {b})"), time), f"{first}, and play may end before `{end.text}`"
            ),
            Asked(Answer("within", State(f"({a} until {b})"), time), f"{first}, and `{end.text}` must come"),
            Asked(Answer("now", ended), f"if `{end.text}` must come within {time}", is_formula=True),
        ]

    def now_unless(self, state: State, event: Event) -> Asked | None:
        exception = as_state(event)
        is_change = state.text in self.settled or state.text in self.changing
        if exception is None or is_change or state.level > ATOM or state.text.startswith("not "):
            return None
        return Asked(Answer("now", joined([state, State(exception.at(ATOM))], "or")))

    def within_first(self, duration: Duration, state: State) -> Asked | list[Asked]:
        return self.within(state, duration)

    def reach_later(self, state: State) -> Asked:
        return Asked(Answer("eventually", state, keyword="reach"))

    def keep_now(self, state: State) -> Asked:
        return Asked(Answer("now", state, keyword="keep"))

    def lasting(self, state: State, duration: Duration) -> Asked:
        state = self.settled.get(state.text, state)
        return Asked(Answer("lasting", state, duration.text))

    def lasting_first(self, duration: Duration, state: State) -> Asked:
        return self.lasting(state, duration)

    def lasting_exactly(self, state: State, duration: Duration) -> Asked | None:
        return self.lasting_then(state, duration, state.negated())

    def lasting_then(self, state: State, duration: Duration, following: State) -> Asked | None:
        if self.steps(duration) > MOST_STEPS:
            return None
        formula = lasting_formula(state, duration, following)
        return Asked(Answer("now", formula), is_formula=True, is_once=True)

    def delayed(self, state: State, duration: Duration) -> Asked | None:
        # A monitor remembers each step with the condition until the answer is due.
        if self.steps(duration) <= MOST_STEPS:
            return Asked(Answer("delayed", state, duration.text))
        return None if duration.is_steps else Asked(Answer("delayed", state, duration.text), late=duration)

    def delayed_first(self, duration: Duration, state: State) -> Asked | None:
        return self.delayed(state, duration)

    def until(self, state: State, end: State) -> Asked | list[Asked]:
        state = self.settled.get(state.text, state)
        return self.never_until(state.negated(), end) if state.text.startswith("not ") else _until(state, end)

    def later(self, state: State) -> Asked:
        return Asked(Answer("eventually", state))

    def forever(self, state: State) -> Asked:
        return Asked(Answer("always", state))

    def next(self, state: State) -> Asked:
        return operated("weak_next", state)

    def next_forever(self, state: State) -> Asked:
        return operated("weak_next always", state)

    def never(self, state: State) -> Asked:
        return Asked(Answer("always", state.negated(), "", True))

    def never_for(self, state: State, duration: Duration) -> Asked:
        return Asked(Answer("lasting", state.negated(), duration.text, True))

    def never_within(self, state: State, duration: Duration) -> Asked:
        never = State(f"not eventually within {duration.text} {state.at(ATOM)}")
        return Asked(Answer("now", never, duration.text), is_formula=True, denied=state)

    def never_until(self, state: State, end: State) -> Asked:
        formula = State(f"({state.negated().at(ATOM)} weak_until {end.at(ATOM)})")
        return Asked(Answer("now", formula), is_formula=True, until=(state.negated(), end))

    def stops(self, state: State) -> Asked:
        return Asked(Answer("next", state.negated()))


def lasting_formula(state: State, duration: Duration, following: State) -> State:
    """Return the formula of a condition that holds for so long, and then another one."""
    held = f"always for {duration.text} {state.at(ATOM)}"
    return State(f"({held}) and weak_next after {duration.text} {following.at(ATOM)}", AND)


def is_negative(state: State) -> bool:
    """Whether a condition says that something does not hold."""
    return state.text.startswith("not ") or " is not " in state.text or " != " in state.text


def difference(shorter: Duration, longer: Duration) -> Duration | None:
    """Return how much longer a time is than another; None if they have different units, or it is not."""
    if shorter.unit != longer.unit:
        return None
    difference = round(float(longer.number) - float(shorter.number), 6)
    return Duration(f"{difference:g}", longer.unit) if difference > 0 else None


def _until(state: State, end: State) -> list[Asked]:
    weak, strong = (State(f"({state.at(ATOM)} {operator} {end.at(ATOM)})") for operator in ("weak_until", "until"))
    return [
        Asked(Answer("now", weak), f"if play may end before `{end.text}`", True, until=(state, end)),
        Asked(Answer("now", strong), f"if `{end.text}` must come", True),
    ]
