"""What rules with two cases mean (`a implies b, otherwise c`), and rules for an event that has lasted."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.intervals import changing, is_edge
from tltlc.grammar.english.quantities import Duration, Number, comparison
from tltlc.grammar.english.rules import Reading, Rules, When, are_simple
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import ATOM, State, joined

_Found = Reading | list[Reading] | None


class Alternatives(Rules):
    """The meanings of the rules with two cases, and of the events that come after so long a time."""

    def otherwise(self, when: When, event: Event, answers: list[Asked], others: list[Asked]) -> _Found:
        """Return the rules of `if a, b, otherwise c`: one for the steps with a, and one for those without it.

        `if a begins` may mean its first step or all steps of a, unless the answers compare a number with its last.
        """
        state = as_state(event)
        if any(asked.answer.time for asked in (*answers, *others)):
            return None  # `b within 2 s, otherwise c` may ask for c where b does not come in time
        if when == "after" or state is None:
            return None
        if not is_edge(state) or all(map(_says_next_value, (*answers, *others))):
            return self._two_cases(state, answers, others)
        lasting = changing(state) if state.text.startswith("begins ") else changing(state).negated()
        at_once, throughout = (self._two_cases(case, answers, others) for case in (state, lasting))
        if at_once is None or throughout is None:
            return None
        return [
            replace(throughout, condition=f"if they are for the steps with and without `{lasting.text}`"),
            replace(at_once, condition=f"if the first is for the step of `{state.text}` alone"),
        ]

    def _two_cases(self, state: State, answers: list[Asked], others: list[Asked]) -> Reading | None:
        first, second = (
            self.implies(known, [*map(_at_this_step, asked)])
            for known, asked in ((state, answers), (state.negated(), others))
        )
        clauses: list[str] = []
        for answer in (first, second):
            readings = answer if isinstance(answer, list) else [] if answer is None else [answer]
            if len(readings) != 1 or readings[0].condition:
                return None
            clauses += readings[0].clauses
        return Reading(tuple(clauses))

    def otherwise_implies(self, event: Event, answers: list[Asked], others: list[Asked]) -> _Found:
        return self.otherwise("when", event, answers, others)

    def otherwise_last(self, answers: list[Asked], when: When, event: Event, others: list[Asked]) -> _Found:
        return self.otherwise(when, event, answers, others)

    # An event that has lasted so long.

    def ends_after(self, end: State, sign: str, duration: Duration) -> State | None:
        """Return the condition of `a ends after at least 2 s`: the step at which a has ended, so long after it began.

        The time from its first step to that step is the length of all its steps.
        """
        if not end.text.startswith("ends ") or duration.is_steps:
            return None
        begun = end.text.replace("ends ", "begins ", 1)
        return joined([State(end.text, ATOM), State(f"time_since({begun}) {sign} {duration.text}")], "and")

    def ended_behind(self, end: State, state: State, duration: Duration) -> State | None:
        """Return the condition of `a ends after a for at least 2 s`."""
        if not end.text.startswith("ends ") or duration.is_steps or not are_simple(state):
            return None
        return joined([end, State(f"previously (time_holding({state.text}) >= {duration.text})")], "and")

    # The ends of the range of a number.

    def is_full(self, term: Term) -> State | None:
        ends = Number(term.text, term).ends
        return comparison(Number(term.text, term), "==", Number(ends[1])) if len(ends) == 2 else None

    def is_empty(self, term: Term) -> State | None:
        ends = Number(term.text, term).ends
        return comparison(Number(term.text, term), "==", Number(ends[0])) if len(ends) == 2 else None


def _at_this_step(asked: Asked) -> Asked:
    """Return `no a` and `keep a` as answers for the step of their case alone, which ends the other one."""
    if asked.answer.kind == "now" and asked.answer.keyword == "keep":
        return replace(asked, answer=replace(asked.answer, keyword=""))
    if asked.is_formula or asked.answer.kind != "always" or not asked.answer.is_negative:
        return asked
    return replace(asked, answer=replace(asked.answer, kind="now", is_negative=False))


def _says_next_value(asked: Asked) -> bool:
    """Whether an answer says what a number is, compared with that of the step before: it has one at every step."""
    return asked.answer.kind == "now" and "previous(" in asked.answer.state.text
