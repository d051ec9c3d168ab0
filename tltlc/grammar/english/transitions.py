"""What rules about changes mean: which values may not follow which, what stays, and how numbers change."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.quantities import Change, Number
from tltlc.grammar.english.rules import Reading, Rules
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, RULE, State


class Transitions(Rules):
    """The meanings of the rules about changes of an enum, of what stays, and of changes of numbers."""

    # Which values of an enum may follow each other.

    def move(self, *parts: Term) -> State | None:
        """Return the condition of `off -> full`: the step after the first value has the second."""
        name = parts[0] if parts[0].kind == "ENUM" else self.enum_of(*parts)
        start, end = parts[-2:]
        return None if name is None else self.enum_changes(name, start, end)

    def avoid_move(self, state: State) -> Reading:
        return Reading((f"avoid {state.text}",))

    def avoid_move_of(self, *parts: Term) -> Reading | None:
        state = self.move(*parts)
        return None if state is None else self.avoid_move(state)

    def avoid_number_move(self, term: Term, start: Term, end: Term) -> Reading:
        """Return the rule of `stage never goes from 0 to 2`."""
        return Reading((f"avoid previously ({term.text} == {start.text}) and {term.text} == {end.text}",))

    # What stays.

    def bare(self, state: State) -> Reading | list[Reading] | None:
        """Return the readings of a condition alone: a goal, or a rule for every step."""
        text = state.text
        if text in self.changing or text in self.settled or text.isidentifier() or is_negative(state):
            return None
        if any(f"{sign} {of}(" in text for sign in "<>" for of in ("previous", "highest", "lowest")):
            return None  # the first step does not meet it
        keep, reach = Reading((f"keep {text}",), "for every step"), Reading((f"reach {text}",), "if it is a goal")
        if "value_at(" in text:
            return self._of_value(state)
        is_most = state.opposite in (text.replace("<=", ">"), text.replace("<", ">="))
        if text.startswith(("times_since(", "total_time(")):
            return replace(keep if is_most else reach, condition="")
        if text.startswith("times("):
            return replace(keep if is_most else reach, condition=self.count_condition(text))
        is_extreme = any(f"{name}{since}(" in text for name in ("lowest", "highest") for since in ("", "_since"))
        if "previous(" in text or is_extreme or state.level == RULE or self.is_lasting:
            return replace(keep, condition="")
        if text.startswith("time_holding("):
            return replace(keep, condition="") if is_most else None
        return [reach, keep]

    def _of_value(self, state: State) -> list[Reading]:
        """Return the readings of a condition alone about the value of a number at an event."""
        text = state.text
        values = sorted((text.index(value), value) for value in self.values if value in text)
        _, first = values[0]
        term, event = self.values[first]
        if len({self.values[value][1].text for _, value in values}) > 1 or event.text.startswith("ends "):
            now = text.replace(first, term)
            keep = Reading((f"keep {event.at(OR)} implies {now}",), f"for each step with `{event.text}`")
            if event.text.startswith("ends "):
                return [replace(keep, condition="")]
            return [keep, Reading((f"reach {event.at(AND)} and {now}",), "if it is a goal")]
        begun = event.text.removeprefix("begins ")
        keep = Reading((f"keep {text}",), "for every step, before the first event compared with the first step")
        if begun == event.text:
            return [Reading((f"reach {text}",), "if it is a goal"), keep]
        at_end = Reading((f"keep ends {begun} implies {state.at(OR)}",), f"if it is asked for where `{begun}` ends")
        if text in self.returning:
            later = f"keep begins {begun} implies next eventually {state.at(ATOM)}"
            return [at_end, Reading((later,), "if at some step after it began")]
        during = Reading((f"keep {begun} implies {state.at(OR)}",), f"for each step with `{begun}`")
        return [during, at_end, keep]

    def stays_so(self, state: State) -> Reading:
        state = self.settled.get(state.text, state)
        return Reading((f"keep {state.at(OR)} implies always {state.at(ATOM)}",))

    def stays_value(self, name: Term, value: Term, kept: Term) -> Reading | None:
        state = self.enum(name, value)
        return None if state is None or value.text != kept.text else self.stays_so(state)

    # Numbers.

    def as_at_start(self, sign: str, term: Term) -> State | None:
        return self.compared(Number(term.text, term), sign, self.initial(term))

    def as_many_as_at_start(self, term: Term) -> State | None:
        return self.as_at_start("==", term)

    def more_than_at_start(self, term: Term) -> State | None:
        return self.as_at_start(">", term)

    def less_than_at_start(self, term: Term) -> State | None:
        return self.as_at_start("<", term)

    def change_below(self, term: Term, change: Change, sign: str, step: Number) -> Asked | None:
        """Return the answer of `coins may not grow by more than 2`."""
        if sign == ">" and change == "varies":
            return Asked(Answer("now", State(f"abs({term.text} - previous({term.text})) <= {step.text}")))
        state = self.changes_by_compared(term, change, sign, step)
        return None if state is None else Asked(Answer("now", state.negated()))

    # What goes off.

    def goes_off(self, term: Term) -> list[Reading]:
        return [
            Reading((f"avoid {term.text}",), f"if `{term.text}` must not come"),
            Reading((f"avoid ends {term.text}",), "if it must not end"),
        ]
