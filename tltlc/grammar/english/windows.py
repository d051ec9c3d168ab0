"""Rules about a window of time, such as the last seconds of play; no clause can say a total or a mean of one."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.grammar.english.differences import Difference, Differences, changed
from tltlc.grammar.english.events import Counted, Event, as_state
from tltlc.grammar.english.intervals import Every
from tltlc.grammar.english.quantities import Change, Duration, Number, begun
from tltlc.grammar.english.rules import Reading, When
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import ATOM, OR, State, joined
from tltlc.grammar.past_words import MOST_STEPS_BACK

_Found = Reading | list[Reading] | None


class Windows(Differences):
    """The meanings of the rules about the start and the end of play, and about windows of time."""

    def time_in_window(self, state: State, sign: str, time: Duration, window: Duration) -> Reading | None:
        """Return the rule of `a for at most 2 s in any 10 s`."""
        if not 0 < self.steps(window) <= MOST_STEPS_BACK:
            self._let_game_record(
                f"adds up the time of `{state.text}` in the {window.text} up to a step, unless these are "
                f"{MOST_STEPS_BACK} steps or less "
                f"(`times_within({state.text}, {window.text})` counts how often it begins)",
                f"{_name(state.text)}_time: time in [0 s, 60 s]",
            )
            return None
        if time.is_steps or sign not in ("<", "<="):
            return None
        return Reading((f"keep total_time_within({state.text}, {window.text}) {sign} {time.text}",))

    def avoid_time_in_window(self, state: State, sign: str, time: Duration, window: Duration) -> Reading | None:
        return self.time_in_window(state, {">": "<=", ">=": "<"}.get(sign, ""), time, window)

    def time_first_in_window(self, sign: str, time: Duration, state: State, window: Duration) -> Reading | None:
        return self.time_in_window(state, sign, time, window)

    def times_in_window(self, count: Term, sign: Term, number: Term, window: Duration) -> State | None:
        """Return the condition of `times(a) >= 3 within 5 s`."""
        event = count.text.removeprefix("times(").removesuffix(")")
        if not count.text.startswith("times(") or "," in event:
            return None
        return State(f"times_within({event}, {window.text}) {sign.text} {number.text}")

    def at_end(self, state: State) -> Reading:
        return Reading((f"require eventually always {state.at(ATOM)}",))

    def at_start(self, state: State) -> Reading:
        return Reading((f"require {state.text}",))

    def last_seconds(self, duration: Duration, *states: State) -> Reading:
        """Return the rule of `in the last 10 s no a and b`, about the end of play."""
        held = f"time_holding({joined([*states], 'and').text}) >= {duration.text}"
        return Reading((f"require eventually always {held}",))

    def reached_then_kept(self, goal: State, duration: Duration, state: State) -> Reading:
        reached = f"require eventually within {duration.text} {goal.at(ATOM)}"
        return Reading((reached, f"keep {goal.at(OR)} implies always {state.at(ATOM)}"))

    def when_count_within(self, when: When, event: Event, counted: Counted, window: Duration) -> Reading | None:
        """Return the rule of `after a, at most 3 b within 5 s`: the count begins with the last a."""
        state = as_state(event)
        if state is None or when in ("while", "as long as") or counted.sign in ("", "=="):
            return None
        start = begun(state)
        since = f"times_since({counted.state.text}, {start.text}) {counted.sign or '>='} {counted.number}"
        if counted.sign in ("<", "<="):
            return Reading((f"keep once within {window.text} {start.at(ATOM)} implies {since}",))
        return Reading((f"keep {start.at(OR)} implies eventually within {window.text} {since}",))

    def when_count_in_any(self, when: When, event: Event, counted: Counted, window: Duration) -> Reading | None:
        """Return the rule of `when a, at most 3 b in any 5 s`: the window ends at each step with a."""
        state = as_state(event)
        if state is None or when in ("each", "after") or counted.sign not in ("<", "<="):
            return None
        count = f"times_within({counted.state.text}, {window.text}) {counted.sign} {counted.number}"
        return Reading((f"keep {state.at(OR)} implies {count}",))

    def count_in_any_implied(self, event: Event, counted: Counted, window: Duration) -> Reading | None:
        return self.when_count_in_any("when", event, counted, window)

    def count_within_after(self, counted: Counted, window: Duration, event: Event) -> Reading | None:
        return self.when_count_within("after", event, counted, window)

    def change_in_window(self, difference: Difference, window: Duration) -> Reading | None:
        """Return the rule of `health falls by at most 5 in 3 s`, which compares it with the highest value in them."""
        name, change = difference.term.text, difference.change
        is_short = 0 < self.steps(window) <= MOST_STEPS_BACK
        if is_short and change == "varies" and difference.sign in ("<", "<="):
            ends = (f"{extreme}_within({name}, {window.text})" for extreme in ("highest", "lowest"))
            return Reading((f"keep {' - '.join(ends)} {difference.sign} {difference.step.text}",))
        if not is_short or change not in ("falls", "rises") or difference.sign not in ("<", "<="):
            before = f" (`previous({name}, {window.text})` is the value {window.text} before)" if is_short else ""
            what = f"says by how much `{name}` changes in {window.text}{before}"
            self._let_game_record(what, f"{_name(name)}_change in [-100, 100]")
            return None
        extreme = "highest" if change == "falls" else "lowest"
        before = f"previous({name})" if self.steps(window) == 1 else f"{extreme}_within({name}, {window.text})"
        value = Number(before, difference.term)
        rule = changed(difference, value)
        return None if rule is None else Reading((f"keep {rule.text}",))

    def avoid_change_in_window(self, difference: Difference, window: Duration) -> Reading | None:
        sign = {">": "<=", ">=": "<"}.get(difference.sign, "")
        return self.change_in_window(replace(difference, sign=sign), window)

    def cannot_change_within(self, term: Term, change: Change, sign: str, step: Number, window: Duration) -> _Found:
        return self.avoid_change_in_window(Difference(term, change, sign, step), window)

    def highest_in(self, term: Term, window: Duration) -> Number | None:
        return self._extreme_in("highest", term, window)

    def lowest_in(self, term: Term, window: Duration) -> Number | None:
        return self._extreme_in("lowest", term, window)

    def _extreme_in(self, extreme: str, term: Term, window: Duration) -> Number | None:
        is_short = self.value_before(term, window) is not None
        return Number(f"{extreme}_within({term.text}, {window.text})", term) if is_short else None

    def mean_of(self, term: Term, *windows: Duration) -> None:
        self._let_game_record(f"takes the mean of `{term.text}`", f"{_name(term.text)}_mean in [0, 100]")

    def at_least_every(self, every: Every) -> Reading | list[Reading] | None:
        return None if self._adds_up(every) else super().at_least_every(every)

    def at_least_every_while(self, every: Every, when: When, event: Event) -> Reading | list[Reading] | None:
        return None if self._adds_up(every) else super().at_least_every_while(every, when, event)

    def _adds_up(self, every: Every) -> bool:
        """Whether what must come is a change by an amount: `honey rises by at least 20 every 15 s`."""
        text = every.state.text
        if "previous(" not in text or not {"+", "-"} & {*text.split()}:
            return False
        self._let_game_record(
            f"says by how much a number changes in {every.duration.text}", "recent_change in [-100, 100]"
        )
        return True

    def _let_game_record(self, what: str, signal: str) -> None:
        self.limits.append(
            f"no clause {what}: let the game record that number as a signal, such as `signal {signal}`, and compare it"
        )


def _name(text: str) -> str:
    """Return a name for a number about a condition or another number."""
    return text if text.isidentifier() else "recent"
