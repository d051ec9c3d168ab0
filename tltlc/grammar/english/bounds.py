"""Rules with an end, such as `a until b or 5 s`, and with a number of steps, such as `a only after 3 steps`."""

from __future__ import annotations

from math import floor
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.english.again import Again, beginnings
from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, When, begun_text
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_MOST_STEPS: Final = 4
"""The most steps with a condition of which a clause counts each."""

_Found = Reading | list[Reading] | None


@record
class Ending:
    """What ends a rule: an event or a time, whichever is first."""

    state: State
    duration: Duration


class Bounds(Again):
    """Rules that hold until an event or for a time, and rules that need a number of steps before them."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._endings: dict[str, tuple[State, Ending]] = {}
        """Maps the answers of `no a until b or for 5 s` to what they forbid, and to what ends them."""

    # Until an event or for a time.

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        """Return the meanings of a rule; a second a in `after a, no a until b or for 5 s` may come a step later."""
        state = as_state(event)
        forbidden, ending = self._endings.get(answers[0].answer.state.text, (None, None))
        if state is None or forbidden is None or ending is None or begun_text(forbidden) != begun_text(state):
            return super().first(when, event, answers)
        if answers[1:]:
            return None
        return [
            Reading((f"keep {again.at(OR)} implies weak_next ({_ended(again.negated(), ending).text})",), what)
            for again, what in beginnings(state)
        ]

    def ending(self, state: State, duration: Duration) -> Ending:
        return Ending(state, duration)

    def ending_time_first(self, duration: Duration, state: State) -> Ending:
        return Ending(state, duration)

    def until_ending(self, state: State, ending: Ending) -> Asked:
        """Return the answer of `a until b or for 5 s`."""
        state = self.settled.get(state.text, state)
        asked = Asked(Answer("now", _ended(state, ending)), is_formula=True)
        self._endings[asked.answer.state.text] = (state.negated(), ending)
        return asked

    def never_until_ending(self, state: State, ending: Ending) -> Asked:
        return self.until_ending(state.negated(), ending)

    def first_until_ending(self, ending: Ending, state: State) -> Asked:
        return self.until_ending(state, ending)

    def keep_until_ending(self, state: State, ending: Ending) -> Reading:
        return Reading((f"require {_ended(self.settled.get(state.text, state), ending).text}",))

    def avoid_until_ending(self, state: State, ending: Ending) -> Reading:
        return self.keep_until_ending(state.negated(), ending)

    # After a number of steps.

    def only_after_steps_with(self, state: State, *rest: str | Duration | State) -> _Found:
        """Return the rule of `a only after at least 3 steps with b`, which may lie apart."""
        sign, duration, condition = rest[0] if len(rest) > 2 else ">=", *rest[-2:]
        if not isinstance(duration, Duration) or not isinstance(condition, State) or sign not in (">=", ">"):
            return None
        if not duration.is_steps or not duration.number.isdecimal():
            return None
        number = int(duration.number) + (sign == ">")
        if number > _MOST_STEPS:
            self._say_how_to_count(state, number, condition)
            return None
        counted = State(f"once {condition.at(ATOM)}")
        for _ in range(number - 1):
            counted = State(f"once ({joined([condition, State(f'previously {counted.text}')], 'and').text})")
        return Reading((f"keep {state.at(OR)} implies {counted.text}",)) if number else None

    def only_after_steps_of(self, state: State, *rest: str | Duration | State) -> _Found:
        """Return the readings of `a only after 3 steps of b`: any of them, or in a row."""
        apart, condition, duration = self.only_after_steps_with(state, *rest), rest[-1], rest[-2]
        if not isinstance(apart, Reading) or not isinstance(condition, State) or not isinstance(duration, Duration):
            return None
        number = apart.clauses[0].count("once ")
        if number < 2:
            return apart
        row = condition
        for _ in range(number - 1):
            row = joined([condition, State(f"previously {row.at(ATOM)}")], "and")
        return [
            Reading(apart.clauses, "if the steps may lie apart"),
            Reading((f"keep {state.at(OR)} implies once ({row.at(AND)})",), "if they must follow one another"),
        ]

    def _say_how_to_count(self, state: State, number: int, condition: State) -> None:
        rule, inner = f"keep {state.at(OR)} implies", condition.text
        # Rounded down, so that no further step is needed.
        time = f"{floor(number * self._step_s * 1e6) / 1e6:.10g} s"
        total = (
            f", `{rule} total_time({inner}) >= {time}` adds up the lengths of the steps, and the first step of play "
            "has none"
            if self._step_s
            else ""
        )
        self.limits.append(
            f"no short clause can count {number} steps with `{inner}`: `{rule} times({inner}) >= {number}` counts how "
            f"often `{inner}` begins, steps in a row once{total}; to count the steps, let the game supply the number"
        )


def _ended(state: State, ending: Ending) -> State:
    a, b = state.at(ATOM), ending.state.at(ATOM)
    return State(f"(always for {ending.duration.text} {a}) or ({a} weak_until {b})", OR)
