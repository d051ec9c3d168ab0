"""What rules about a later time mean: `b between 1 s and 2 s later unless c`, `2 s after a, b`."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import MOST_STEPS, Asked, is_negative
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules, When, are_simple, begun_text
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined

Window = tuple[Duration, Duration]
_AT_NO_STEP: Final = "if it must hold at no step of that time"
_Found = Reading | list[Reading] | None


class LaterTimes(Rules):
    """The meanings of the rules about a step, or some steps, a time after an event."""

    # Answers between two times.

    def window_after(self, state: State, window: Window) -> Asked | list[Asked] | None:
        """Return the answers of `b between 1 s and 2 s later`; `not b` may ask for one step, or for all of them."""
        if not is_negative(state):
            return super().window_after(state, window)
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

    def window_unless(self, state: State, window: Window, event: Event) -> list[Asked] | None:
        """Return the readings of `b between 1 s and 2 s later unless c`."""
        exception = as_state(event)
        if exception is None or not are_simple(state, exception) or is_negative(state):
            return None
        either = super().window_after(joined([state, exception], "or"), window)
        alone = None if either is None else super().window_after(state, window)
        if not isinstance(either, Asked) or not isinstance(alone, Asked):
            return None
        excused = State(f"{exception.at(OR)} or ({alone.answer.state.text})", OR)
        return [
            replace(either, condition=f"if `{exception.text}` at a step of that time is enough"),
            replace(alone, answer=Answer("now", excused),
                    condition=f"if `{exception.text}` counts at the step of the condition alone"),
        ]  # fmt: skip

    def opposite_in_window(self, event: Event, state: State, window: Window, exception: Event | None = None) -> _Found:
        """Return the rule of `begins a implies not a between 1 s and 2 s later`: how long a lasts."""
        begun, lasting = as_state(event), state.negated()
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
        if asked is not None:
            return self.first("when", event, [asked])
        return None if condition is None else self._long_after(state, duration, condition)

    def time_after_first(self, duration: Duration, event: Event, state: State) -> _Found:
        return self.exactly_after(state, duration, event)

    def time_after_without(self, duration: Duration, event: State, avoided: State, state: State) -> _Found:
        """Return the rule of `2 s after a without c, b`."""
        free = State(f"(not {avoided.at(ATOM)} since {event.at(ATOM)})")
        return self._long_after(state, duration, event, free)

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


def _plain(text: str) -> str:
    return text.replace("(", "").replace(")", "")
