"""What rules with an exception mean: `avoid a unless b or c`, `a not before b unless c`, `a except the first 1 s`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.events import Event, Held, as_state
from tltlc.grammar.english.quantities import Change, Duration, Number, comparison
from tltlc.grammar.english.rules import Reading, Rules, When, are_simple, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_COMPARED: Final = (" < ", " <= ", " > ", " >= ", " == ", " != ")
"""The signs of conditions that are limits, as a rule for every step has."""
_TIMED: Final = re.compile(r"time_holding\((?P<held>[^,]*)\) (?P<sign><=|>=|<|>) (?P<time>[\d.]+ \w+)")
"""How long a condition has held, compared with a time."""
_EXACT: Final = 1e-12
_PAST: Final = ("once ", "historically ", "previously ", "begins ", "ends ")

_Found = Reading | list[Reading] | None


class Exceptions(Rules):
    """The meanings of the rules with an exception, and of rules for two conditions."""

    def __init__(self, names: DeclaredNames) -> None:
        super().__init__(names)
        self._counted_from: dict[str, str] = {}
        """Maps the texts of exceptions to the step from which their time counts, where a sentence does not say it."""
        self._early: set[str] = set()
        """The exceptions of the first seconds of something."""

    # Exceptions in time.

    def soon_after(self, duration: Duration, event: State) -> list[State]:
        """Return the exceptions of `except within 5 s after a`: from where a begins, or from each step with it."""
        begun = State(f"once within {duration.text} {begun_text(event)}")
        if event.text.startswith(("begins ", "ends ")):
            return [begun]
        held = State(f"once within {duration.text} {event.at(ATOM)}")
        self._counted_from[begun.text] = f"if the time counts from where `{event.text}` begins"
        self._counted_from[held.text] = f"if it counts from each step with `{event.text}`"
        return [begun, held]

    def first_of(self, duration: Duration, event: State) -> State:
        """Return the exception of `except in the first 5 s of a`."""
        early = State(f"once within {duration.text} {begun_text(event)}")
        self._early.add(early.text)
        return early

    def now_unless(self, state: State, event: Event) -> Asked | None:
        asked = super().now_unless(state, event)
        return asked and replace(asked, condition=self._when_meant(event))

    def unless(self, answers: list[Asked], event: Event) -> _Found:
        answer = answers[0].answer
        if answer.kind == "always" and answer.is_negative and isinstance(event, State) and event.text in self._early:
            return None  # `avoid a except in the first 5 s of b`, which `avoid_except_first` reads
        reading = self._excused_rule(answers, event) or self._kept_or(answers, event)
        if not isinstance(reading, Reading) or reading.condition:
            return reading
        return replace(reading, condition=self._when_meant(event))

    def _kept_or(self, answers: list[Asked], event: Event) -> Reading | None:
        """Return the rule of `keep a unless b or c`."""
        asked = self.now_unless(answers[0].answer.state, event)
        answer, exception = answers[0].answer, as_state(event)
        is_plain = answer.kind == "now" and answer.keyword != "reach" and not answers[0].is_formula and not answers[1:]
        if asked is None or not is_plain or exception is None or exception.level == ATOM:
            return None
        return Reading((f"keep {asked.answer.state.text}",))

    def _when_meant(self, event: Event) -> str:
        return self._counted_from.get(event.text, "") if isinstance(event, State) else ""

    # What an exception excuses.

    def now_excepted(self, *parts: State | Event) -> Asked | None:
        """Return the answer of `a and (b unless c)`: the brackets say that c excuses b alone."""
        *states, event = parts
        excused = self.now_unless(last, event) if isinstance(last := states[-1], State) else None
        if excused is None:
            return None
        others = [state for state in states[:-1] if isinstance(state, State)]
        whole = joined([*others, State(f"({excused.answer.state.text})")], "and")
        return replace(excused, answer=Answer("now", whole))

    def keep_excepted(self, *parts: State | Event) -> Reading | None:
        asked = self.now_excepted(*parts)
        return None if asked is None else Reading((f"keep {asked.answer.state.text}",), asked.condition)

    def avoid_when_unless(self, state: State, when: When, during: State, event: Event) -> _Found:
        exception = as_state(event)
        if when == "after" or state.level == OR or exception is None or exception.text in self._early:
            return None
        both = joined([state, during], "and")
        return Reading((f"keep {both.at(OR)} implies {exception.at(OR)}",), self._when_meant(event))

    def keep_when_unless(self, state: State, when: When, during: State, event: Event) -> _Found:
        """Return the rule of `keep a when b except when c`."""
        exception = as_state(event)
        if when == "after" or exception is None or exception.text in self._early or not are_simple(state, during):
            return None
        condition = joined([during, exception.negated()], "and")
        return Reading((f"keep {condition.at(OR)} implies {state.at(OR)}",), self._when_meant(event))

    def avoid_in_unless(self, state: State, during: State, event: Event) -> _Found:
        return self.avoid_when_unless(state, "while", during, event)

    def avoid_before_unless(self, state: State, first: State, exception: State) -> _Found:
        """Return the readings of `a not before b unless c`: c excuses its own step, or all steps from it on."""
        if not are_simple(state, first) or is_negative(state):
            return None
        came, excuse, a = State(f"once {first.at(ATOM)}"), f"`{exception.text}`", state.at(OR)
        return [
            Reading(
                (f"keep {a} implies {joined([came, exception], 'or').text}",),
                f"if {excuse} counts only at the step with `{state.text}`",
            ),
            Reading(
                (f"keep {a} implies once {joined([first, exception], 'or').at(ATOM)}",),
                f"if an earlier {excuse} counts, too",
            ),
        ]

    def not_before_unless(self, state: State, first: State, exception: State) -> _Found:
        return self.avoid_before_unless(state.negated(), first, exception) if is_negative(state) else None

    def not_before(self, state: State, first: State) -> _Found:
        return self.avoid_until(state.negated(), first) if is_negative(state) else None

    def all_unless(self, *parts: State | Event) -> list[Asked] | None:
        """Return the readings of `a and b unless c`: c excuses both, or b alone."""
        readings = _excused_parts(parts)
        return [Asked(Answer("now", state), condition) for state, condition in readings] if readings else None

    # Two conditions.

    def both_sentences(self, first: Reading, second: Reading) -> Reading | None:
        """Return the readings of `times(a) <= 5 and no two a within 2 s`: the limit is not about both."""
        if first.clauses[0].startswith("avoid ") and second.clauses[0].startswith("require not "):
            return None  # `avoid a and not b before c`
        clauses, is_limit = first.clauses, any(sign in first.clauses[0] for sign in _COMPARED)
        is_apart = is_limit and clauses[0].startswith("keep ") and second.clauses[0].startswith("avoid ")
        if not second.condition or first.condition or clauses[1:] or not is_apart:
            return super().both_sentences(first, second)
        return Reading((*clauses, *second.clauses), second.condition)

    def once_held(self, state: State) -> State:
        return State(f"once {state.at(ATOM)}")

    def avoid_both(self, one: State, other: State) -> Reading:
        return Reading((f"avoid {joined([one, other], 'and').text}",))

    def in_this_order(self, *states: State) -> _Found:
        """Return the goal of `a before b before c`."""
        return (
            None
            if any(map(is_negative, states))
            else Reading((f"reach {' then '.join(state.at(OR) for state in states)}",))
        )

    def never_both(self, one: State, other: State) -> Asked:
        return Asked(Answer("now", joined([one, other], "and").negated()))

    def both_when(self, one: State, other: State, when: When, event: Event) -> _Found:
        return self.first(when, event, [self.never_both(one, other)])

    def all_when(self, *parts: State | Event | When) -> _Found:
        """Return the readings of `a and b when c`: both only with c, or a at every step."""
        *states, when, event = parts
        condition = as_state(event) if not isinstance(event, str) else None
        conditions = [state for state in states if isinstance(state, State)]
        whole, *always = joined(conditions, "and"), *conditions[:-1]
        if when in ("each", "after") or condition is None or not are_simple(*conditions) or "previous(" in whole.text:
            return None
        first, rule = joined(always, "and"), f"keep {condition.at(OR)} implies"
        return [
            Reading(
                (f"keep {first.text}", f"{rule} {conditions[-1].at(OR)}"), f"if `{first.text}` must hold at every step"
            ),
            Reading((f"{rule} {whole.at(OR)}",), f"if all of it is asked for with `{condition.text}` alone"),
        ]

    # Answers that forbid what a number does.

    def now_not_compared(self, left: Number, sign: str, right: Number) -> Asked | None:
        state = comparison(left, sign, right)
        return None if state is None else Asked(Answer("now", state.negated()))

    def now_not_changed(self, term: Term, change: Change) -> Asked | None:
        signs = {"rises": "<=", "falls": ">="}
        if change not in signs:
            return None
        return Asked(Answer("now", State(f"{term.text} {signs[change]} previous({term.text})")))

    def once_ago(self, sign: str, duration: Duration, state: State) -> State | None:
        """Return the condition of `once at least 3 s ago a`: some a was so long ago."""
        if sign in ("<", "<="):
            return self.once_within(duration, state)
        if duration.is_steps:
            return None
        return State(f"time_holding(once {state.at(ATOM)}) {sign} {duration.text}")

    def once_within(self, duration: Duration, state: State) -> State:
        return State(f"once within {duration.text} {state.at(ATOM)}")

    # Unless something holds.

    def _excused_rule(self, answers: list[Asked], event: Event) -> _Found:
        excuse, answer = as_state(event), answers[0].answer
        if excuse is None or len(answers) > 1 or answers[0].is_formula or answer.keyword == "reach":
            return super().unless(answers, event)
        is_avoided = answer.kind == "always" and answer.is_negative
        state = answer.state.negated() if is_avoided else answer.state
        is_kept = answer.kind == "now" and state.text not in self.settled and state.text not in self.changing
        if not is_avoided and not is_kept:
            return super().unless(answers, event)
        if state.level == ATOM and (timed := _TIMED.fullmatch(state.text)):
            return _timed_unless(timed, excuse, "avoid" if is_avoided else "keep")
        if _plain(state) in self.varying:
            if is_avoided:
                return Reading((f"keep {_plain(state)} implies {excuse.at(OR)}",))
            return Reading((f"keep {state.at(OR)} or {excuse.at(ATOM)}",))
        known = super().unless(answers, event)
        if known is not None:
            return known
        reading = _excused(state, excuse, is_avoided=is_avoided)
        if not isinstance(reading, Reading) or reading.condition:
            return reading
        words = state.text.split()
        if excuse.level == AND or ({"and", "or"} & {*words} and "not" in words):
            return replace(reading, condition=f"if all of `{excuse.text}` is an exception of all before it")
        return reading

    def avoid_held_unless(self, state: State, sign: str, duration: Duration, event: Event) -> _Found:
        """Return the readings of `no a for more than 20 s unless b`."""
        excuse, held = as_state(event), as_state(Held(state, sign, duration))
        timed = _TIMED.fullmatch(held.text) if held is not None else None
        return _timed_unless(timed, excuse, "avoid") if timed and excuse is not None and sign in (">", ">=") else None

    def implied_not_held(
        self, event: Event, state: State, sign: str, duration: Duration, *exception: State
    ) -> list[Reading] | None:
        """Return the readings of `keep a implies never b for more than 5 s`: time without a counts, or not."""
        during = as_state(event)
        if during is None or sign not in (">", ">=") or duration.is_steps or begun_text(during) == during.text:
            return None
        states = [state, *(excuse.negated() for excuse in exception)]
        held, whole = joined(states, "and"), joined([during, *states], "and")
        limit = f"{sign} {duration.text}"
        return [
            Reading((f"avoid time_holding({whole.text}) {limit}",), f"if time without `{during.text}` does not count"),
            Reading((f"keep {during.at(OR)} implies not time_holding({held.text}) {limit}",), "if it does"),
        ]

    def short_unless(self, state: State, duration: Duration, event: Event) -> _Found:
        return self.avoid_held_unless(state, ">", duration, event)

    def avoid_then_unless(self, first: State, *rest: State | Duration) -> _Found:
        """Return the readings of `avoid a then within 3 s b unless c`: c excuses the step of b, or that of a."""
        *time, second, excuse = rest
        assert isinstance(second, State) and isinstance(excuse, State)
        between = "then" if not time or not isinstance(time[0], Duration) else f"then within {time[0].text}"
        denied = excuse.negated()
        if first == second and time and isinstance(time[0], Duration) and not first.text.startswith(_PAST):
            begun = begun_text(first)
            return Reading((f"avoid ({begun}) then within {time[0].text} ({begun} and {denied.at(ATOM)})",))
        at_second = f"avoid {_operand(first)} {between} {_with(second, denied)}"
        if excuse.text.startswith(_PAST):
            return Reading((at_second,))
        at_first = f"avoid {_with(first, denied)} {between} {_operand(second)}"
        return [
            Reading((at_second,), f"if `{excuse.text}` counts at the step of `{second.text}`"),
            Reading((at_first,), f"if it counts at the step of `{first.text}`"),
        ]

    # Except for some time.

    def avoid_except_first(self, state: State, duration: Duration, *during: State) -> _Found:
        """Return the rule of `avoid a and b except for the first 1 s of b`, or of play."""
        if not during:
            return Reading((f"require weak_next after {duration.text} always {state.negated().at(ATOM)}",))
        over, early = (self._held_so_long(during[0], sign, duration) for sign in (">=", "<"))
        if over is None or early is None:
            return None
        others = _without(state, during[0])
        if others == [state]:  # what is excused is not a part of it
            return Reading((f"keep {state.at(OR)} implies {early.at(OR)}",))
        return Reading((f"avoid {joined([*others, over], 'and').text}",))

    def implies_except_first(self, event: Event, state: State, duration: Duration, *of: State) -> _Found:
        """Return the rule of `keep a implies b except in the first 1 s`, which is that of a."""
        condition = as_state(event)
        if condition is None or not are_simple(condition, *of):
            return None
        over = self._held_so_long((*of, condition)[0], ">=", duration)
        others = _without(condition, of[0]) if of else []
        return (
            None if over is None else Reading((f"keep {joined([*others, over], 'and').at(OR)} implies {state.at(OR)}",))
        )

    def when_except_first(self, when: When, event: Event, state: State, duration: Duration, *of: State) -> _Found:
        return None if when in ("each", "after") else self.implies_except_first(event, state, duration, *of)

    def avoid_first_of(self, state: State, duration: Duration, during: State) -> Reading | None:
        """Return the rule of `no a in the first 1 s of b`."""
        early = self._held_so_long(during, "<", duration)
        return None if early is None else Reading((f"avoid {joined([*_without(state, during), early], 'and').text}",))

    def keep_first_of(self, state: State, duration: Duration, during: State) -> Reading | None:
        """Return the rule of `a in the first 1 s of b`."""
        early = self._held_so_long(during, "<", duration)
        if early is None or not are_simple(state, during) or state == during:
            return None
        return Reading((f"keep {early.at(OR)} implies {state.at(OR)}",))

    def avoid_last_of(self, state: State, duration: Duration, during: State) -> Reading | None:
        """Return the rule of `no a in the last 1 s of b`, which looks back where b has ended."""
        if not are_simple(state, during) or state == during or is_negative(during):
            return None
        return self._last_of(joined([state, during], "and"), duration, during)

    def keep_last_of(self, state: State, duration: Duration, during: State) -> Reading | None:
        """Return the rule of `a in the last 1 s of b`."""
        if not are_simple(state, during) or state == during or is_negative(during):
            return None
        return self._last_of(joined([state.negated(), during], "and"), duration, during)

    def _last_of(self, denied: State, duration: Duration, during: State) -> Reading | None:
        """Return the rule that something has not been in the last 1 s of b, which looks back where b has ended."""
        steps = round(self.steps(duration), 6) - 1
        if not steps.is_integer() or steps < 1 or not (duration.is_steps or self._step_s):
            return None
        came = f"previously once within {int(steps)} steps {denied.at(ATOM)}"
        return Reading((f"keep ends {during.at(ATOM)} implies not {came}",), f"where `{during.text}` has ended")

    def avoid_while_except_first(self, state: State, condition: State, duration: Duration, *during: State) -> _Found:
        """Return the rule of `no a while b except for the first 1 s`, which is that of b."""
        both = joined([state, condition], "and")
        return self.avoid_except_first(both, duration, *(during or (condition,)))

    def avoid_unless_begun(self, state: State, begun: State, sign: str, duration: Duration) -> _Found:
        """Return the rule of `avoid a unless b began less than 1 s ago`."""
        if duration.is_steps or not begun.text.startswith("begins "):
            return None
        if sign in (">", ">="):
            came = joined(
                [State(f"once {begun.text}"), State(f"time_since({begun.text}) {sign} {duration.text}")], "and"
            )
            return Reading((f"keep {state.at(OR)} implies {came.at(OR)}",))
        since = State(f"time_since({begun.text}) {NEGATED_SIGN[sign]} {duration.text}")
        return Reading((f"avoid {joined([state, since], 'and').text}",))

    def _held_so_long(self, state: State, sign: str, duration: Duration) -> State | None:
        """Return whether a condition has held for so long; None for steps whose time has too many digits."""
        if not duration.is_steps:
            return as_state(Held(state, sign, duration))
        seconds = self.steps(duration) * self._step_s
        if not seconds or abs(seconds - round(seconds, 6)) > _EXACT:
            return None
        return as_state(Held(state, sign, Duration(f"{round(seconds, 6):g}", "s")))


def _timed_unless(timed: re.Match[str], excuse: State, keyword: str) -> list[Reading]:
    """Return the readings of `avoid time_holding(a) > 20 s unless b`: b at the end of that time, or all the time."""
    held, compared = State(timed["held"], OR), f"{timed['sign']} {timed['time']}"
    if " or " not in held.text:
        held = State(held.text, AND if " and " in held.text else ATOM)
    rest = f"and not {excuse.at(ATOM)}" if keyword == "avoid" else f"or {excuse.at(ATOM)}"
    counted = joined([held, excuse.negated()], "and")
    return [
        Reading((f"{keyword} {timed.group()} {rest}",), f"if `{excuse.text}` counts once that time is over"),
        Reading(
            (f"{keyword} time_holding({counted.text}) {compared}",),
            f"if time with `{excuse.text}` does not count, and the time begins anew behind it",
        ),
    ]


def _excused(state: State, excuse: State, *, is_avoided: bool) -> _Found:
    """Return the rule with brackets around an exception of several parts; two readings if the rule has parts, too."""
    if state.text.startswith("not ("):
        return None
    if is_avoided:
        whole = f"avoid {state.at(AND)} and {excuse.negated().at(ATOM)}"
        if state.level <= AND:
            return Reading((whole,))
        first, _, last = state.text.rpartition(" or ")
        apart = None if "(" in state.text else f"avoid {first} or {last} and {excuse.negated().at(ATOM)}"
    else:
        whole = f"keep {state.at(ATOM)} or {excuse.at(ATOM)}"
        if state.level in (ATOM, OR):
            return Reading((f"keep {state.at(OR)} or {excuse.at(ATOM)}",))
        if _is_range(state):
            return Reading((whole,))
        first, last = _last_part(state.text, " and ")
        apart = f"keep {first} and ({last} or {excuse.at(ATOM)})" if first else None
    if apart is None or state.level > OR:
        return None
    return [
        Reading((whole,), f"if `{excuse.text}` is an exception of all before it"),
        Reading((apart,), f"if it is one of `{last}` alone"),
    ]


def _last_part(text: str, word: str) -> tuple[str, str]:
    """Return a text before and behind the last word that stands in no brackets; "" and the text if there is none."""
    depth = 0
    for at in range(len(text) - 1, -1, -1):
        depth += (text[at] == ")") - (text[at] == "(")
        if depth == 0 and text.startswith(word, at):
            return text[:at], text[at + len(word) :]
    return "", text


def _is_range(state: State) -> bool:
    """Whether a condition is `x >= 2 and x <= 5`, which nobody takes apart."""
    low, _, high = state.text.partition(" and ")
    return low.partition(" >= ")[0] == high.partition(" <= ")[0] != ""


def _plain(state: State) -> str:
    """Return a condition without the brackets and the `not` before it."""
    text = state.text.removeprefix("not ")
    return text[1:-1] if text.startswith("(") and text.endswith(")") else text


def _without(state: State, part: State) -> list[State]:
    """Return the parts of a conjunction without one of them, which another condition says already."""
    if state.text == part.text:
        return []
    if state.level != AND or "(" in state.text or " or " in state.text:
        return [state]
    return [State(text) for text in state.text.split(" and ") if text != part.text]


def _operand(state: State) -> str:
    """Return a condition as an operand of `then`."""
    return f"({state.text})" if state.level > ATOM or state.text.startswith(_PAST) else state.text


def _with(state: State, denied: State) -> str:
    one = f"({state.text})" if state.level > AND or state.text.startswith(_PAST) else state.text
    return f"({one} and {denied.at(ATOM)})"


def _excused_parts(parts: Sequence[State | Event]) -> list[tuple[State, str]]:
    """Return what an exception behind several conditions leaves of them, with what tells the readings apart."""
    exception = as_state(parts[-1])
    states = [part for part in parts[:-1] if isinstance(part, State)]
    if exception is None or not are_simple(*states):
        return []
    *others, last = states
    excused = State(f"({joined([last, exception], 'or').text})")
    return [
        (joined([joined(states, "and"), exception], "or"), f"if `{exception.text}` excuses all of it"),
        (joined([*others, excused], "and"), f"if `{exception.text}` excuses `{last.text}` alone"),
    ]
