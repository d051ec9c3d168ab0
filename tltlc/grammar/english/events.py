"""What conditions are that last, are counted, or begin where a number crosses a limit."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.record import record
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN


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


def joined_events(events: Sequence[Event], operator: str) -> State | None:
    """Return what `and` or `or` makes of several events; None if one is more than a condition."""
    states = [as_state(event) for event in events]
    known = [state for state in states if state is not None]
    return joined(known, operator) if len(known) == len(states) else None
