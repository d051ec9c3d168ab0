"""What the rules about events that come again mean: `after a, no a until b`, `a again only after b`."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.doubts import denies_its_own_event
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.rules import Reading, When, are_simple, begun_text
from tltlc.grammar.english.sequels import Sequels
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State

_Found = Reading | list[Reading] | None


class Again(Sequels):
    """The meanings of the rules about events that come again."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._seconds: set[str] = set()
        """The answers of `no second a until b`, which are about an a behind another one."""

    def only_after(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        if not self.is_again or condition is None or not are_simple(state, condition):
            return None if self.is_again else super().only_after(state, event)
        return [
            Reading(
                (
                    f"keep {again.at(AND)} and previously once {again.at(ATOM)} implies "
                    f"{self._since_last(condition, again).text}",
                ),
                what,
            )
            for again, what in beginnings(state)
        ]

    def avoid_second(self, state: State, event: Event) -> _Found:
        self.is_again = True
        return self.only_after(state, event)

    def only_when(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        if not self.is_again:
            return super().only_when(state, event)
        if condition is None or not are_simple(state):
            return None
        readings = []
        for again, what in beginnings(state):
            known = self.at_steps_of(state, condition)
            if known is not None:
                clause = f"keep {again.at(AND)} and previously once {again.at(ATOM)} implies {known.at(OR)}"
                readings.append(Reading((clause,), what))
        return readings

    def _since_last(self, state: State, event: State) -> State:
        since = self.at_steps_of(event, self.since(state, event))
        assert since is not None
        return since

    # No second one until something else.

    def avoid_until(self, state: State, end: State) -> _Found:
        if not self.is_again:
            return super().avoid_until(state, end)
        return _not_again_until(state, end) if are_simple(state, end) else None

    def avoid_second_until(self, state: State, end: State) -> _Found:
        """Return the readings of `no second a until b`."""
        return _not_again_until(state, end) if are_simple(state) else None

    def never_second_until(self, state: State, end: State) -> Asked:
        asked = self.never_until(state, end)
        self._seconds.add(asked.answer.state.text)
        return asked

    def keep_after_until(self, state: State, start: State, end: State) -> _Found:
        if are_simple(start) and begun_text(state.negated()) == begun_text(start):
            return _not_again_until(start, end)
        return super().keep_after_until(state, start, end)

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        if self._is_again(event, answers):
            return self._again_until(event, answers)
        return super().first(when, event, answers)

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        if self._is_again(event, answers):
            return self._again_until(event, answers)
        return super().last(answers, when, event)

    def implies(self, event: Event, answers: list[Asked]) -> _Found:
        if self._is_again(event, answers):
            return self._again_until(event, answers)
        return super().implies(event, answers)

    def _is_again(self, event: Event, answers: list[Asked]) -> bool:
        """Whether an answer forbids the event of its own rule until something else, or a second event."""
        state, formula = as_state(event), answers[0].answer.state.text
        if state is None or not answers[0].is_formula:
            return False
        if state.level > ATOM and denies_its_own_event(state.text, formula):
            return True
        texts = [state.negated().text, f"not {state.at(ATOM).removeprefix('begins ')}"]
        denied = tuple(f"({text} {name} " for text in texts for name in ("weak_until", "until"))
        return formula.startswith(denied) or formula in self._seconds

    def _again_until(self, event: Event, answers: list[Asked]) -> _Found:
        """Return the readings of `after a, no a until b`; None of `after a, no second b until c`, of two events."""
        state, until = as_state(event), answers[0].until
        formula = answers[0].answer.state.text
        is_compound = state is not None and state.level > ATOM and not answers[1:]
        if state is not None and is_compound and denies_its_own_event(state.text, formula):
            again = Reading((f"keep {state.at(OR)} implies weak_next {formula}",))
            if not self.is_before or until is None:
                return again
            kept, end = until
            not_again = replace(again, condition=f"if `{kept.negated().text}` must not hold again before `{end.text}`")
            return [_ended_before(state, kept, end), not_again]
        if state is None or until is None or answers[1:] or not are_simple(state):
            return None
        kept, end = until
        if begun_text(kept.negated()) != begun_text(state):
            return None
        readings = _not_again_until(state, end)
        if not self.is_before or not state.text.startswith("begins ") or len(readings) != 1:
            return readings
        not_again = replace(
            readings[0], condition=f"if `{kept.negated().text}` must not begin again before `{end.text}`"
        )
        return [_ended_before(state, kept, end), not_again]


def _ended_before(event: State, kept: State, end: State) -> Reading:
    """Return the rule of `when a begins, not a before b`, if it asks for the end of a."""
    first = f"({end.negated().at(ATOM)} weak_until {kept.at(ATOM)})"
    condition = f"if `{kept.text}` must come before `{end.text}`, or with it"
    return Reading((f"keep {event.at(OR)} implies {first}",), condition)


def _not_again_until(state: State, end: State) -> list[Reading]:
    return [
        Reading((f"keep {again.at(OR)} implies weak_next (not {again.at(ATOM)} weak_until {end.at(ATOM)})",), what)
        for again, what in beginnings(state)
    ]


def beginnings(state: State) -> list[tuple[State, str]]:
    """Return the beginning of an event, and the event if it is another one, with what tells them apart."""
    if state.text.startswith(("begins ", "ends ")):
        return [(state, "")]
    return [(State(begun_text(state)), "if steps in a row count once"), (state, "if each step counts")]
