"""What the rules of English sentences mean: the clauses that say the same, and when a sentence has several readings."""

from __future__ import annotations

from typing import Final, Literal

from tltlc.core.record import record, replace
from tltlc.grammar.english.answers import MOST_STEPS, Answers, Asked, is_negative, lasting_formula
from tltlc.grammar.english.doubts import lasts_on
from tltlc.grammar.english.events import Counted, Crossing, Event, Held, as_state, joined_events
from tltlc.grammar.english.quantities import Change, Duration, Number
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.rules import answered
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_TIMED: Final = ("require always for ", "require eventually always time_holding(")
When = Literal["if", "when", "while", "as long as", "each", "after"]


@record
class Reading:
    """Clauses that a sentence may mean. ``condition`` says when it means them, if there are other readings."""

    clauses: tuple[str, ...]
    condition: str = ""


@record
class Goals:
    """Goals one after the other. ``condition`` says when a sentence means them, if there are other readings."""

    states: tuple[State, ...]
    condition: str = ""


LASTING: Final = ("while", "as long as")  # words before a condition that lasts
_Found = Reading | list[Reading] | None


class Rules(Answers):
    """The meanings of the rules of the grammar."""

    def both_sentences(self, first: Reading, second: Reading) -> Reading | None:
        are_goals = all(reading.clauses[0].startswith("reach ") for reading in (first, second))
        if (
            any(reading.condition for reading in (first, second))
            or first.clauses[0].startswith("reach once ")
            or any(" or " in clause for clause in first.clauses)
            or (second.clauses[0].startswith("avoid ") and " and " in second.clauses[0])  # c of `no a, no b and c`
            or (are_goals and (len(second.clauses) > 1 or " or " in second.clauses[0]))
        ):
            return None
        what = "if that time is for the first of them alone" * first.clauses[0].startswith(_TIMED)
        return Reading((*first.clauses, *second.clauses), what)

    def plain_and_rule(self, first: Reading, when: When, event: Event, answers: list[Asked]) -> Reading | None:
        rule = _conditional(when, event, answers)
        second = rule[0] if isinstance(rule, list) and len(rule) == 1 else rule
        return self.both_sentences(first, second) if isinstance(second, Reading) else None

    # Rules without a condition.

    def avoid(self, event: Event) -> _Found:
        if isinstance(event, Counted):
            return None if event.sign in ("<", "<=") else _limited(event, NEGATED_SIGN.get(event.sign or ">=", ""))
        if isinstance(event, Held):
            return never_held(event)
        if isinstance(event, Crossing):
            return Reading((f"avoid {event.state.text}",))
        if event.level == OR:
            return None  # both, or the second is another rule
        return Reading((f"avoid {event.text}",))

    def avoid_change(self, term: Term, change: Change, step: Number) -> _Found:
        state = self.changes_by_compared(term, change, ">=", step)
        return None if state is None else Reading((f"avoid {state.text}",))

    def avoid_until(self, state: State, end: State) -> _Found:
        if not are_simple(state, end):
            return None
        return Reading((f"require {state.negated().at(ATOM)} weak_until {end.at(ATOM)}",))

    def avoid_without(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        return (
            None
            if condition is None or not are_simple(state, condition)
            else Reading((f"keep {state.at(OR)} implies {condition.at(OR)}",))
        )

    def avoid_without_before(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        return None if condition is None else Reading((f"keep {state.at(OR)} implies once {condition.at(ATOM)}",))

    def keep(self, state: State) -> _Found:
        is_later = state.text in self.changing or state.text.startswith("time_holding(")
        if is_later or state.text in self.listed or self.count_condition(state.text):
            return None  # the first step has no value before, and no time
        return Reading((f"keep {state.text}",))

    def limit_count(self, counted: Counted) -> _Found:
        if counted.state.text.startswith("not "):
            return None
        return _limited(counted, counted.sign)

    def count_before(self, sign: str, number: str, state: State) -> Counted:
        return Counted(state, sign, number)

    def count_behind(self, state: State, sign: str, number: str) -> Counted:
        return Counted(state, sign, number)

    def number_before(self, sign: str, number: Term, state: State) -> Counted | None:
        return Counted(state, sign, number.text)

    def number_exactly(self, number: Term, term: Term) -> Counted:
        return Counted(State(term.text), "==", number.text)

    def only_behind(self, state: State, number: str) -> Counted:
        return Counted(state, "<=", number)

    def only_before(self, number: Term, term: Term) -> Counted:
        return Counted(State(term.text), "<=", number.text)

    def exactly_behind(self, state: State, number: str) -> Counted:
        return Counted(state, "==", number)

    def exactly_before(self, number: str, state: State) -> Counted:
        return Counted(state, "==", number)

    def keep_short(self, state: State, duration: Duration) -> _Found:
        return never_held(Held(state, ">", duration))

    def lasts_at_least(self, state: State, duration: Duration) -> Reading:
        return Reading((f"keep begins {state.at(ATOM)} implies always for {duration.text} {state.at(ATOM)}",))

    def lasts_exactly(self, state: State, duration: Duration) -> _Found:
        if self.steps(duration) > MOST_STEPS:
            return None
        formula = lasting_formula(state, duration, state.negated())
        return Reading((f"keep begins {state.at(ATOM)} implies {formula.text}",))

    def reach(self, goals: Goals) -> _Found:
        if any(goal.text in self.listed for goal in goals.states):
            return None
        return Reading((f"reach {' then '.join(goal.at(OR) for goal in goals.states)}",), goals.condition)

    def reach_within(self, event: Event, duration: Duration) -> _Found:
        state = as_state(event)
        if isinstance(event, Counted) or state is None or state.text.startswith("not "):
            return None  # a condition that must not hold in that time, or one step without it
        return Reading((f"require eventually within {duration.text} {state.at(ATOM)}",))

    def within_reach(self, duration: Duration, event: Event) -> _Found:
        return self.reach_within(event, duration)

    def reach_without(self, event: Event, avoided: State) -> _Found:
        state = as_state(event)
        if state is None or not are_simple(state, avoided) or is_negative(state):
            return None
        return Reading((f"reach {state.text}", f"avoid {avoided.text}"))

    def only_when(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        condition = condition and self.at_steps_of(state, condition)
        return None if condition is None else Reading((f"keep {state.at(OR)} implies {condition.at(OR)}",))

    def only_after(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        if condition is not None and isinstance(event, Held):
            # Once a condition has held so long, it would have held so long for ever.
            begun = state.text if state.text.startswith("begins ") else f"begins {state.at(ATOM)}"
            return Reading((f"keep {begun} implies {condition.at(OR)}",))
        return None if condition is None else Reading((f"keep {state.at(OR)} implies once {condition.at(ATOM)}",))

    def needs(self, state: State, condition: State) -> _Found:
        a, b = state.at(OR), condition
        return [
            Reading((f"keep {a} implies {b.at(OR)}",), "if both must hold at the same step"),
            Reading((f"keep {a} implies once {b.at(ATOM)}",), f"if `{b.text}` may have held before"),
        ]

    def exactly_when(self, state: State, event: Event) -> _Found:
        condition = as_state(event)
        return None if condition is None else Reading((f"keep {state.at(OR)} iff {condition.at(OR)}",))

    # Rules with a condition.

    def when(self) -> When:
        return "when"

    def if_(self) -> When:
        return "if"

    def while_(self) -> When:
        return "while"

    def as_long_as(self) -> When:
        return "as long as"

    def each(self) -> When:
        return "each"

    def after(self) -> When:
        return "after"

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        return _conditional(when, event, answers)

    def keep_if(self, event: Event, answers: list[Asked]) -> _Found:
        return _conditional("if", event, answers)

    def given(self, condition: Event, when: When, event: Event, answers: list[Asked]) -> _Found:
        state = joined_events([condition, event], "and")
        return None if state is None else _conditional(when, state, answers)

    def first_while(self, when: When, event: Event, condition: State, answers: list[Asked]) -> _Found:
        state = joined_events([event, condition], "and")
        return None if state is None else _conditional(when, state, answers)

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        state, answer = as_state(event), answers[0].answer
        # In `keep b when a or c for 2 s`, the time shows that c belongs to the condition.
        is_timed = answer.keyword == "keep" and isinstance(event, State) and "time_holding(" in event.text
        if state is None or not are_simple(answer.state) or not (is_timed or are_simple(state)):
            return None
        if answer.kind == "always" and answer.is_negative and when != "after" and not answers[1:]:
            return _conditional(when, event, [Asked(replace(answer, kind="now"))])
        is_plain = answer.kind == "now" and not answer.keyword and not answer.state.text.startswith("not ")
        if when == "while" and is_plain and state is not None and not answers[0].is_formula:
            goal = joined([answer.state, state], "and")
            return [
                Reading((f"reach {goal.text}",), "if it is a goal"),
                Reading((f"keep {state.at(OR)} implies {answer.state.at(OR)}",), f"for each step with `{state.text}`"),
            ]
        if answer.keyword == "reach" and when != "after":
            return None  # a goal, or a rule
        if state and answer.kind == "now" and answer.keyword == "keep" and when != "after":
            return Reading((f"keep {state.at(OR)} implies {answer.state.at(OR)}",))
        return _conditional(when, event, answers)

    def implies(self, event: Event, answers: list[Asked]) -> _Found:
        return _conditional("when", event, answers)

    def unless(self, answers: list[Asked], event: Event) -> _Found:
        condition = as_state(event)
        if condition is None or len(answers) > 1:
            return None
        answer = answers[0].answer
        condition = self.at_steps_of(answer.state.negated() if answer.is_negative else answer.state, condition)
        # `a and b unless c` is the same, whatever `unless` belongs to.
        words = answer.state.negated().text.split()
        is_simple = condition is not None and (not isinstance(event, State) or are_simple(condition))
        is_clear = answer.is_negative and not {"or", "not"} & {*words} and is_simple
        if condition is None or not (is_clear or are_simple(condition, answer.state)):
            return None
        if answer.kind == "always" and answer.is_negative:
            return Reading((f"keep {answer.state.negated().at(OR)} implies {condition.at(OR)}",))
        is_change = answer.state.text in self.settled or answer.state.text in self.changing
        if answer.kind == "now" and not is_change and answer.keyword != "reach" and not answers[0].is_formula:
            return Reading((f"keep {answer.state.at(OR)} or {condition.at(OR)}",))
        return None


def all_readings(rule: _Found) -> list[Reading]:
    """Return what a rule may mean as a list: a rule has no reading, one, or several."""
    if rule is None:
        return []
    return rule if isinstance(rule, list) else [rule]


def are_simple(*states: State) -> bool:
    """Whether no condition is made of several: a word between them may belong to the nearest alone."""
    return all(state.level == ATOM and not state.text.startswith("not (") for state in states)


def _limited(counted: Counted, sign: str) -> Reading | None:
    event, number = counted.state, counted.number
    if sign in ("<=", "<"):
        if (sign, number) in (("<=", "0"), ("<", "1")):
            return Reading((f"avoid {event.text}",))
        return Reading((f"keep times({event.text}) {sign} {number}",))
    if sign in (">=", ">"):
        return Reading((f"reach times({event.text}) {sign} {number}",))
    if sign == "==":
        return Reading((f"reach times({event.text}) >= {number}", f"keep times({event.text}) <= {number}"))
    return None


def never_held(held: Held) -> Reading | None:
    """Return the rule that no stretch of steps with a condition is so long."""
    if held.sign not in (">", ">="):
        return None  # it may not hold all that time, or not at any step of it
    state, duration = held.state, held.duration
    if not duration.is_steps:
        return Reading((f"avoid time_holding({state.text}) {held.sign} {duration.text}",))
    if not duration.number.isdecimal():
        return None
    most = int(duration.number) - (held.sign == ">=")
    if most < 1:
        return Reading((f"avoid {state.text}",)) if most == 0 else None
    steps = f"{most} step{'s' * (most > 1)}"
    return Reading((f"avoid always for {steps} {state.at(ATOM)} and next after {steps} {state.at(ATOM)}",))


def _conditional(when: When, event: Event, answers: list[Asked]) -> _Found:
    # A condition on the same step is asked for while the number is beyond the limit.
    is_now = all(asked.answer.kind == "now" and not asked.is_formula for asked in answers)
    state = event.state if isinstance(event, Crossing) and is_now else as_state(event)
    if state is None:
        return None
    readings = [_answer_readings(when, event, state, asked) for asked in answers]
    if len(readings) == 1:
        return readings[0]
    if any(len(of_answer) != 1 or of_answer[0].condition for of_answer in readings):
        return None
    return Reading(tuple(clause for of_answer in readings for clause in of_answer[0].clauses))


def _answer_readings(when: When, event: Event, state: State, asked: Asked) -> list[Reading]:
    answer = asked.answer
    if asked.late is not None:
        return []
    is_edge = state.text.startswith(("begins ", "ends "))
    if asked.settled is not None and not is_edge:
        asked = Asked(replace(answer, state=asked.settled))
        answer = asked.answer
    is_forbidden = answer.kind == "lasting" and (answer.is_negative or is_negative(answer.state))
    forbidden = asked.denied or (answer.state.negated() if is_forbidden else None)
    if forbidden is not None and begun_text(forbidden) == begun_text(state):
        # `not a within 5 s` may only ask for a step without a.
        return not_again(state, forbidden, answer.time) if answer.time else []
    if asked.is_formula:
        if when == "if" and asked.until is not None:
            return _ending(state, asked, *asked.until)
        if asked.is_timed and lasts_on(state.text):
            state = State(f"begins ({state.text})")
        elif asked.is_once and not is_edge:
            state = State(f"begins {state.at(ATOM)}")
        return [Reading((f"keep {state.at(OR)} implies {answer.state.at(OR)}",), asked.condition)]
    if when in LASTING and answer.keyword == "reach":
        return []
    is_each = when in LASTING or (when == "each" and answer.kind == "now")
    if clauses := answered(state, answer, is_from_then=when == "after", is_each=is_each):
        if answer.kind in ("within", "lasting") and lasts_on(state.text):
            return _once_or_anew(state, clauses[0].partition(" implies ")[2], asked.condition)
        return [Reading(clauses, asked.condition)]
    if asked.condition:
        return []
    return _two_readings(state, answer)


def _once_or_anew(event: State, asked: str, condition: str) -> list[Reading]:
    """Return the readings of `when a for 3 s, b within 2 s`: once for each time, or anew at each step."""
    also = f"{condition}, and " if condition else "if "
    return [
        Reading((f"keep begins ({event.text}) implies {asked}",), f"{also}once each time that this begins"),
        Reading((f"keep {event.at(OR)} implies {asked}",), f"{also}anew at each step while it lasts"),
    ]


def _ending(event: State, asked: Asked, state: State, end: State) -> list[Reading]:
    """Return the readings of `if a then b until c`: what it asks for may end there, or the rule itself."""
    condition = asked.condition or f"from each step with `{event.text}` on"
    return [
        Reading((f"keep {event.at(OR)} implies {asked.answer.state.at(OR)}",), condition),
        Reading((f"require ({event.at(OR)} implies {state.at(OR)}) weak_until {end.at(ATOM)}",),
                f"if the rule ends at `{end.text}`"),
    ]  # fmt: skip


def begun_text(state: State) -> str:
    """Return the text of the beginning of a condition, or of a beginning or end itself."""
    return state.text if state.text.startswith(("begins ", "ends ")) else f"begins {state.at(ATOM)}"


def not_again(event: State, state: State, time: str) -> list[Reading]:
    """Return the readings of `after a, no a for 5 s`; ``event`` is a, or its beginning."""
    begun, ended = begun_text(event), begun_text(event).replace("begins ", "ends ", 1)
    again = f"avoid ({begun}) then within {time} ({begun})"
    readings = [Reading((again,), "if it may last, and must not begin again in that time")]
    if state.text != begun:
        at_each_step = f"avoid {state.at(ATOM)} then within {time} {state.at(ATOM)}"
        readings.append(Reading((at_each_step,), "if no step with it may follow in that time"))
    if ended != begun:
        clause = f"keep {ended} implies always for {time} {state.negated().at(ATOM)}"
        readings.append(Reading((clause,), "if the time counts from its end"))
    return readings


def _two_readings(event: State, answer: Answer) -> list[Reading]:
    """Return the readings of `when a keep b`, `when a avoid b` and `after a, b`: at each step, or from then on."""
    if answer.kind not in ("now", "always"):
        return []
    a, b = event.at(OR), answer.state
    both = joined([event, b.negated()], "and").text
    at_each_step = f"avoid {both}" if answer.is_negative else f"keep {a} implies {b.at(OR)}"
    return [
        Reading((at_each_step,), f"for each step with `{event.text}`"),
        Reading((f"keep {a} implies always {b.at(ATOM)}",), "if it holds from then on"),
    ]
