"""What answers with several times mean: `b within 1 s and b until c`, `within 3 s (b for 1 s)`, `next b for 1 s`."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record, replace
from tltlc.grammar.english.answers import Asked, is_negative, operated
from tltlc.grammar.english.events import Event, Held, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules, When, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_MOST_STEPS: Final = 10
"""The most steps of the first of two times, one after the other, if the second one may be any."""
_MOST_PAIRS: Final = 150
"""The most that the steps of both times may be multiplied, if the first one has more steps."""

_MOST_STEPS_UNTIL: Final = 50
"""The most steps within which an answer with `until` may begin in one clause."""

_Found = Reading | list[Reading] | None


@record
class Lasting:
    """An answer that begins within a time with a condition, and what is asked for from there on."""

    state: State
    duration: Duration
    answer: str


def _lasting(state: State, kept: State, duration: Duration, length: Duration) -> Lasting:
    return Lasting(state, duration, f"always for {length.text} {kept.at(ATOM)}")


class TimedAnswers(Rules):
    """The meanings of the rules for answers that last, come in a time, or stand in brackets."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._held: dict[str, Held] = {}
        """Maps the conditions of `(b for 1 s)` to b and the time."""
        self._lasting: dict[str, Lasting] = {}
        """Maps answers such as `b within 10 s, and then for 10 s` to their parts, where one clause has many states."""

    def bracketed(self, event: Event) -> State | None:
        state = super().bracketed(event)
        if state is not None and isinstance(event, Held) and event.sign in ("", ">="):
            self._held[state.text] = event
        return state

    def answers(self, *asked: Asked) -> list[list[Asked]]:
        """Return answers that are asked for together; none if one denies for a time what another asks for in it."""
        wanted = {one.answer.state.text for one in asked if one.answer.kind == "within"}
        denied = {one.answer.state.negated().text for one in asked if one.answer.kind in ("lasting", "always")}
        return [] if wanted & denied else super().answers(*asked)

    # Answers that last.

    def held_or_lasting(self, state: State, *rest: str | Duration) -> list[Asked] | None:
        """Return the readings of `a held for 4 s`: up to this step, or from it on."""
        sign, duration = rest[0] if len(rest) > 1 else ">=", rest[-1]
        assert isinstance(duration, Duration)
        held = as_state(Held(state, str(sign), duration))
        if held is None or sign not in (">=", ">") or is_negative(state):
            return None
        lasting = State(f"always for {duration.text} {state.at(ATOM)}")
        return [
            Asked(Answer("now", held), f"if `{state.text}` has held for {duration.text} up to that step"),
            Asked(Answer("now", lasting), "if it holds from that step on", is_formula=True),
        ]

    def never_enum_again(self, name: Term, value: Term) -> Asked | None:
        """Return the answer of `the door is never locked again`."""
        state = self.enum(name, value)
        if state is None:
            return None
        return Asked(Answer("now", State(f"always {state.negated().text}")), is_formula=True)

    def free_since(self, start: State, state: State, again: State) -> Asked | None:
        """Return the answer of `once a and no b since a`."""
        if start.text != again.text:
            return None
        return Asked(Answer("now", State(f"(not {state.at(ATOM)} since {start.at(ATOM)})")))

    # Answers that come in a time, and last.

    def within(self, state: State, duration: Duration) -> Asked | list[Asked]:
        held, settled = self._held.get(state.text), self.settled.get(state.text)
        if held is not None:
            return self.within_first_lasting(duration, held.state, held.duration)
        if settled is not None and state.text.startswith("ends "):
            return Asked(Answer("within", settled, duration.text))  # one step without it is enough
        first, _, second = state.text.partition(" and ")
        if state.level == AND and second in (
            f"ends {first}",
            f"not {first}",
        ):  # which are never true at the step of the first
            return Asked(Answer("now", State(f"{first} and eventually within {duration.text} {second}", AND)), "", True)
        return super().within(state, duration)

    def gone_within(self, term: Term, duration: Duration) -> Asked | list[Asked]:
        """Return the answer of `the shield is gone within 5 s`: one step without it."""
        return self.within(self.ends(term), duration)

    def within_first_lasting(self, duration: Duration, state: State, length: Duration) -> list[Asked]:
        """Return the readings of `within 3 s, b for 1 s`: it begins in that time, or is over in it."""
        state = self.settled.get(state.text, state)
        lasting = State(f"always for {length.text} {state.at(ATOM)}")
        begun = Asked(
            Answer("now", State(f"eventually within {duration.text} {lasting.text}")),
            f"if `{state.text}` begins within {duration.text}, and then lasts {length.text}",
            is_formula=True,
        )
        self._note_lasting(begun, _lasting(state, state, duration, length), length)
        if length.is_steps or not 0 < self.steps(length) <= self.steps(duration):
            return [replace(begun, condition="")]  # it cannot be over in that time
        over = f"eventually within {duration.text} time_holding({state.text}) >= {length.text}"
        condition = f"if `{state.text}` may have begun before, and has held for {length.text} within {duration.text}"
        return [begun, Asked(Answer("now", State(over)), condition, is_formula=True)]

    def within_then_until(self, state: State, duration: Duration, kept: State, end: State) -> list[Asked]:
        state, kept = self.settled.get(state.text, state), self.settled.get(kept.text, kept)
        answers = super().within_then_until(state, duration, kept, end)
        for asked in answers if self.steps(duration) > _MOST_STEPS_UNTIL else ():
            until = asked.answer.state.text.removeprefix(f"{state.at(AND)} and ")
            self._lasting[asked.answer.state.text] = Lasting(state, duration, until)
        return answers

    def within_then_until_held(
        self, state: State, duration: Duration, kept: State, end: State, length: Duration
    ) -> list[Asked] | None:
        """Return the answers of `b within 1 s, and then c until d for 3 s`."""
        held = as_state(Held(end, ">=", length))
        return None if held is None else self.within_then_until(state, duration, kept, held)

    def within_stays_until_held(
        self, state: State, duration: Duration, end: State, length: Duration
    ) -> list[Asked] | None:
        return self.within_then_until_held(state, duration, state, end, length)

    def within_then_lasting(self, state: State, duration: Duration, kept: State, length: Duration) -> Asked:
        state, kept = self.settled.get(state.text, state), self.settled.get(kept.text, kept)
        asked = super().within_then_lasting(state, duration, kept, length)
        self._note_lasting(asked, _lasting(state, kept, duration, length), length)
        return asked

    def within_lasting(self, state: State, duration: Duration, length: Duration) -> Asked | None:
        asked = super().within_lasting(state, duration, length)
        state = self.settled.get(state.text, state)
        if asked is not None:
            self._note_lasting(asked, _lasting(state, state, duration, length), length)
        return asked

    def _note_lasting(self, asked: Asked, lasting: Lasting, length: Duration) -> None:
        first = self.steps(lasting.duration)
        if not 0 < first <= _MOST_STEPS and not 0 < first * self.steps(length) <= _MOST_PAIRS:
            self._lasting[asked.answer.state.text] = lasting

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        return self._in_two(event, answers) or super().first(when, event, answers)

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        return self._in_two(event, answers) or super().last(answers, when, event)

    def implies(self, event: Event, answers: list[Asked]) -> _Found:
        return self._in_two(event, answers) or super().implies(event, answers)

    def keep_if(self, event: Event, answers: list[Asked]) -> _Found:
        return self._in_two(event, answers) or super().keep_if(event, answers)

    def _in_two(self, event: Event, answers: list[Asked]) -> Reading | None:
        """Return two clauses that ask for what lasts: that it begins in time, and that it lasts where it begins."""
        lasting, condition = self._lasting.get(answers[0].answer.state.text), as_state(event)
        if lasting is None or condition is None or answers[1:]:
            return None
        state, time = lasting.state, lasting.duration.text
        began = joined([condition, _beginning(state)], "or")
        start = joined([state, began, State(f"once within {time} {condition.at(ATOM)}")], "and")
        return Reading(
            (
                f"keep {condition.at(OR)} implies eventually within {time} {state.at(ATOM)}",
                f"keep {start.text} implies {lasting.answer}",
            ),
            answers[0].condition,
        )

    def within_and_kept_until(self, state: State, duration: Duration, kept: State, end: State) -> list[Asked]:
        """Return the readings of `b within 1 s and c until d`: c from b on, or from the condition on."""
        from_it = self.within_then_until(state, duration, kept, end)
        state = self.settled.get(state.text, state)
        if state == self.settled.get(kept.text, kept):
            return from_it
        until = self.until(kept, end)
        comes = State(f"(eventually within {duration.text} {state.at(ATOM)})")
        at_once = [
            replace(asked, answer=replace(asked.answer, state=joined([comes, asked.answer.state], "and")), until=None)
            for asked in (until if isinstance(until, list) else [until])
        ]
        return [
            *(_also(asked, f"`{kept.text}` must hold from `{state.text}` on") for asked in from_it),
            *(_also(asked, f"`{kept.text}` must hold from the condition on") for asked in at_once),
        ]

    def within_until(self, state: State, duration: Duration, end: State) -> list[Asked]:
        """Return the answers of `a within 1 s until b`."""
        return self.within_then_until(state, duration, state, end)

    def within_then_free(self, state: State, time: Duration, denied: State, length: Duration) -> Asked:
        if self.settled.get(state.text, state) == denied:
            free = State(f"weak_next always for {length.text} {denied.negated().at(ATOM)}")
            return Asked(Answer("within", joined([denied, free], "and"), time.text))
        return self.within_then_lasting(state, time, denied.negated(), length)

    def until_after(self, state: State, duration: Duration, end: State) -> list[Asked] | None:
        """Return the answers of `a until 2 s after b`: a until b, and for that time from b on."""
        if end.level > ATOM or is_negative(end):
            return None
        a, last = state.at(ATOM), joined([end, State(f"always for {duration.text} {state.at(ATOM)}")], "and").at(ATOM)
        return [
            Asked(Answer("now", State(f"({a} weak_until {last})")), f"if play may end before `{end.text}`", True),
            Asked(Answer("now", State(f"({a} until {last})")), f"if `{end.text}` must come", True),
        ]

    def never_until_after(self, state: State, duration: Duration, end: State) -> list[Asked] | None:
        return self.until_after(state.negated(), duration, end)

    # Answers from the next step on.

    def weak_next_lasting(self, duration: Duration, state: State) -> Asked:
        return operated(f"weak_next always for {duration.text}", state)

    def next_lasting(self, state: State, duration: Duration) -> list[Asked]:
        lasting = f"always for {duration.text} {self.settled.get(state.text, state).at(ATOM)}"
        return [
            Asked(Answer("now", State(f"weak_next {lasting}")), "if play may end at the step of the condition", True),
            Asked(Answer("now", State(f"next {lasting}")), "if there must be a next step", True),
        ]

    def next_first_lasting(self, duration: Duration, state: State) -> list[Asked]:
        return self.next_lasting(state, duration)

    # Answers in brackets.

    def now(self, state: State) -> Asked:
        asked = super().now(state)
        is_held = any(text in state.text for text in self._held)
        return replace(asked, condition="if it must have lasted until then") if is_held else asked

    def lasting_in_brackets(self, state: State, duration: Duration) -> Asked:
        """Return the answer of `(b for 1 s)`, which may also say how long b has lasted."""
        return replace(self.lasting(state, duration), condition="if it must last from then on")

    def either(self, asked: Asked, state: State) -> Asked:
        """Return the answer of `(b within 2 s) or c`."""
        known = _as_formula(asked)
        return replace(known, answer=replace(known.answer, state=joined([known.answer.state, state], "or")))

    def within_or(self, state: State, duration: Duration, other: State) -> list[Asked] | None:
        """Return the readings of `b within 2 s or c`: the time is for b alone, or for both."""
        alone, both = self.within(state, duration), self.within(joined([state, other], "or"), duration)
        if not isinstance(alone, Asked) or not isinstance(both, Asked):
            return None
        return [
            replace(both, condition=f"if the time is for `{other.text}`, too"),
            replace(self.either(alone, other), condition=f"if the time is for `{state.text}` alone"),
        ]

    def within_first_or(self, duration: Duration, state: State, other: State) -> Asked | None:
        """Return the answer of `(within 2 s b) or c`."""
        asked = self.within(state, duration)
        return self.either(asked, other) if isinstance(asked, Asked) else None

    def either_now_first(self, state: State, asked: Asked) -> Asked:
        known = _as_formula(asked)
        return replace(known, answer=replace(known.answer, state=joined([state, known.answer.state], "or")))

    def both(self, asked: Asked, state: State) -> Asked:
        """Return the answer of `(b within 2 s) and c`."""
        known = _as_formula(asked)
        return replace(known, answer=replace(known.answer, state=joined([known.answer.state, state], "and")))

    # What has held before.

    def just_before(self, state: State, *rest: str | Duration) -> State | None:
        """Return the condition of `b held for at least 1 s just before`."""
        sign = rest[0] if isinstance(rest[0], str) else ">="
        duration = rest[-1]
        assert isinstance(duration, Duration)
        if sign not in (">", ">=") or duration.is_steps:
            return None
        return State(f"previously time_holding({state.text}) {sign} {duration.text}")

    def just_before_without(self, held: State, avoided: State, start: State) -> State | None:
        """Return the condition of `b held for at least 1 s just before, with no c since begins b`."""
        if max(avoided.level, start.level) > ATOM or is_negative(avoided):
            return None
        return joined([held, State(f"(not {avoided.at(ATOM)} since {start.at(ATOM)})")], "and")


def _beginning(state: State) -> State:
    denied = state.text.removeprefix("not ")
    return State(f"ends {denied}") if denied != state.text and state.level == ATOM else State(begun_text(state))


def _as_formula(asked: Asked) -> Asked:
    """Return an answer as a formula in brackets."""
    answer = asked.answer
    operator = {"within": f"eventually within {answer.time} ", "lasting": f"always for {answer.time} "}.get(answer.kind)
    text = answer.state.at(OR) if operator is None else f"{operator}{answer.state.at(ATOM)}"
    return replace(asked, answer=Answer("now", State(f"({text})")), is_formula=True)


def _also(asked: Asked, what: str) -> Asked:
    """Return a reading with what tells it apart before its own condition."""
    condition = asked.condition.removeprefix("if ")
    return replace(asked, condition=f"if {what}, and {condition}" if condition else f"if {what}")
