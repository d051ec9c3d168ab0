"""What rules with an exception mean: `avoid a unless b or c`, `avoid a and b except for the first 1 s of b`."""

from __future__ import annotations

import re
from typing import Final

from tltlc.grammar.english.answers import Asked
from tltlc.grammar.english.events import Event, Held, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading, Rules
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_TIMED: Final = re.compile(r"time_holding\((?P<held>[^,]*)\) (?P<sign><=|>=|<|>) (?P<time>[\d.]+ \w+)")
"""How long a condition has held, compared with a time."""
_EXACT: Final = 1e-12
_PAST: Final = ("once ", "historically ", "previously ", "begins ", "ends ")

_Found = Reading | list[Reading] | None


class Exceptions(Rules):
    """The meanings of the rules with an exception."""

    def once_within(self, duration: Duration, state: State) -> State:
        return State(f"once within {duration.text} {state.at(ATOM)}")

    # Unless something holds.

    def unless(self, answers: list[Asked], event: Event) -> _Found:
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
        return super().unless(answers, event) or _excused(state, excuse, is_avoided=is_avoided)

    def avoid_held_unless(self, state: State, sign: str, duration: Duration, event: Event) -> _Found:
        """Return the readings of `no a for more than 20 s unless b`."""
        excuse, held = as_state(event), as_state(Held(state, sign, duration))
        timed = _TIMED.fullmatch(held.text) if held is not None else None
        return _timed_unless(timed, excuse, "avoid") if timed and excuse is not None and sign in (">", ">=") else None

    def short_unless(self, state: State, duration: Duration, event: Event) -> _Found:
        return self.avoid_held_unless(state, ">", duration, event)

    def avoid_then_unless(self, first: State, *rest: State | Duration) -> _Found:
        """Return the readings of `avoid a then within 3 s b unless c`: c excuses the step of b, or that of a."""
        *time, second, excuse = rest
        assert isinstance(second, State) and isinstance(excuse, State)
        between = "then" if not time or not isinstance(time[0], Duration) else f"then within {time[0].text}"
        denied = excuse.negated()
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
        over = self._held_so_long(during[0], ">=", duration)
        if over is None:
            return None
        others = _without(state, during[0])
        return Reading((f"avoid {joined([*others, over], 'and').text}",))

    def avoid_first_of(self, state: State, duration: Duration, during: State) -> Reading | None:
        """Return the rule of `no a in the first 1 s of b`."""
        early = self._held_so_long(during, "<", duration)
        return None if early is None else Reading((f"avoid {joined([*_without(state, during), early], 'and').text}",))

    def avoid_while_except_first(self, state: State, condition: State, duration: Duration, *during: State) -> _Found:
        """Return the rule of `no a while b except for the first 1 s`, which is that of b."""
        both = joined([state, condition], "and")
        return self.avoid_except_first(both, duration, *(during or (condition,)))

    def avoid_unless_begun(self, state: State, begun: State, sign: str, duration: Duration) -> _Found:
        """Return the rule of `avoid a unless b began less than 1 s ago`."""
        if duration.is_steps or not begun.text.startswith("begins "):
            return None
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
        first, _, last = state.text.rpartition(" and ")
        apart = None if "(" in state.text else f"keep {first} and ({last} or {excuse.at(ATOM)})"
    if apart is None or state.level > OR:
        return None
    return [
        Reading((whole,), f"if `{excuse.text}` is an exception of all before it"),
        Reading((apart,), f"if it is one of `{last}` alone"),
    ]


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
