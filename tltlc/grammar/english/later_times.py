"""What rules about times before and after an event mean: `b no sooner than 1 s after a`, `2 s after a, b`."""

from __future__ import annotations

from math import floor
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import MOST_STEPS, Asked, LateWindow, difference, is_negative
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.intervals import apart, is_edge
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules, When, all_readings, are_simple, begun_text
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

Window = tuple[Duration, Duration]
_STOPPED: Final = (" < ", " <= ", " == 0")
"""What stands in conditions of numbers that are small."""
_AT_NO_STEP: Final = "if it must hold at no step of that time"
_Found = Reading | list[Reading] | None


class LaterTimes(Rules):
    """The meanings of the rules about a step, or some steps, a time after an event, and about events so long ago."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._lasted: dict[str, State] = {}
        self._or_held: dict[str, tuple[State, State]] = {}
        """What each time that looks back is the time of."""

    # Answers between two times.

    def window_after(self, state: State, window: Window) -> Asked | list[Asked] | None:
        """Return the answers of `b between 1 s and 2 s later`; `not b` may ask for one step, or for all of them."""
        if not is_negative(state):
            asked = super().window_after(state, window)
            return asked if asked is not None else self._late_window(state, window)
        denied = state.negated()
        asked = super().window_after(denied, window) if 0 < self.steps(window[0]) <= MOST_STEPS else None
        if not isinstance(asked, Asked):
            return None
        formula = asked.answer.state.text
        once = State(f"{formula.removesuffix(denied.at(ATOM))}{state.at(ATOM)}")
        return [
            replace(asked, answer=Answer("now", State(f"not {formula}")), condition=_AT_NO_STEP),
            replace(asked, answer=Answer("now", once), condition="if one step is enough"),
        ]

    def _late_window(self, state: State, window: Window, excuse: State | None = None) -> list[Asked] | None:
        """Return the answers of `b between 1 s and 3 s later` that need few states.

        One forbids an earlier b; the other looks back.
        """
        if state.level > ATOM or not 0 < self.steps(window[0]) < self.steps(window[1]):
            return None
        b = state.negated().at(ATOM)
        free = f"(always for {window[0].text} {b})"
        if excuse is not None:
            free = f"({free} or ({b} until {excuse.at(ATOM)}))"
        goal = state if excuse is None else joined([state, excuse], "or")
        strict = State(f"{free} and eventually within {window[1].text} {goal.at(ATOM)}", AND)
        answer = Answer("now", strict)
        late = LateWindow(state, window, excuse)
        return [
            Asked(answer, f"if `{state.text}` must not come earlier", is_formula=True, is_window=True),
            Asked(answer, f"if `{state.text}` may come earlier", late_window=late),
        ]

    def _looking_back(self, event: Event, asked: Asked) -> Reading | None:
        """Return the rule of `when a, b between 1 s and 3 s later` that looks back from the end of that time."""
        start, late = as_state(event), asked.late_window
        assert late is not None
        least, most = late.window
        before, length = round(self.steps(most), 6) - 1, difference(least, most)
        if start is None or start.level > ATOM or length is None or not self._step_s or not before.is_integer():
            return None
        came = State(f"once within {length.text} {late.state.at(ATOM)}")
        if late.excuse is not None:
            came = joined([came, State(f"once within {most.text} {late.excuse.at(ATOM)}")], "or")
        clause = f"keep ends (once within {int(before)} steps {start.at(ATOM)}) implies {came.text}"
        return Reading((clause,), f"{asked.condition}, and `{start.text}` does not come again within {most.text}")

    def window_unless(self, state: State, window: Window, event: Event) -> list[Asked] | None:
        """Return the readings of `b between 1 s and 2 s later unless c`."""
        exception = as_state(event)
        if exception is None or not are_simple(state, exception) or is_negative(state):
            return None
        if state == exception or begun_text(state) == begun_text(exception):
            return None
        if super().window_after(state, window) is None:
            return self._late_window(state, window, exception)
        either = super().window_after(joined([state, exception], "or"), window)
        alone = None if either is None else super().window_after(state, window)
        if not isinstance(either, Asked) or not isinstance(alone, Asked):
            return None
        excused = State(f"{exception.at(OR)} or ({alone.answer.state.text})", OR)
        return [
            replace(either, condition=f"if `{exception.text}` at a step of that time is enough"),
            replace(alone, answer=Answer("now", excused),
                    condition=f"if `{exception.text}` counts only at the first step of that time"),
        ]  # fmt: skip

    def opposite_in_window(self, event: Event, state: State, window: Window, exception: Event | None = None) -> _Found:
        """Return the rule of `begins a implies not a between 1 s and 2 s later`: how long a lasts."""
        begun, lasting = as_state(event), self.settled.get(state.text, state).negated()
        ends = None if exception is None else as_state(exception)
        if begun is None or _plain(begun.text) != _plain(begun_text(lasting)) or not are_simple(lasting):
            return None
        if exception is not None and (ends is None or not are_simple(ends)):
            return None
        (least, most), a = window, lasting.at(ATOM)
        condition = f"if `{lasting.text}` must last at least {least.text}, and end within {most.text}"
        shortest, longest = f"always for {least.text} {a}", f"time_holding({lasting.text}) < {most.text}"
        if ends is None:
            return Reading((f"keep {begun.text} implies {shortest}", f"keep {longest}"), condition)
        return Reading(
            (
                f"keep {begun.text} implies ({shortest}) or ({a} until {ends.at(ATOM)})",
                f"keep {longest} or {ends.at(OR)}",
            ),
            f"{condition}, unless `{ends.text}` comes first",
        )

    def when_opposite_in_window(self, when: When, event: Event, *rest: State | Window | Event) -> _Found:
        return self.opposite_in_window(event, *rest)  # type: ignore[arg-type]

    # A time after an event.

    def exactly_after(self, state: State, duration: Duration, event: Event) -> _Found:
        """Return the rule of `b exactly 2 s after a`; for a long time, one that looks back."""
        asked, condition = self.delayed(state, duration), as_state(event)
        if asked is not None and asked.late is None:
            return self.first("when", event, [asked])
        return None if condition is None else self._long_after(state, duration, condition)

    def implied_after(self, event: Event, duration: Duration, state: State) -> _Found:
        return self.exactly_after(state, duration, event)

    def time_after_first(self, duration: Duration, event: Event, state: State) -> _Found:
        return self.exactly_after(state, duration, event)

    def time_after_without(self, duration: Duration, event: State, avoided: State, state: State) -> _Found:
        """Return the rule of `2 s after a without c, b`."""
        free = State(f"(not {avoided.at(ATOM)} since {event.at(ATOM)})")
        return self._long_after(state, duration, event, free)

    def _late(self, event: Event, asked: Asked, duration: Duration) -> list[Reading]:
        """Return the readings of `when a, b after 5 s`: at that step, up to it, or from it on."""
        state, answer = as_state(event), asked.answer
        if state is None or not are_simple(state, answer.state):
            return []
        begun, b = begun_text(state), answer.state
        later = f"once {begun} and time_since({begun}) >= {answer.time}"
        then = self._long_after(b, duration, State(begun))
        return [
            *(
                [replace(then, condition=f"if it must hold {answer.time} after the last `{begun}`, at that step")]
                if then
                else []
            ),
            Reading(
                (f"keep {begun} implies eventually within {answer.time} {b.at(ATOM)}",),
                f"if it may come earlier, at most {answer.time} later",
            ),
            Reading((f"keep {later} implies {b.at(OR)}",), f"if it must hold from then on, up to the next `{begun}`"),
        ]

    def _long_after(self, state: State, duration: Duration, event: State, free: State | None = None) -> Reading | None:
        steps = round(self.steps(duration), 6)
        if not steps.is_integer() or steps < 2:
            return None
        before = int(steps) - 1
        over = State(f"ends (once within {before} step{'s' * (before > 1)} {event.at(ATOM)})")
        if free is not None:
            over = joined([over, free], "and")
        return Reading(
            (f"keep {over.at(OR)} implies {state.at(OR)}",),
            f"if the {duration.text} count from the last step with `{event.text}`",
        )

    # A time before or after an event.

    def and_for_time_after(self, state: State, duration: Duration) -> State | None:
        """Return the condition of `a and for 2 s after`: a now, or at most so long ago."""
        return None if is_edge(state) else State(f"once within {duration.text} {state.at(ATOM)}")

    def long_before(self, state: State, duration: Duration) -> list[Asked] | None:
        """Return the readings of `a at least 30 s before`: the last a, or any of them."""
        if duration.is_steps or state.level > ATOM:
            return None
        a = state.at(ATOM)
        last = State(f"once {a} and time_since({state.text}) >= {duration.text}", AND)
        return [
            Asked(Answer("now", last), f"if the last `{state.text}` must be so long ago"),
            Asked(Answer("now", State(f"time_holding(once {a}) >= {duration.text}")), "if an earlier one counts, too"),
        ]

    def held_before(self, state: State, duration: Duration) -> Asked:
        asked = super().held_before(state, duration)
        self._lasted[asked.answer.state.text] = state
        return asked

    def held_before_or(self, state: State, duration: Duration, other: State) -> Asked:
        """Return the answer of `b for the last 2 s or c`."""
        held = self.held_before(state, duration).answer.state
        either = joined([held, other], "or")
        self._lasted[either.text] = state
        self._or_held[either.text] = held, other
        return Asked(Answer("now", either))

    def now_or_held(self, other: State, state: State, duration: Duration) -> Asked | None:
        """Return the answer of `c or b for at least 2 s`, if b has lasted until then."""
        if duration.is_steps or not are_simple(other, state):
            return None
        asked = self.held_before_or(state, duration, other)
        return replace(asked, condition=f"if `{state.text}` must have held for {duration.text} by then")

    def held_until_then(self, state: State, duration: Duration) -> Asked | None:
        """Return the answer of `when a, b for at least 2 s` that looks back, where b has lasted until then."""
        if state.level > ATOM or is_edge(state):
            return None
        held = State(f"time_holding({state.text}) >= {duration.text}")
        if duration.is_steps:
            held = State(f"historically for {duration.text} {state.text}")
        self._lasted[held.text] = state
        return Asked(Answer("now", held), f"if `{state.text}` must have held for so long by then")

    def lasting_from_to(self, state: State, least: Duration, most: Duration) -> list[list[Asked]] | None:
        """Return both answers of `when a, b for at least 2 s and at most 4 s`, from the step of a on."""
        state = self.settled.get(state.text, state)
        if is_edge(state) or state.level > ATOM or self.steps(least) > self.steps(most):
            return None
        return [[self.lasting(state, least), Asked(Answer("within", state.negated(), most.text))]]

    def lasting_for_durations(self, state: State, durations: Window) -> list[list[Asked]] | None:
        return self.lasting_from_to(state, *durations)

    def implies(self, event: Event, answers: list[Asked]) -> _Found:
        """Return the rule; what has only begun has not held for a time."""
        begun, lasted = as_state(event), self._lasted.get(answers[0].answer.state.text)
        if begun is not None and lasted is not None and begun.text in (lasted.text, begun_text(lasted)):
            return None
        is_ended = False
        if lasted is not None and begun is not None:
            is_ended = begun_text(begun) in (begun_text(lasted.negated()), f"ends {lasted.at(ATOM)}")
        if is_ended and not answers[1:]:
            # It ends at this step, so the time is that up to the step before.
            asked = answers[0]
            held, *others = self._or_held.get(asked.answer.state.text, (asked.answer.state,))
            before = joined([State(f"previously {held.at(ATOM)}"), *others], "or")
            condition = asked.condition if others else ""
            answers = [replace(asked, answer=replace(asked.answer, state=before), condition=condition)]
        if answers[0].late is not None:
            return self._late(event, answers[0], answers[0].late)
        if any(asked.late_window for asked in answers):
            return None if answers[1:] else self._looking_back(event, answers[0])
        return super().implies(_beginning(event, answers), answers)

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        if answers[0].late is not None:
            return self._late(event, answers[0], answers[0].late)
        if any(asked.late_window for asked in answers):
            return None if answers[1:] else self._looking_back(event, answers[0])
        return super().first(when, _beginning(event, answers), answers)

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        if answers[0].is_window and not answers[1:]:
            return self.first(when, event, answers)
        if answers[0].late is not None:
            return self._late(event, answers[0], answers[0].late)
        if any(asked.late_window for asked in answers):
            return None if answers[1:] else self._looking_back(event, answers[0])
        return super().last(answers, when, _beginning(event, answers))

    # Windows after an event.

    def durations_reversed(self, most: Duration, least: Duration) -> Window:
        return least, most

    def window_no_sooner(self, state: State, window: Window) -> list[Asked] | None:
        """Return the readings of `b no sooner than 1 s and no later than 4 s`: an earlier b, too, or none."""
        asked, least = super().window_after(state, window), window[0]
        if asked is None and not is_negative(state):
            return self._late_window(state, window)
        if not isinstance(asked, Asked) or not round(self.steps(least), 6).is_integer():
            return None
        free = f"always for {least.text} {state.negated().at(ATOM)}"
        strict = State(f"({free}) and {asked.answer.state.text}", AND)
        return [
            Asked(Answer("now", strict), f"if `{state.text}` must not come earlier", is_formula=True),
            replace(asked, condition=f"if `{state.text}` may come earlier, too"),
        ]

    def window_of_event(self, state: State, least: Duration, most: Duration, event: Event) -> _Found:
        asked = self.window_after(state, (least, most))
        answers = asked if isinstance(asked, list) else [asked] if asked is not None else []
        return [reading for one in answers for reading in all_readings(self.first("when", event, [one]))]

    def strict_window_of_event(self, state: State, window: Window, event: Event) -> _Found:
        readings = [self.first("when", event, [asked]) for asked in self.window_no_sooner(state, window) or ()]
        return [known for reading in readings for known in (reading if isinstance(reading, list) else [])]

    def within_stopped_until(self, state: State, duration: Duration, end: State) -> list[Asked] | None:
        """Return the answer of `speed < 1 within 5 s and then stays stopped until a`."""
        return self.within_and_until(state, duration, end) if any(sign in state.text for sign in _STOPPED) else None

    def window_before_from_to(self, state: State, last: Duration, first: Duration) -> Asked | None:
        return self.window_before(state, (last, first))

    # So long ago.

    def only_when_ago(self, state: State, event: State, sign: str, duration: Duration) -> _Found:
        """Return the readings of `b only if a was at least 5 s ago`: some a, or the last one."""
        if not are_simple(state, event) or is_negative(event) or begun_text(event) == begun_text(state):
            return None
        rule, seconds = f"keep {state.at(OR)} implies", self._time_text(duration)
        if sign == "<=":
            return Reading((f"{rule} once within {duration.text} {event.at(ATOM)}",))
        if sign not in (">=", ">") or not seconds:
            return None
        time = f"{sign} {seconds}"
        since = joined([State(f"once {event.at(ATOM)}"), State(f"time_since({event.text}) {time}")], "and")
        what = "at least" if sign == ">=" else "more than"
        return [
            Reading(
                (f"{rule} time_holding(once {event.at(ATOM)}) {time}",),
                f"if some `{event.text}` was {what} {duration.text} ago",
            ),
            Reading((f"{rule} {since.text}",), f"if the last `{event.text}` was, and none has come since then"),
        ]

    def no_sooner_after(self, state: State, duration: Duration, event: State) -> _Found:
        """Return the readings of `b no sooner than 5 s after a`: a must have come, or need not."""
        own = State(event.text.removeprefix("previously "))
        if begun_text(own) == begun_text(state):
            return apart(own, duration)
        readings = self.only_when_ago(state, event, ">=", duration)
        if not isinstance(readings, list):
            return None
        clause = f"keep {state.at(OR)} implies time_since({event.text}) >= {self._time_text(duration)}"
        free = f"if no `{event.text}` may be less than {duration.text} ago, and none need have come"
        return [Reading((clause,), free), *readings]

    def avoid_soon(self, state: State, duration: Duration, event: Event) -> _Found:
        """Return the rule of `b cannot happen within 5 s of a`."""
        return self.last([self.never_within(state, duration)], "after", event)

    def avoid_sooner(self, state: State, duration: Duration, event: Event) -> _Found:
        """Return the rule of `no b less than 5 s after a`."""
        return self.last([self.never_for(state, duration)], "after", event)

    def _time_text(self, duration: Duration) -> str:
        """Return a time in seconds, rounded down, so that no further step is needed; "" if the clock varies."""
        if not duration.is_steps:
            return duration.text
        return f"{floor(float(duration.number) * self._step_s * 1e6) / 1e6:.10g} s" if self._step_s else ""


def _plain(text: str) -> str:
    return text.replace("(", "").replace(")", "")


def _beginning(event: Event, answers: list[Asked]) -> Event:
    """Return the beginning of an event after which something lasts for at least 2 s and at most 4 s; else the event.

    Asked for at each step of an event that lasts, the end would come too late for its last step or for its first.
    """
    state, first, last = as_state(event), answers[0].answer, answers[-1].answer
    is_limited = (first.kind, last.kind) == ("lasting", "within") and last.state.text == first.state.negated().text
    if state is None or not is_limited or state.level > ATOM or is_edge(state):
        return event
    return State(f"begins {state.at(ATOM)}")
