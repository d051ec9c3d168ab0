"""What rules mean that ask for a count at an event: `a implies at least 3 b since the last a`."""

from __future__ import annotations

import re
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.rules import Reading, begun_text
from tltlc.grammar.english.sequels import Sequels
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_SINCE: Final = re.compile(r"times_since\(.*\) (?:<=|>=|<|>|==) \d+")
"""How often something has begun since an event, compared with a number."""

_UPPER: Final = re.compile(r"(<=|<)( \d+)$")
"""The sign and the number of an upper limit."""
_Found = Reading | list[Reading] | None


class CountsSince(Sequels):
    """The meanings of the rules that ask for a count since an event."""

    def count_now(self, state: State) -> Asked | None:
        """Return the answer of `at least 3 b since the last a`."""
        return Asked(Answer("now", state)) if isinstance(state, State) else None

    def _answers_at(self, event: Event, answers: list[Asked]) -> list[Asked] | None:
        """Return answers at the steps of an event: a count since that event is the one of the step before."""
        state = as_state(event)
        known = super()._answers_at(event, answers)
        if state is None or known is None:
            return known
        return [
            replace(asked, answer=replace(asked.answer, state=before), is_formula=True, is_once=True)
            if (before := _before(state, asked.answer.state)) is not None
            else asked
            for asked in known
        ]

    def only_when(self, state: State, event: Event) -> _Found:
        if _names_own_count(state, event):
            return self._needs_count(state, event)
        return super().only_when(state, event)

    def only_after(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        if _names_own_count(state, event) or (condition is not None and _is_count(condition)):
            return self._needs_count(state, event)
        return super().only_after(state, event)

    def needs_count(self, state: State, condition: State) -> _Found:
        return self._needs_count(state, condition)

    def _needs_count(self, state: State, event: Event) -> Reading | None:
        """Return the rule of `a only after at least 3 b since the last a`; None for other conditions."""
        condition = as_state(event)
        if condition is None or not _is_count(condition):
            return None
        before = _before(state, condition)
        if before is None:
            return Reading((f"keep {state.at(OR)} implies {condition.text}",))
        return Reading((f"keep {begun_text(state)} implies {before.text}",))


def _before(event: State, condition: State) -> State | None:
    """Return a count since an event at the step before, which the event itself would begin anew; else None."""
    if not _is_count(condition) or not _names_own_count(event, condition):
        return None
    least = _UPPER.sub(lambda sign: NEGATED_SIGN[sign[1]] + sign[2], condition.text)
    if least != condition.text:  # at the first step, there is no step before
        return State(f"not previously ({least})", ATOM)
    return State(f"previously ({condition.text})", ATOM)


def _names_own_count(event: State, condition: Event) -> bool:
    """Whether a condition of an event has a count since that event, perhaps beside another condition."""
    state = as_state(condition)
    events = (event.text, event.text.removeprefix("begins "), begun_text(event))
    is_counted = state is not None and "times_since(" in state.text
    return state is not None and is_counted and any(f", {text}) " in state.text for text in events)


def _is_count(condition: State) -> bool:
    return condition.level == ATOM and _SINCE.fullmatch(condition.text) is not None
