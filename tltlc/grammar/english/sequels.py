"""What the rules mean that say what comes first: `when a, b before c`, `c only after b`, `b since the last a`."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.intervals import Span
from tltlc.grammar.english.quantities import Change, Duration, Number
from tltlc.grammar.english.rules import Reading, When, are_simple, begun_text
from tltlc.grammar.english.stretches import Stretches, each_reading, reached_states
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_Found = Reading | list[Reading] | None


class Sequels(Stretches):
    """The meanings of the rules about what comes before something else."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._conjoined: set[str] = set()
        """The opposites of conditions such as `a and b`, of which `no` may deny the first alone."""
        self._moments: set[str] = set()
        """The steps at which a time is over: what is asked for may hold later, too."""

    # The moment at which a time is over.

    def comparison(self, left: Number, sign: Term, right: Number) -> State | None:
        is_over = sign.text == "==" and _is_time(left)
        return self._over(left, right) if is_over else super().comparison(left, sign, right)

    def equal(self, left: Number, right: Number) -> State | None:
        return self._over(left, right) if _is_time(left) else super().equal(left, right)

    def _over(self, time: Number, length: Number) -> State:
        """Return the step at which a time is over, which may lie between two steps: it is not compared by `==`."""
        state = State(f"begins ({time.text} >= {length.text})")
        self._moments.add(state.text)
        return state

    def keep(self, state: State) -> _Found:
        return None if state.text in self._moments else super().keep(state)

    # Answers that come before something else.

    def before(self, state: State, end: State) -> Asked | list[Asked]:
        """Return the readings of `b before c` behind a condition: no c without b first, from the condition on."""
        if state.text.startswith("not "):
            return self.never_until(state.negated(), end)
        a, b = self.settled.get(state.text, state), end
        free, own = b.negated().at(ATOM), joined([a, b.negated()], "and")
        weak, strong, strict = (
            State(f"({free} {name} {goal.at(ATOM)})")
            for name, goal in (("weak_until", a), ("until", a), ("until", own))
        )
        once, anew = "asked where the condition begins", "asked anew at each step with the condition"
        same_step = f"before `{b.text}` or at the same step"
        first = f"if `{a.text}` must come {same_step}, and neither need come"
        surely = f"if `{a.text}` must come, {same_step}"
        strictly = f"if `{a.text}` must come, at an earlier step than `{b.text}`"
        return [
            Asked(Answer("now", weak), f"{first}; {once}", True, is_once=True),
            Asked(Answer("now", strong), f"{surely}; {once}", True, is_once=True),
            Asked(Answer("now", weak), f"{first}; {anew}", True),
            Asked(Answer("now", strict), f"{strictly}; {anew}", True),
        ]

    def only_after_then(self, state: State, first: State) -> list[Asked]:
        """Return the readings of `b only after c` behind a condition: c from the condition on, or ever before."""
        b, c = state, first
        anew = State(f"({b.negated().at(ATOM)} weak_until {c.at(ATOM)})")
        ever = joined([b.negated(), State(f"once {c.at(ATOM)}")], "or")
        return [
            Asked(Answer("now", anew), f"if `{c.text}` must come after the condition", is_formula=True, is_once=True),
            Asked(
                Answer("now", State(f"({ever.text})")),
                f"if `{c.text}` may have come before the condition",
                is_formula=True,
            ),
        ]

    def needs_before(self, event: State, state: State, end: State) -> _Found:
        answers = self.before(state, end)
        return self._each_reading("each", event, answers if isinstance(answers, list) else [answers])

    def _each_reading(self, when: When, event: Event, answers: list[Asked]) -> list[Reading]:
        readings = [self.first(when, event, [asked]) for asked in answers]
        return [known for reading in readings for known in (reading if isinstance(reading, list) else [])]

    def surely_before(self, state: State, end: State) -> Asked | list[Asked] | None:
        answers = self.before(state, end)
        return replace(answers[1], condition="") if isinstance(answers, list) and len(answers) > 1 else None

    def before_in_time(self, state: State, end: State, duration: Duration) -> list[Asked] | None:
        if is_negative(state):
            return None
        a, free = self.settled.get(state.text, state).at(ATOM), end.negated().at(ATOM)
        surely = State(f"({free} until {a}) and eventually within {duration.text} {a}", AND)
        if_any = State(f"(always for {duration.text} {free}) or ({free} until {a})", OR)
        come = f"if `{state.text}` must come within {duration.text}, and `{end.text}` not before it"
        return [
            Asked(Answer("now", surely), come, is_formula=True, is_once=True),
            Asked(Answer("now", if_any), "if neither need come", is_formula=True, is_once=True),
        ]

    def in_time_before(self, state: State, duration: Duration, end: State) -> list[Asked] | None:
        answers = self.before_in_time(state, end, duration)
        return None if answers is None else [replace(answers[0], condition="")]

    def must_be_reached_before(self, left: Number, right: Number, end: State) -> _Found:
        """Return the readings of `coins must reach 50 before the level ends`."""
        if end.level > ATOM:
            return None
        free = end.negated().at(ATOM)
        return each_reading(
            reached_states(left, right), lambda goal: Reading((f"require {free} until {goal.at(ATOM)}",))
        )

    def must_come_before(self, state: State, end: State) -> _Found:
        """Return the readings of `a must come before b`."""
        if not are_simple(state, end):
            return None
        a, b = self.settled.get(state.text, state), end
        own = joined([a, b.negated()], "and")
        free = b.negated().at(ATOM)
        return [
            Reading(
                (f"require {free} weak_until {a.at(ATOM)}",),
                f"if no `{b.text}` may come before the first `{a.text}`, and may come at the same step",
            ),
            Reading((f"require {free} until {a.at(ATOM)}",), f"if `{a.text}` must come, before `{b.text}` or with it"),
            Reading(
                (f"keep {b.at(OR)} implies previously (not {b.at(ATOM)} since {own.at(ATOM)})",),
                f"if each `{b.text}` needs its own `{a.text}`",
            ),
        ]

    def orders_imply(self, early: State, late: State, first: State, then: State) -> _Found:
        """Return the readings of `a before b implies c before d`: in the whole of play, or from each b on."""
        if max(state.level for state in (early, late, first, then)) > ATOM:
            return None
        came = f"({late.negated().at(ATOM)} until {early.at(ATOM)})"
        comes = f"({then.negated().at(ATOM)} weak_until {first.at(ATOM)})"
        order = f"`{first.text}` must come before `{then.text}`"
        return [
            Reading(
                (f"require {came} implies {comes}",),
                f"if `{early.text}` comes before the first `{late.text}` of play, and then {order} in all of play",
            ),
            Reading(
                (f"keep {begun_text(late)} and previously once {early.at(ATOM)} implies {comes}",),
                f"if from each `{late.text}` behind `{early.text}` on, {order}",
            ),
        ]

    def came_before(self, early: State, late: State, state: State) -> Reading | None:
        """Return the rule of `if a before b, c`: c at each b with an a before it."""
        if max(early.level, late.level) > ATOM:
            return None
        return Reading((f"keep {late.at(AND)} and previously once {early.at(ATOM)} implies {state.at(OR)}",))

    # Answers with an exception.

    def lasting_unless(self, state: State, duration: Duration, event: Event) -> list[Asked] | None:
        """Return the readings of `a for 3 s unless b`: b ends that time, or b excuses the step of the condition."""
        exception = as_state(event)
        if exception is not None and exception.level == OR:
            exception = State(exception.at(ATOM))
        if exception is None or not are_simple(state, exception):
            return None
        a, b = state.at(ATOM), exception.at(ATOM)
        lasting = f"(always for {duration.text} {a})"
        return [
            Asked(
                Answer("now", State(f"({lasting} or ({a} until {b}))")),
                f"if `{exception.text}` ends that time",
                is_formula=True,
            ),
            Asked(
                Answer("now", State(f"({b} or {lasting})")),
                f"if `{exception.text}` counts only at the first step of that time",
                is_formula=True,
            ),
        ]

    def lasts_unless(self, state: State, *rest: Duration | tuple[Duration, Duration] | Event) -> _Found:
        """Return the rule of `a lasts at least 3 s and at most 8 s unless b`: b may end it sooner."""
        *times, event = rest
        durations = [duration for time in times for duration in (time if isinstance(time, tuple) else (time,))]
        least, *most = [duration for duration in durations if isinstance(duration, Duration)]
        lasting = self.lasting_unless(state, least, event) if not isinstance(event, (tuple, Duration)) else None
        longest = self.keep_short(state, most[0]) if most else None
        if lasting is None or (most and not isinstance(longest, Reading)):
            return None
        sooner = Reading((f"keep {begun_text(state)} implies {lasting[0].answer.state.text}",))
        return replace(sooner, clauses=(*sooner.clauses, *(longest.clauses if isinstance(longest, Reading) else ())))

    def forever_unless(self, state: State, event: Event) -> list[Asked] | None:
        """Return the readings of `always a unless b`: b ends it, or excuses each of its steps."""
        exception = as_state(event)
        if exception is None or not are_simple(state, exception):
            return None
        a, b = state.at(ATOM), exception.at(ATOM)
        return [
            Asked(Answer("now", State(f"({a} weak_until {b})")), f"if `{exception.text}` ends it for good", True),
            Asked(Answer("now", State(f"always ({a} or {b})")), f"if it goes on after each `{exception.text}`", True),
        ]

    def unless_first(self, event: Event, answers: list[Asked]) -> _Found:
        return self.unless(answers, event)

    def kept_unless(self, state: State, event: Event) -> list[Asked] | None:
        excused = self.now_unless(state, event)
        lasting = self.forever_unless(state, event)
        if excused is None or lasting is None:
            return None
        return [replace(excused, condition="for each step with the condition", is_formula=True), *lasting]

    # What must have come since the event before.

    def needs_since(self, event: State, since: State) -> _Found:
        return self.only_when(event, since)

    def avoid_without(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        known = None if condition is None else self.at_steps_of(state, condition)
        return None if known is None else super().avoid_without(state, known)

    def between_comes(self, span: Span, state: State) -> _Found:
        """Return the readings of `between two a there is b`: once, or at every step."""
        comes, holds = self.must_come_between(state, span), self.keep_between(state, span)
        if isinstance(holds, Reading) and "previous(" in state.text and span.start.text != span.end.text:
            return _steady(state, span, holds)
        if not isinstance(comes, Reading) or not isinstance(holds, Reading):
            return None
        return [
            replace(comes, condition="if it must come at some step between them"),
            replace(holds, condition="if it must hold at every step between them"),
        ]

    def comes_between(self, state: State, span: Span) -> _Found:
        return self.between_comes(span, state)

    def _answers_at(self, event: Event, answers: list[Asked]) -> list[Asked] | None:
        """Return answers at the steps of an event: `b since the last a` is since the a before."""
        state = as_state(event)
        known = []
        for asked in answers:
            at_event = None if state is None else self.at_steps_of(state, asked.answer.state)
            if at_event is None or at_event.text in self._moments:
                return None
            known.append(replace(asked, answer=replace(asked.answer, state=at_event)))
        return known

    # Rules with a condition.

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        answer = answers[0].answer
        if answer.kind == "always" and answer.is_negative and answer.state.text in self._conjoined:
            return None  # `no a and b` has two readings
        known = self._answers_at(event, answers)
        if known is None:
            return None
        compared = self._compared_for_time(event, known) or self._compared_from(when, event, known)
        return super().first(when, event, known) if compared is None else compared

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        known = self._answers_at(event, answers)
        if known is None:
            return None
        compared = self._compared_for_time(event, known) or self._compared_from(when, event, known)
        return super().last(known, when, event) if compared is None else compared

    def implies(self, event: Event, answers: list[Asked]) -> _Found:
        known = self._answers_at(event, answers)
        if known is None:
            return None
        compared = self._compared_for_time(event, known)
        if compared is None and self.is_again:
            compared = self._compared_from("after", event, known)
        return super().implies(event, known) if compared is None else compared

    def keep_if(self, event: Event, answers: list[Asked]) -> _Found:
        known = self._answers_at(event, answers)
        return None if known is None else super().keep_if(event, known)

    def keep_after(self, event: Event, answers: list[Asked]) -> _Found:
        """Return the rule of `keep after a, b within 5 s`."""
        state = as_state(event)
        denied = [asked.denied or asked.answer.state.negated() for asked in answers]
        if state is not None and any(begun_text(one) == begun_text(state) for one in denied):
            return None  # an event that must not come again, or must end
        return self.first("after", event, [_as_formula(asked) for asked in answers])

    def from_then_on(self, event: Event, answers: list[Asked]) -> _Found:
        """Return the rule of `from a on, b`, which asks for b at each later step, too."""
        asked = answers[0]
        if asked.answer.kind == "now" and not asked.is_formula:
            answers = [replace(asked, answer=replace(asked.answer, kind="always")), *answers[1:]]
        return self.first("after", event, answers)

    def then_on_from(self, answers: list[Asked], event: Event) -> _Found:
        return self.from_then_on(event, answers)

    def _compared_for_time(self, event: Event, answers: list[Asked]) -> list[Reading] | None:
        """Return the readings of `after a, b never falls for 2 s`: from the step after a on, or from that of a on."""
        state, answer = as_state(event), answers[0].answer
        is_compared = answer.kind == "lasting" and "previous(" in answer.state.text
        if not is_compared or state is None or answers[1:] or answers[0].condition:
            return None
        lasting = f"always for {answer.time} {answer.state.at(ATOM)}"
        return [
            Reading(
                (f"keep {state.at(OR)} implies weak_next {lasting}",),
                f"from the step after `{state.text}` on",
            ),
            Reading(
                (f"keep {state.at(OR)} implies {lasting}",),
                f"from the step of `{state.text}` on, which is then compared with the step before it",
            ),
        ]

    def _compared_from(self, when: When, event: Event, answers: list[Asked]) -> list[Reading] | None:
        """Return the readings of `after a, b == previous(b)`: the step of a is compared with the one before, or not."""
        state, asked = as_state(event), answers[0]
        compared, kind = asked.answer.state, asked.answer.kind
        is_kept = kind in ("now", "always") and not asked.is_formula and asked.answer.keyword != "reach"
        if when != "after" or state is None or answers[1:] or not is_kept or "previous(" not in compared.text:
            return None
        return [
            Reading(
                (f"keep previously once {state.at(ATOM)} implies {compared.at(OR)}",),
                f"from the step after `{state.text}` on",
            ),
            Reading(
                (f"keep {state.at(OR)} implies always {compared.at(ATOM)}",),
                f"from the step of `{state.text}` on, which is then compared with the step before it",
            ),
        ]

    def never_changes(self, term: Term, change: Change) -> State | None:
        return self.changes(term, "stays") if change == "varies" else super().never_changes(term, change)

    # Rules that forbid two conditions.

    def never(self, state: State) -> Asked:
        asked = super().never(state)
        if state.level == AND:
            self._conjoined.add(asked.answer.state.text)
        return asked


def _is_time(number: Number) -> bool:
    return number.text.startswith(("time_holding(", "time_since("))


def _as_formula(asked: Asked) -> Asked:
    """Return an answer of two conditions within a time as a formula, whose brackets hold them together."""
    answer = asked.answer
    if answer.kind != "within" or answer.state.level == ATOM or asked.denied is not None:
        return asked
    formula = State(f"eventually within {answer.time} {answer.state.at(ATOM)}")
    return replace(asked, answer=Answer("now", formula), is_formula=True)


def _steady(state: State, span: Span, holds: Reading) -> list[Reading]:
    """Return the readings of `from a until b, x stays the same`: with the step of a, or only from there on."""
    end, at_start = span.end, f"at the step with `{span.start.text}`"
    later = f"{end.at(OR)} or weak_next ({state.at(ATOM)} weak_until {end.at(ATOM)})"
    return [
        replace(holds, condition=f"if it must not change {at_start}, either"),
        Reading((f"keep {begun_text(span.start)} implies {later}",), f"if it may still change {at_start}"),
    ]
