"""What the end of a rule adds to it: `when a, b for 3 s unless c`, `keep a implies b within 2 s while c`."""

from __future__ import annotations

from collections.abc import Callable

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, operated
from tltlc.grammar.english.changes import Changes
from tltlc.grammar.english.events import Event, Held, as_state, joined_events
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, When, all_readings, are_simple, begun_text
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined

_Found = Reading | list[Reading] | None


class Tails(Changes):
    """The meanings of `unless c` and `while c` behind a rule with a condition."""

    # Unless something holds.

    def answer_unless(self, asked: Asked, event: Event) -> list[list[Asked]] | None:
        """Return the answers of `b for 3 s unless c`: c at the step of the condition, in that time, or at each step."""
        excuse = as_state(event)
        is_open = asked.condition != "" and asked.until is None
        if excuse is None or is_open or asked.answer.keyword == "reach" or asked.answer.state.text in _both(excuse):
            return None
        first, in_time, each = self._at_first(asked, excuse), self._in_time(asked, excuse), self._at_each(asked, excuse)
        known = (in_time, first, each) if asked.answer.kind == "lasting" else (first, in_time, each)
        answers = [one for one in known if one is not None]
        is_clear = len(answers) == 1 and not answers[0].is_formula
        return [[replace(one, condition="" if is_clear else one.condition)] for one in answers]

    def answers_unless(self, *parts: Asked | Event) -> list[list[Asked]] | None:
        """Return the answers of `b for 3 s and d within 5 s unless c`, where c ends each of the times."""
        *times, exception = parts
        excuse = None if isinstance(exception, Asked) else as_state(exception)
        asked = [part for part in times if isinstance(part, Asked)]
        if excuse is None or any(one.answer.state.text in _both(excuse) for one in asked):
            return None
        excused = [one for one in (self._in_time(part, excuse) for part in asked) if one is not None]
        if len(excused) < len(asked):
            return None
        return [[replace(one, condition="", is_once=True) for one in excused]]

    def last_unless(self, answers: list[Asked], when: When, event: Event, exception: Event) -> _Found:
        """Return the rule of `b for 3 s when a unless c`."""
        asked = answers[0]
        is_avoided = asked.answer.kind == "always" and asked.answer.is_negative  # `avoid_when_unless` reads it
        if answers[1:] or is_avoided or (asked.answer.kind == "now" and not asked.is_formula):
            return None
        return self._each_last(self.answer_unless(asked, exception), when, event)

    def last_unless_then(self, answers: list[Asked], when: When, event: Event, exception: Event) -> _Found:
        """Return the rule of `b within 3 s after a unless c comes first`."""
        return self._each_last(self.answer_unless_then(answers[0], exception), when, event) if not answers[1:] else None

    def _each_last(self, excused: list[list[Asked]] | None, when: When, event: Event) -> list[Reading]:
        return [one for answers in excused or [] for one in all_readings(self.first(when, event, answers))]

    def answer_unless_then(self, asked: Asked, event: Event) -> list[list[Asked]] | None:
        """Return the answer of `b within 5 s unless c comes first`."""
        excuse = as_state(event)
        if excuse is None or asked.condition or asked.answer.keyword == "reach":
            return None
        if asked.answer.state.text in _both(excuse):
            return None
        answer = self._in_time(asked, excuse)
        return None if answer is None else [[replace(answer, condition="")]]

    def _at_first(self, asked: Asked, excuse: State) -> Asked | None:
        """Return the answer that an exception at the step of the condition excuses, and no later one."""
        answer, condition = asked.answer, f"if `{excuse.text}` counts only at the first step of that time"
        operator = {"within": f"eventually within {answer.time} ", "lasting": f"always for {answer.time} "}
        if answer.kind in operator:
            formula = f"{operator[answer.kind]}{answer.state.at(ATOM)}"
            return replace(_formula(f"{excuse.at(OR)} or ({formula})", condition, OR), is_timed=True)
        if answer.kind == "now" and asked.is_formula and asked.until is None:
            return _formula(f"{excuse.at(OR)} or ({answer.state.text})", condition, OR)
        return None

    def _in_time(self, asked: Asked, excuse: State) -> Asked | None:
        """Return the answer of which an exception ends the time."""
        answer, what = asked.answer, f"if `{excuse.text}`"
        if asked.until is not None:
            state, end = asked.until
            until = f"({state.at(ATOM)} weak_until {joined([end, excuse], 'or').at(ATOM)})"
            ends = (
                f"{what} ends it, too"
                if not asked.condition
                else f"{asked.condition}, and `{excuse.text}` ends it, too"
            )
            return replace(asked, answer=Answer("now", State(until)), condition=ends, until=None)
        if asked.denied is not None:
            until = f"({asked.denied.negated().at(ATOM)} until {excuse.at(ATOM)})"
            return _formula(f"({answer.state.text}) or {until}", f"{what} ends that time", OR)
        if answer.kind == "within":
            both = joined([answer.state, excuse], "or")
            return Asked(Answer("within", both, answer.time), f"{what} in that time is enough")
        if answer.kind == "always" and not answer.is_negative:
            until = f"({answer.state.at(ATOM)} weak_until {excuse.at(ATOM)})"
            return _formula(until, f"{what} ends it for good")
        if answer.kind == "lasting":
            lasting = f"(always for {answer.time} {answer.state.at(ATOM)})"
            until = f"({answer.state.at(ATOM)} until {excuse.at(ATOM)})"
            return _formula(f"{lasting} or {until}", f"{what} ends that time", OR)
        return None

    def _at_each(self, asked: Asked, excuse: State) -> Asked | None:
        """Return the answer of which an exception excuses its own steps."""
        answer, condition = asked.answer, f"if it excuses the steps with `{excuse.text}` alone"
        excused = joined([answer.state, excuse], "or")
        if asked.operated is not None:
            operator, operand = asked.operated
            return _formula(f"{operator} {joined([operand, excuse], 'or').at(ATOM)}", condition)
        if answer.kind == "lasting":
            return _formula(f"always for {answer.time} {excused.at(ATOM)}", condition)
        if answer.kind == "always" and not answer.is_negative:
            return _formula(f"always {excused.at(ATOM)}", f"if it goes on after each `{excuse.text}`")
        is_simple = are_simple(answer.state) and answer.state.text not in self.changing  # `now_unless` reads it
        if answer.kind == "always" or (answer.kind == "now" and not asked.is_formula and not is_simple):
            return Asked(Answer("now", excused), condition)
        return None

    def lasting_from_to_unless(
        self, state: State, least: Duration, most: Duration, event: Event
    ) -> list[list[Asked]] | None:
        """Return the answers of `b for at least 2 s and at most 4 s unless c`, which ends the least time."""
        excuse, lasting = as_state(event), self.lasting(state, least)
        shorter = None if excuse is None else self._in_time(lasting, excuse)
        if shorter is None or state.level > ATOM or self.steps(least) > self.steps(most):
            return None
        ends = operated(f"eventually within {most.text}", state.negated())
        return [[replace(shorter, condition="", is_once=True), replace(ends, is_once=True)]]

    # While something holds.

    def first_while_last(self, when: When, event: Event, answers: list[Asked], condition: State) -> _Found:
        """Return the rule of `when a, b while c`."""
        return self._while(event, answers, condition, lambda joint, asked: self.first(when, joint, asked))

    def last_while(self, answers: list[Asked], when: When, event: Event, condition: State) -> _Found:
        """Return the rule of `b when a while c`."""
        return self.first_while_last(when, event, answers, condition)

    def implied_while(self, event: Event, answers: list[Asked], condition: State) -> _Found:
        """Return the rule of `keep a implies b while c`."""
        return self._while(event, answers, condition, self.implied)

    def implied_while_first(self, event: Event, condition: State, answers: list[Asked]) -> _Found:
        """Return the rule of `keep a while c implies b`."""
        return self._event_while(event, condition, lambda joint: self.implied(joint, answers))

    def first_while(self, when: When, event: Event, condition: State, answers: list[Asked]) -> _Found:
        """Return the rule of `when a for 3 s while c, b`: c in all that time, or at its end."""
        return self._event_while(event, condition, lambda joint: self.first(when, joint, answers))

    def _event_while(self, event: Event, condition: State, rule: Callable[[Event], _Found]) -> _Found:
        joint = joined_events([event, condition], "and")
        if joint is None or not isinstance(event, Held) or event.sign in ("<", "<="):
            return None if joint is None else rule(joint)
        whole = Held(joined([event.state, condition], "and"), event.sign, event.duration)
        time = f"`{condition.text}` must hold"
        kinds = ((whole, f"if {time} all that time"), (joint, f"if {time} at the end of that time alone"))
        return [
            replace(one, condition=", and ".join(filter(None, (where, one.condition.removeprefix("if ")))))
            for held, where in kinds
            for one in all_readings(rule(held))
        ]

    def _while(
        self, event: Event, answers: list[Asked], condition: State, rule: Callable[[Event, list[Asked]], _Found]
    ) -> _Found:
        """Return the rule of `keep a implies b within 2 s while c`: c at the step of a, or as long as it lasts."""
        state, joint, asked = as_state(event), joined_events([event, condition], "and"), answers[0]
        if state is None or joint is None:
            return None
        if asked.is_formula and " always " in asked.answer.state.text:
            return None  # `b within 2 s and stays so while c`, which lasts as long as c
        if (
            state.text in (begun_text(condition), f"begins ({condition.text})")
            and asked.answer.kind == "within"
            and not answers[1:]
        ):
            return self._while_begun(asked, condition, all_readings(rule(event, [asked])))
        whole = all_readings(rule(joint, answers))
        is_timed = asked.answer.kind in ("within", "lasting") or asked.denied is not None or asked.until is not None
        shorter = self.answer_unless_then(asked, condition.negated()) if is_timed and not answers[1:] else None
        ended = all_readings(rule(joint, shorter[0])) if shorter else []
        if len(whole) != 1 or len(ended) != 1 or whole[0].condition:
            return whole
        return [
            replace(whole[0], condition=f"if `{condition.text}` counts at the step of `{state.text}`"),
            replace(ended[0], condition=f"if nothing is asked for once `{condition.text}` is over"),
        ]

    def _while_begun(self, asked: Asked, during: State, readings: list[Reading]) -> list[Reading]:
        """Return the readings of `when a begins, b within 2 s while a`: b from then on, or b once in that time."""
        time, b = asked.answer.time, asked.answer.state
        held = Reading(
            (f"keep time_holding({during.text}) >= {time} implies {b.at(OR)}",),
            f"if `{b.text}` must hold from {time} on, as long as `{during.text}` does",
        )
        return [
            held,
            *(replace(one, condition=f"if `{b.text}` at one step of that time is enough") for one in readings),
        ]


def _both(state: State) -> tuple[str, str]:
    return state.text, state.negated().text


def _formula(text: str, condition: str, level: int = ATOM) -> Asked:
    return Asked(Answer("now", State(text, level)), condition, is_formula=True)
