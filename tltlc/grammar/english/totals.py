"""What rules about times in total mean: of all of play, or in each period of a kind."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import is_negative
from tltlc.grammar.english.differences import Differences, Period
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Reading
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.vocabulary import NEGATED_SIGN

_LONGEST_PLAY: Final = "10 min"
"""The maximum of a time that is compared with the time of all of play."""
_MOST_TOTAL: Final = 6
"""The most steps of a total of which a clause counts each."""

_Found = Reading | list[Reading] | None


class Totals(Differences):
    """The meanings of the rules about times in total."""

    def total(self, state: State, sign: str, duration: Duration) -> _Found:
        """Return the rule of `seen at most 30 s in total`; without a clock, few steps are counted one by one."""
        if duration.is_steps and (not self._step_s or float(duration.number) <= _MOST_TOTAL):
            return super().total(state, sign, duration)
        if sign not in ("<=", "<", ">=", ">") or state.level > AND:
            return None
        keyword = "keep" if sign in ("<=", "<") else "reach"
        whole = Reading((f"{keyword} total_time({without_brackets(state.text)}) {sign} {self._in_seconds(duration)}",))
        if is_negative(state) and keyword == "reach":
            denied = f"keep total_time({state.negated().text}) {NEGATED_SIGN[sign]} {duration.text}"
            return [
                replace(whole, condition=f"for the time with `{state.text}`"),
                Reading((denied,), f"for that with `{state.negated().text}`"),
            ]
        return whole

    def half_of_time(self) -> str:
        return "0.5"

    def quarter_of_time(self) -> str:
        return "0.25"

    def tenth_of_time(self) -> str:
        return "0.1"

    def times_time(self, number: Term, _: Term) -> str:
        return number.text

    def part_of_time(self, number: Term, unit: Term) -> str | None:
        return f"{float(number.text) / 100:g}" if unit.text == "%" else None

    def time_share(self, state: State, sign: str, share: str) -> list[Reading] | None:
        """Return the rules of `hidden at least half of the time`: at the end of play, or at each step up to it."""
        if state.level > AND or is_negative(state):
            return None
        total = f"total_time({without_brackets(state.text)}, {_LONGEST_PLAY})"
        rule = f"{total} {sign} {share} * total_time(true, {_LONGEST_PLAY})"
        longest = f"no play is longer than {_LONGEST_PLAY}"
        return [
            Reading((f"require eventually always {rule}",), f"if it counts when play ends, and {longest}"),
            Reading((f"keep {rule}",), f"if it must be so at each step, and {longest}"),
        ]

    def share_at_end(self, reading: Reading) -> Reading | None:
        """Return the rule of `at the end, hidden at least half of the time`, from those at the end and at each step."""
        is_at_end = reading.clauses[0].startswith("require eventually always ")
        return replace(reading, condition=f"if no play is longer than {_LONGEST_PLAY}") if is_at_end else None

    def total_share(self, total: Term, sign: str | Term, share: str) -> list[Reading] | None:
        """Return the rules of `total_time(a) <= 20 % of the time`."""
        name, _, inner = total.text.partition("(")
        if name != "total_time" or "," in inner:
            return None
        return self.time_share(State(inner[:-1]), sign if isinstance(sign, str) else sign.text, share)

    def avoid_time_share(self, state: State, sign: str, share: str) -> list[Reading] | None:
        return self.time_share(state, NEGATED_SIGN[sign], share)

    def _in_seconds(self, duration: Duration) -> str:
        return f"{self.steps(duration) * self._step_s:.10g} s" if duration.is_steps else duration.text

    def total_reached(self, state: State, duration: Duration) -> _Found:
        return self.total(state, ">=", duration)

    def total_held(self, state: State, *rest: str | Duration) -> State | None:
        sign, duration = rest[0] if len(rest) > 1 else ">=", rest[-1]
        if not isinstance(duration, Duration) or duration.is_steps or not isinstance(sign, str):
            return None
        total = f"total_time({state.text})"
        return State(f"{total} {sign} {duration.text}", ATOM, f"{total} {NEGATED_SIGN[sign]} {duration.text}")

    def total_first(self, sign: str, duration: Duration, state: State) -> _Found:
        return self.total(state, sign, duration)

    def time_limit(self, term: Term, sign: str | Term, duration: Duration) -> _Found:
        """Return the readings of `time in the zone at most 30 s`: of each stretch, or of all of them."""
        operator = sign if isinstance(sign, str) else sign.text
        total = self.total(State(term.text), operator, duration)
        if operator not in ("<=", "<") or not isinstance(total, (Reading, list)):
            return total
        whole = total if isinstance(total, Reading) else total[0]
        return [
            replace(whole, condition="for all stretches together"),
            Reading((f"keep time_holding({term.text}) {operator} {duration.text}",), "for each stretch"),
        ]

    def total_while(self, state: State, sign: str | Term, duration: Duration, during: State) -> _Found:
        """Return the rule of `seen at most 9 s in total during storm`, for all storms together."""
        operator = sign if isinstance(sign, str) else sign.text
        both = joined([state, during], "and")
        total = self.total(both, operator, duration) if both.level <= AND else None
        whole = total[0] if isinstance(total, list) else total
        period = self.stretch_of(during)
        totals = None if period is None else self.total_in_each(state, operator, duration, period)
        if whole is None or totals is None:
            return whole
        return [
            replace(whole, condition=f"if all steps with `{during.text}` count together"),
            replace(totals[-1], condition=f"if each `{during.text}` counts anew"),
        ]

    def total_time_while(self, state: State, during: State, sign: str | Term, duration: Duration) -> _Found:
        return self.total_while(state, sign, duration, during)

    def total_in_each(self, state: State, sign: str, duration: Duration, period: Period) -> list[Reading] | None:
        """Return the rules of `seen at most 9 s in total per storm`: from each storm to the next, or while it lasts."""
        if sign not in ("<=", "<") or duration.is_steps:
            return None
        rule = f"total_time_since({state.text}, {period.event.text}) {sign} {duration.text}"
        anew = Reading((f"keep {rule}",), f"if each `{period.event.text}` begins a new count")
        if period.state is None:
            return [anew]
        inside = period.state.at(OR)
        return [anew, Reading((f"keep {inside} implies {rule}",), f"if it counts only while `{inside}` holds")]

    def total_since(self, state: State, sign: str, duration: Duration, event: State) -> Reading | None:
        """Return the rule of `seen at most 9 s in total since the checkpoint`."""
        if sign not in ("<=", "<") or duration.is_steps:
            return None
        texts = f"{without_brackets(state.text)}, {without_brackets(event.text)}"
        return Reading((f"keep total_time_since({texts}) {sign} {duration.text}",))

    def time_in_each(self, state: State, sign: str, duration: Duration, period: Period) -> _Found:
        totals = self.total_in_each(state, sign, duration, period)
        if totals is None:
            return None
        inside = "" if period.state is None else f"{period.state.at(OR)} implies "
        stretch = f"keep {inside}time_holding({state.text}) {sign} {duration.text}"
        return [*totals, Reading((stretch,), f"for each stretch with `{state.text}`")]

    def time_first_in_each(self, sign: str, duration: Duration, state: State, period: Period) -> _Found:
        return self.time_in_each(state, sign, duration, period)


def without_brackets(text: str) -> str:
    """Return a condition without brackets around the whole of it."""
    inner = text[1:-1]
    is_whole = text.startswith("(") and text.endswith(")") and inner.find("(") <= inner.find(")")
    return inner if is_whole and inner.count("(") == inner.count(")") else text
