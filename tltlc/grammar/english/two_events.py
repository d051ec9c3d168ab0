"""What rules about an event and the one before it mean: `no two a without b between`, `b at least 2 s since a`."""

from __future__ import annotations

from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.intervals import is_edge
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules, When, are_simple
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined


class TwoEvents(Rules):
    """The meanings of the rules about two events and what is between them."""

    # How many, without another event.

    def avoid_count_without(self, state: State, number: str | Term, other: State) -> Reading | None:
        """Return the rule of `never a twice without b in between`: each b begins a new count."""
        text = number if isinstance(number, str) else number.text
        if not text.isdecimal() or int(text) < 2 or not are_simple(state, other) or state == other:
            return None
        return Reading((f"keep times_since({state.text}, {other.text}) <= {int(text) - 1}",))

    def avoid_number_without(self, number: str | Term, state: State, other: State) -> Reading | None:
        return self.avoid_count_without(state, number, other)

    # The time between them.

    def elapsed_between(self, durations: tuple[Duration, Duration], event: State) -> State | None:
        least, most = (self.elapsed(sign, time, event) for sign, time in zip((">=", "<="), durations, strict=True))
        return None if least is None or most is None else joined([least, most], "and")

    def elapsed(self, sign: str, duration: Duration, event: State) -> State | None:
        """Return the condition of `at least 2 s since a begins`; a state that lasts has several such times."""
        if duration.is_steps or not is_edge(event) or event.level > ATOM:
            return None
        return State(f"time_since({event.text}) {sign} {duration.text}")

    def elapsed_at(self, when: When, event: Event, elapsed: State) -> Reading | None:
        """Return the rule of `when a ends, at least 2 s since a began`; the time since a itself is 0 at each a."""
        state = as_state(event)
        if state is None or when == "after" or f"time_since({state.text})" in elapsed.text:
            return None
        return Reading((f"keep {state.at(OR)} implies {elapsed.text}",))

    def elapsed_implied(self, event: Event, elapsed: State) -> Reading | None:
        return self.elapsed_at("when", event, elapsed)
