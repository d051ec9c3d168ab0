"""What rules about an event and the one before it mean: `no two a without b between`, `b at least 2 s since a`."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.events import Event, as_state
from tltlc.grammar.english.intervals import is_edge
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Goals, Reading, Rules, When, are_simple, begun_text, not_again
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.answers import Answer
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_Found = Reading | list[Reading] | None


@record
class Sequel:
    """Two conditions, one after the other, and the time within which the second must come."""

    first: State
    second: State
    duration: Duration


class TwoEvents(Rules):
    """The meanings of the rules about two events and what is between them."""

    # How many, without another event.

    def avoid_count_without(self, state: State, number: str | Term, other: State) -> Reading | None:
        """Return the rule of `never a twice without b in between`: each b begins a new count."""
        text = number if isinstance(number, str) else number.text
        if not text.isdecimal() or int(text) < 2 or not are_simple(state, other) or state == other:
            return None
        return Reading((f"keep times_since({state.text}, {other.text}) <= {int(text) - 1}",))

    def avoid_number_without(self, number: str | Term, state: State, other: State) -> Reading | None:
        return self.avoid_count_without(state, number, other)

    def alternate(self, one: State, other: State) -> Reading | None:
        """Return the rules of `a and b alternate`: no second one without the other in between."""
        if not are_simple(one, other) or one == other:
            return None
        return Reading(
            (
                f"keep times_since({one.text}, {begun_text(other)}) <= 1",
                f"keep times_since({other.text}, {begun_text(one)}) <= 1",
            )
        )

    def never_so_often(self, state: State, number: str) -> Reading | None:
        """Return the rule of `a is never twice`, which allows it once."""
        if is_negative(state) or state.level > ATOM or not number.isdecimal() or int(number) < 2:
            return None
        return Reading((f"keep times({state.text}) <= {int(number) - 1}",))

    def value_never_so_often(self, name: Term, value: Term, number: str) -> Reading | None:
        """Return the rule of `mode is never menu twice`."""
        state = self.enum(name, value)
        return None if state is None else self.never_so_often(state, number)

    def followed_before_next(self, first: State, answer: State, again: State) -> Reading | None:
        """Return the rule of `a is followed by b before the next a`."""
        if first != again or not are_simple(first, answer):
            return None
        return Reading((f"keep times_since({first.text}, {begun_text(answer)}) <= 1",))

    def first_event(self, state: State) -> tuple[State, int]:
        return state, 1

    def nth_event(self, number: str, state: State) -> tuple[State, int]:
        return state, int(number)

    def before_next_of_nth(self, event: tuple[State, int], answer: State, again: State) -> Reading | None:
        """Return the rule of `after the third a, b before the next a`."""
        state, number = event
        if state != again or not are_simple(state, answer) or state == answer:
            return None
        came = joined([answer, State(f"times({state.text}) >= {number}")], "and")
        return Reading((f"keep begins (times({state.text}) >= {number + 1}) implies once {came.at(ATOM)}",))

    def answered_before_next(self, state: State, answer: State, again: State) -> Reading | None:
        return self.followed_before_next(state, answer, again)

    def avoid_around(self, state: State, duration: Duration, event: State) -> Reading | None:
        """Return the rules of `no a within 3 s before or after b`, both of which look back."""
        if not are_simple(state, event) or begun_text(state) == begun_text(event):
            return None
        recent = f"once within {duration.text}"
        return Reading(
            (
                f"avoid {state.text} and {recent} {event.at(ATOM)}",
                f"avoid {event.text} and {recent} {state.at(ATOM)}",
            )
        )

    def or_soon_after(self, state: State, duration: Duration, event: State) -> State | None:
        """Return the condition of `(a or within 3 s after b)`."""
        if not are_simple(state, event):
            return None
        return State(f"({state.at(OR)} or once within {duration.text} {event.at(ATOM)})")

    def avoid_soon_after(self, state: State, duration: Duration, event: State) -> Reading | None:
        """Return the rule of `no a and within 3 s after b`."""
        if not are_simple(state, event):
            return None
        return Reading((f"avoid {state.text} and once within {duration.text} {event.at(ATOM)}",))

    def avoid_during_and_after(self, state: State, during: State, duration: Duration, after: State) -> Reading | None:
        """Return the rule of `no a while b or within 2 s after b`."""
        if during != after or not are_simple(state, during):
            return None
        return Reading((f"keep once within {duration.text} {during.at(ATOM)} implies not {state.at(ATOM)}",))

    def short_then_free(self, state: State, most: Duration, other: State, pause: Duration) -> Reading | None:
        """Return the rules of `a for at most 3 s, then not a for 20 s`."""
        if state != other or state.level > ATOM or most.is_steps:
            return None
        return Reading(
            (
                f"avoid time_holding({state.text}) > {most.text}",
                f"keep ends {state.text} implies always for {pause.text} not {state.text}",
            )
        )

    def held_before_event(self, state: State, duration: Duration, event: State) -> Reading | None:
        """Return the rule of `a for at least 1 s before b`, up to the step before b begins."""
        if duration.is_steps or not are_simple(state, event) or begun_text(state) == begun_text(event):
            return None
        held = f"previously time_holding({state.text}) >= {duration.text}"
        return Reading((f"keep {begun_text(event)} implies {held}",))

    def while_only_when(self, when: When, event: Event, state: State, condition: State) -> Reading | None:
        """Return the rule of `while a, b only if c`."""
        during = as_state(event)
        if during is None or when in ("each", "after") or not are_simple(state):
            return None
        return Reading((f"keep {joined([during, state], 'and').at(OR)} implies {condition.at(OR)}",))

    def when_exactly_one(
        self, when: When, event: Event, number: Term, term: Term, duration: Duration
    ) -> Reading | None:
        """Return the rules of `after a, exactly one b within 1 s`: one comes, and no second one."""
        start = as_state(event)
        if start is None or not are_simple(start) or when == "while" or number.text != "1" or start.text == term.text:
            return None
        begun, name = begun_text(start), term.text
        return Reading(
            (
                f"keep {begun} implies eventually within {duration.text} begins {name}",
                f"keep once within {duration.text} {begun} implies times_since({name}, {begun}) <= 1",
            )
        )

    def implied_exactly_one(self, event: Event, number: Term, term: Term, duration: Duration) -> Reading | None:
        return self.when_exactly_one("when", event, number, term, duration)

    def and_never(self, *states: State) -> list[Asked] | None:
        """Return the answers of `b and never c`: no c up to that step, or from it on."""
        *asked, never = states
        if not are_simple(*asked, never) or is_negative(never) or never in asked:
            return None
        so_far = joined([*asked, State(f"not once {never.at(ATOM)}")], "and")
        from_now = joined([*asked, State(f"always {never.negated().at(ATOM)}")], "and")
        return [
            Asked(Answer("now", so_far), f"if no `{never.text}` may have come up to that step"),
            Asked(Answer("now", from_now), f"if no `{never.text}` may come from that step on", is_formula=True),
        ]

    def and_denied(self, *states: State | Goals) -> list[Asked] | None:
        """Return the answers of `b and (never c or never d)`: no c up to that step, or no d; or from it on."""
        *others, denied = states
        asked = [state for state in others if isinstance(state, State)]
        if not isinstance(denied, Goals) or not are_simple(*asked, *denied.states):
            return None
        so_far = joined([State(f"not once {never.at(ATOM)}") for never in denied.states], "or")
        from_now = joined([State(f"(always {never.negated().at(ATOM)})") for never in denied.states], "or")
        return [
            Asked(Answer("now", joined([*asked, so_far], "and")), "if it is about what came up to that step"),
            Asked(
                Answer("now", joined([*asked, from_now], "and")),
                "if it is about what comes from that step on",
                is_formula=True,
            ),
        ]

    def all_denied(self, *denied: State) -> list[Asked] | None:
        """Return the answers of `never b and never c`: up to that step, or from it on."""
        if not are_simple(*denied):
            return None
        so_far = joined([State(f"not once {never.at(ATOM)}") for never in denied], "and")
        from_now = joined([never.negated() for never in denied], "and")
        return [
            Asked(Answer("now", so_far), "if it is about what came up to that step"),
            Asked(Answer("now", State(f"always {from_now.at(ATOM)}")), "if it is about what comes from that step on",
                  is_formula=True),
        ]  # fmt: skip

    def never_and(self, never: State, state: State) -> list[Asked] | None:
        """Return the answers of `never b and c`, if c must hold: no b up to that step, or from it on."""
        return self.and_never(state, never)

    def now_or_long_after(self, state: State, duration: Duration, event: State) -> Asked | None:
        """Return the answer of `c or 60 s after a`: c, or a was so long ago."""
        if duration.is_steps or not are_simple(state, event):
            return None
        later = State(f"once {event.at(ATOM)} and time_since({event.text}) >= {duration.text}", AND)
        return Asked(Answer("now", joined([state, State(f"({later.text})")], "or")))

    def implied_chain_since(self, event: State, *states: State) -> Reading | None:
        """Return the rule of `a implies b then c since the last a`: they have come in this order since then."""
        *goals, again = states
        if event != again or not are_simple(event, *goals) or event in goals:
            return None
        begun, came = begun_text(event), goals[0]
        free = State(f"not {begun}")
        for goal in goals[1:]:
            came = joined([goal, free, State(f"previously ({free.text} since {came.at(ATOM)})")], "and")
        return Reading((f"keep {begun} implies previously ({free.text} since {joined([came, free], 'and').at(ATOM)})",))

    def only_when_never(self, state: State, never: State) -> Reading | None:
        """Return the rule of `a only if never b`."""
        if not are_simple(state, never) or state == never:
            return None
        return Reading((f"keep {state.at(OR)} implies not once {never.at(ATOM)}",))

    def avoid_then(self, first: State, *rest: Duration | State) -> _Found:
        """Return the rule of `avoid a then within 3 s b`, or `a again`, which must not begin once more."""
        second = rest[-1]
        assert isinstance(second, State)
        time = rest[0] if isinstance(rest[0], Duration) else None
        if not are_simple(first, second):
            return None
        if first == second and time is not None and "previous(" not in first.text:
            return not_again(first, second, time.text)
        between = "then" if time is None else f"then within {time.text}"
        return Reading((f"avoid {_operand(first)} {between} {_operand(second)}",))

    def none_since(self, term: Term, start: State) -> State:
        """Return the condition of `no a since b`."""
        return State(f"(not {term.text} since {start.at(ATOM)})")

    # One after the other, after an event.

    def sequence(self, first: State, second: State, duration: Duration) -> Sequel:
        return Sequel(first, second, duration)

    def sequence_behind(self, duration: Duration, first: State, second: State) -> Sequel:
        return Sequel(first, second, duration)

    def when_sequence(self, when: When, event: Event, sequel: Sequel, *exception: State) -> list[Reading] | None:
        """Return the readings of `after a, b then c within 5 s unless d`: the time counts from a, or from b."""
        start = as_state(event)
        if start is None or not are_simple(start, sequel.first, sequel.second):
            return None
        begin = begun_text(start)
        came = State(f"previously (not {begin} since {sequel.first.at(ATOM)})")
        time, done = sequel.duration.text, joined([sequel.second, State(f"not {begin}"), came], "and")
        last = State(f"eventually within {time} {sequel.second.at(ATOM)}")
        goal = joined([done, *exception], "or") if exception else done
        from_second = joined([joined([sequel.first, last], "and"), *exception], "or")
        return [
            Reading(
                (f"keep {begin} implies eventually within {time} {goal.at(ATOM)}",),
                f"if the time counts from where `{start.text}` begins, anew from each",
            ),
            Reading(
                (f"keep {begin} implies eventually {from_second.at(ATOM)}",),
                f"if it counts from `{sequel.first.text}`",
            ),
        ]

    def implied_sequence(self, event: Event, sequel: Sequel, *exception: State) -> list[Reading] | None:
        return self.when_sequence("when", event, sequel, *exception)

    def sequence_when(self, sequel: Sequel, when: When, event: Event) -> list[Reading] | None:
        return self.when_sequence(when, event, sequel)

    # The time between them.

    def avoid_just_before(self, state: State, duration: Duration, event: State) -> _Found:
        """Return the rule of `no a in the 3 s before b`; b may be another a."""
        if not are_simple(state, event):
            return None
        if begun_text(state) == begun_text(event):
            return not_again(event, state, duration.text)
        return Reading((f"keep {begun_text(event)} implies not once within {duration.text} {state.at(ATOM)}",))

    def before_avoid(self, duration: Duration, event: State, state: State) -> _Found:
        return self.avoid_just_before(state, duration, event)

    def wait_before(self, when: When, event: Event, duration: Duration, state: State) -> _Found:
        """Return the rule of `after a, wait 3 s before b`; b may be a itself, which then comes again."""
        start = as_state(event)
        if start is None or not are_simple(start, state):
            return None
        if begun_text(start) == begun_text(state):
            return not_again(start, state, duration.text)
        return Reading((f"keep {start.text} implies always for {duration.text} {state.negated().at(ATOM)}",))

    def time_between(self, first: State, second: State, sign: str, duration: Duration) -> Reading | None:
        """Return the rule of `the time between a and b is at most 5 s`, from a to b."""
        if not are_simple(first, second) or first == second:
            return None
        answer = f"eventually within {duration.text} {second.at(ATOM)}"
        if sign in (">", ">="):
            answer = f"always for {duration.text} {second.negated().at(ATOM)}"
        return Reading(
            (f"keep {begun_text(first)} implies {answer}",), f"from each `{first.text}` to a later `{second.text}`"
        )

    def elapsed_between(self, durations: tuple[Duration, Duration], event: State) -> State | None:
        least, most = (self.elapsed(sign, time, event) for sign, time in zip((">=", "<="), durations, strict=True))
        return None if least is None or most is None else joined([least, most], "and")

    def elapsed(self, sign: str, duration: Duration, event: State) -> State | None:
        """Return the condition of `at least 2 s since a begins`; a state that lasts has several such times."""
        if duration.is_steps or not is_edge(event) or event.level > ATOM:
            return None
        return State(f"time_since({event.text}) {sign} {duration.text}")

    def time_since_limit(self, state: State, sign: str | Term, duration: Duration) -> list[Reading] | None:
        """Return the readings of `the time since a is at most 5 s`: from the first step of play on, or from a."""
        text = sign if isinstance(sign, str) else sign.text
        if text not in ("<", "<=") or duration.is_steps or not are_simple(state):
            return None
        since = f"time_since({state.text}) {text} {duration.text}"
        from_start = f"keep time_holding({state.negated().text}) {text} {duration.text}"
        return [
            Reading((f"keep once {state.at(ATOM)} implies {since}",), f"if it counts from the first `{state.text}` on"),
            Reading((from_start,), "if it counts from the first step of play on"),
        ]

    def elapsed_at(self, when: When, event: Event, elapsed: State) -> Reading | None:
        """Return the rule of `when a ends, at least 2 s since a began`; the time since a itself is 0 at each a."""
        state = as_state(event)
        if state is None or when == "after" or f"time_since({state.text})" in elapsed.text:
            return None
        return Reading((f"keep {state.at(OR)} implies {elapsed.text}",))

    def elapsed_implied(self, event: Event, elapsed: State) -> Reading | None:
        return self.elapsed_at("when", event, elapsed)


def _operand(state: State) -> str:
    """Return a condition as an operand of `then`, in brackets unless it is a name."""
    return state.text if state.text.isidentifier() else f"({state.text})"
