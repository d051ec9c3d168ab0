"""What the rules about the highest and the lowest value of a number mean: `hp never more than 20 below its highest`."""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record
from tltlc.grammar.english.changes import Changes
from tltlc.grammar.english.quantities import MIRRORED, Change, Number, comparison
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import State


@record
class Extreme:
    """The highest or the lowest value of a number so far, or since an event."""

    name: Literal["highest", "lowest"]
    event: State | None = None


class Extremes(Changes):
    """The meanings of the rules that compare a number with its highest or lowest value."""

    def own_highest(self, event: State | None = None) -> Extreme:
        return Extreme("highest", event)

    def own_lowest(self, event: State | None = None) -> Extreme:
        return Extreme("lowest", event)

    def apart_from_extreme(self, term: Term, sign: str, step: Number, extreme: Extreme) -> State | None:
        """Return the condition of `hp is at most 20 above its lowest`, or below its highest."""
        value = self._value_of(term, extreme)
        if value is None:
            return None
        operator, mirrored = ("+", sign) if extreme.name == "lowest" else ("-", MIRRORED[sign])
        return comparison(Number(term.text, term), mirrored, Number(f"{value.text} {operator} {step.text}", term))

    def never_apart_from_extreme(self, term: Term, *rest: Change | Number | Extreme) -> State | None:
        *_, sign, step, extreme = rest
        assert isinstance(sign, str) and isinstance(step, Number) and isinstance(extreme, Extreme)
        state = self.apart_from_extreme(term, sign, step, extreme)
        return None if state is None else state.negated()

    def near_extreme(self, term: Term, step: Number, extreme: Extreme) -> State | None:
        return self.apart_from_extreme(term, "<=", step, extreme)

    def _value_of(self, term: Term, extreme: Extreme) -> Number | None:
        if extreme.event is None:
            return self.highest(term) if extreme.name == "highest" else self.lowest(term)
        since = self.highest_since if extreme.name == "highest" else self.lowest_since
        return since(term, extreme.event)
