"""What rules about windows of time mean: `b no sooner than 1 s and no later than 4 s`, `b only if a was 5 s ago`."""

from __future__ import annotations

from math import floor
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.events import Event
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules, are_simple
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_Window = tuple[Duration, Duration]
_Found = Reading | list[Reading] | None
_STOPPED: Final = (" < ", " <= ", " == 0")
"""What stands in conditions of numbers that are small."""


class EventWindows(Rules):
    """The meanings of the rules about windows of time after an event, and about events so long ago."""

    # Windows after an event.

    def durations_reversed(self, most: Duration, least: Duration) -> _Window:
        return least, most

    def window_no_sooner(self, state: State, window: _Window) -> list[Asked] | None:
        """Return the readings of `b no sooner than 1 s and no later than 4 s`: an earlier b, too, or none."""
        asked, least = self.window_after(state, window), window[0]
        if asked is None or not round(self.steps(least), 6).is_integer():
            return None
        free = f"always for {least.text} {state.negated().at(ATOM)}"
        strict = State(f"({free}) and {asked.answer.state.text}", AND)
        return [
            Asked(Answer("now", strict), f"if `{state.text}` must not come earlier", is_formula=True),
            replace(asked, condition=f"if `{state.text}` may come earlier, too"),
        ]

    def window_of_event(self, state: State, least: Duration, most: Duration, event: Event) -> _Found:
        asked = self.window_after(state, (least, most))
        return None if asked is None else self.first("when", event, [asked])

    def strict_window_of_event(self, state: State, window: _Window, event: Event) -> _Found:
        readings = [self.first("when", event, [asked]) for asked in self.window_no_sooner(state, window) or ()]
        return [known for reading in readings for known in (reading if isinstance(reading, list) else [])]

    def within_stopped_until(self, state: State, duration: Duration, end: State) -> list[Asked] | None:
        """Return the answer of `speed < 1 within 5 s and then stays stopped until a`."""
        return self.within_and_until(state, duration, end) if any(sign in state.text for sign in _STOPPED) else None

    # So long ago.

    def only_when_ago(self, state: State, event: State, sign: str, duration: Duration) -> _Found:
        """Return the readings of `b only if a was at least 5 s ago`: some a, or the last one."""
        if not are_simple(state, event) or is_negative(event):
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
        readings = self.only_when_ago(state, event, ">=", duration)
        if not isinstance(readings, list):
            return None
        clause = f"keep {state.at(OR)} implies time_since({event.text}) >= {self._time_text(duration)}"
        free = f"if no `{event.text}` may be less than {duration.text} ago, and none need have come"
        return [Reading((clause,), free), *readings]

    def _time_text(self, duration: Duration) -> str:
        """Return a time in seconds, rounded down, so that no further step is needed; "" if the clock varies."""
        if not duration.is_steps:
            return duration.text
        return f"{floor(float(duration.number) * self._step_s * 1e6) / 1e6:.10g} s" if self._step_s else ""
