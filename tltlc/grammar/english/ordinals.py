"""What the first, the second and further ones of an event mean: `no a until the third b`, `after the first b, c`."""

from __future__ import annotations

from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.rules import Reading, Rules, are_simple, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State


class Ordinals(Rules):
    """The meanings of events that are counted from the first step on."""

    def first_of_all(self, state: State) -> State | None:
        """Return the step of `the first a`; a later a is none."""
        return State(f"begins (once {state.at(ATOM)})") if are_simple(state) else None

    def first_of_name(self, term: Term) -> State | None:
        return self.first_of_all(State(term.text))

    def at_ordinal(self, event: State, answers: list[Asked]) -> Reading | list[Reading] | None:
        return self.first("when", event, answers)

    def first_time(self, state: State, answers: list[Asked]) -> Reading | list[Reading] | None:
        event = self.first_of_all(state)
        return None if event is None else self.at_ordinal(event, answers)

    def nth_of_all(self, number: str, state: State) -> State | None:
        """Return the step of `the third a`."""
        return State(f"begins (times({state.text}) >= {number})") if are_simple(state) else None

    def before_ordinal(self, state: State, event: State) -> Reading | None:
        """Return the rule of `a before the second b`."""
        return Reading((f"keep {event.text} implies once {state.at(ATOM)}",)) if are_simple(state) else None

    def avoid_second_ever(self, state: State) -> Reading | None:
        """Return the rule of `no second a`."""
        return Reading((f"keep times({state.text}) <= 1",)) if are_simple(state) else None

    def counted_in(self, state: State, number: str, during: State) -> State | None:
        """Return the step of `a 3 times in b`, where each b begins a new count."""
        if not are_simple(state, during):
            return None
        count = f"times_since({state.text}, {begun_text(during)}) >= {number}"
        return State(f"begins ({during.text} and {count})")

    def only_after_nth(self, state: State, number: str, event: State) -> Reading | None:
        """Return the rule of `a only after the third b`: that step, or a later one; b is not a itself."""
        if not are_simple(state, event) or state == event:
            return None
        return Reading((f"keep {state.at(OR)} implies times({event.text}) >= {number}",))
