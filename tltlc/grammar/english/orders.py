"""What the rules about orders mean: goals in any order, or with nothing between, and the values of an enum."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

from tltlc.core.record import replace
from tltlc.grammar.english.answers import Asked, is_negative
from tltlc.grammar.english.events import Counted, Event, Held, as_state
from tltlc.grammar.english.quantities import Duration
from tltlc.grammar.english.rules import Goals, Reading, Rules, When, are_simple, begun_text
from tltlc.grammar.english.terminals import Term
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined

_MOST_GOALS: Final = 8
"""The most goals that repeated goals are written out to."""
_EACH_STEP: Final = "if each step counts"
_PAIR: Final = 2
_FEWEST_VALUES: Final = 3
"""With two values, `from a to b` may be the only change that is allowed, or the only way to b."""

_Readings = list[Reading]
_Found = Reading | list[Reading] | None


class Orders(Rules):
    """The meanings of the rules about orders."""

    # What must not hold for a time after an event.

    def first(self, when: When, event: Event, answers: list[Asked]) -> _Found:
        return _denied_after(when, event, answers) or super().first(when, event, answers)

    def last(self, answers: list[Asked], when: When, event: Event) -> _Found:
        return _denied_after(when, event, answers) or super().last(answers, when, event)

    # Goals.

    def goals(self, *events: Event) -> Goals | list[Goals] | None:
        if any(isinstance(event, Counted) for event in events[1:]):
            return _counted_goals(events)
        states = [_goal(event) for event in events]
        known = [state for state in states if state is not None]
        is_clear = not any(state.text in self.exclusive for state in known)
        is_clear = is_clear and not any(state.text.startswith("times_within(") for state in known[1:])
        return Goals(tuple(known)) if len(known) == len(states) and is_clear else None

    def bare_goals(self, *events: Event) -> _Found:
        goals = self.goals(*events)
        if isinstance(goals, Goals):
            return self.reach(goals)
        return [reading for known in goals or () if isinstance(reading := self.reach(known), Reading)]

    def goal_held(self, state: State, duration: Duration) -> _Found:
        return self.bare_goals(Held(state, "", duration))

    def goals_within(self, first: Event, second: Event, duration: Duration) -> _Found:
        start, goal = _goal(first), _goal(second)
        if start is None or goal is None or not are_simple(start, goal) or is_negative(goal):
            return None
        time, a, b = duration.text, start.at(ATOM), goal.at(ATOM)
        return [
            Reading((f"keep {a} implies eventually within {time} {b}",), "if it must follow each time"),
            Reading(
                (f"reach {a} then within {time} {b}",), f"if both are goals, and the time counts from `{start.text}`"
            ),
            Reading((f"require eventually within {time} ({b} and previously once {a})",), "from the first step"),
        ]

    def repeated(self, *parts: Event | str) -> Goals | None:
        """Return goals that are repeated: `(a then b) 3 times`."""
        goals = self.goals(*(part for part in parts if not isinstance(part, str)))
        number = parts[-1]
        if not isinstance(goals, Goals) or not isinstance(number, str) or not number.isdecimal():
            return None
        return Goals(goals.states * int(number)) if 0 < int(number) * len(goals.states) <= _MOST_GOALS else None

    def repeated_then(self, *parts: Event | str) -> Goals | None:
        """Return goals that are repeated, and a last one: `(a then b) 3 times then c`."""
        goals, last = self.repeated(*parts[:-1]), parts[-1]
        state = None if isinstance(last, str) else as_state(last)
        return None if goals is None or state is None else Goals((*goals.states, state))

    def list(self, *states: State) -> Goals:
        return Goals(states)

    def reach_each(self, goals: Goals) -> _Found:
        return Reading(tuple(f"reach {state.text}" for state in goals.states))

    def reach_each_within(self, goals: Goals, duration: Duration) -> _Found:
        if any(is_negative(state) for state in goals.states):
            return None
        within = f"require eventually within {duration.text}"
        return Reading(tuple(f"{within} {state.at(ATOM)}" for state in goals.states))

    def reach_each_then(self, goals: Goals, last: State) -> _Found:
        return Reading(tuple(f"reach {state.at(OR)} then {last.at(OR)}" for state in goals.states))

    def reach_goals_before(self, goals: Goals, end: State) -> _Found:
        """Return the readings of `reach a then b before c`: all of them come before c."""
        is_nested = any(" then " in goal.text for goal in goals.states)
        if len(goals.states) < 2 or end.level > ATOM or is_nested or end in goals.states:
            return None
        free, last = end.negated().at(ATOM), _last_of(goals).at(ATOM)
        own = joined([_last_of(goals), end.negated()], "and").at(ATOM)
        return [
            Reading((f"require {free} until {own}",), f"if all of them must come before `{end.text}`"),
            Reading((f"require {free} weak_until {last}",), f"if none of them need come, but `{end.text}` not before"),
        ]

    def reach_goals_within(self, goals: Goals, duration: Duration) -> _Found:
        """Return the readings of `a then b then c within 5 s`, by the step from which the time counts."""
        return self._goals_within(goals, duration, is_for_all=bool(goals.condition))

    def _goals_within(self, goals: Goals, duration: Duration, *, is_for_all: bool) -> _Found:
        if len(goals.states) < 2:
            return None
        first, *between, last = goals.states
        if is_negative(last) or any(" then " in goal.text or "always " in goal.text for goal in goals.states):
            return None
        if goals.condition == _EACH_STEP:
            return None  # of repeated goals, each beginning counts
        time, earlier, whole = duration.text, [first, *between], _last_of(goals)
        readings = [
            Reading(
                (f"require eventually within {time} {whole.at(ATOM)}",),
                "if the time is for all of them, from the first step of play on",
            )
        ]
        if between and _may_begin(first) and goals.states.count(first) == 1:
            # The time counts from the last beginning of the first goal.
            timed = joined([last, State(f"once within {time} {begun_text(first)}")], "and")
            goal = " then ".join([*(state.at(OR) for state in earlier), timed.at(ATOM)])
            where = f"from where `{first.text}` begins, the last time if it begins again"
            readings.append(Reading((f"reach {goal}",), f"if it is for all of them, {where}"))
        if is_for_all:
            return readings
        rest, nearest = f"then within {time} {last.at(OR)}", earlier[-1]
        if _may_begin(nearest) and not nearest.text.startswith(("begins ", "ends ")):
            begun = " then ".join([*(state.at(OR) for state in earlier[:-1]), begun_text(nearest)])
            readings.append(Reading((f"reach {begun} {rest}",), f"if it counts from where `{nearest.text}` begins"))
        goal = " then ".join(state.at(OR) for state in earlier)
        where = f"any step with `{nearest.text}`, such as the last"
        return [*readings, Reading((f"reach {goal} {rest}",), f"if it counts from {where}")]

    def reach_all_goals_within(self, goals: Goals, duration: Duration) -> _Found:
        """Return the readings of `a then b then c, all within 5 s`, without those of the last step alone."""
        return self._goals_within(goals, duration, is_for_all=len(goals.states) > _PAIR)

    def reach_goals_within_of(self, goals: Goals, duration: Duration, start: State) -> _Found:
        """Return the goal of `a then b then c within 5 s of a`: the time counts from one of the goals before c."""
        *earlier, last = goals.states
        texts = [goal.text.removeprefix("begins ") for goal in earlier]
        if texts.count(start.text.removeprefix("begins ")) != 1:
            return None
        at = texts.index(start.text.removeprefix("begins "))
        goal = " then ".join(state.at(OR) for state in earlier)
        if at == len(earlier) - 1:
            return Reading((f"reach {goal} then within {duration.text} {last.at(OR)}",))
        timed = joined([last, State(f"once within {duration.text} {begun_text(earlier[at])}")], "and")
        return Reading((f"reach {goal} then {timed.at(ATOM)}",))

    def reach_goals_within_of_first(self, goals: Goals, duration: Duration, start: State) -> _Found:
        reading = self.reach_goals_within_of(goals, duration, start)
        return replace(reading, condition=f"if `{start.text}` begins once") if isinstance(reading, Reading) else None

    def reach_goals_within_of_value(self, goals: Goals, duration: Duration, value: Term) -> _Found:
        name = self.enum_of(value)
        start = None if name is None else State(f"{name.text} is {value.text}")
        return None if start is None else self.reach_goals_within_of(goals, duration, start)

    def within_reach_goals(self, duration: Duration, goals: Goals) -> _Found:
        return self.reach_goals_within(goals, duration)

    def bare_goals_within(self, *parts: Event | Duration) -> _Found:
        duration = parts[-1]
        assert isinstance(duration, Duration)
        goals = self.goals(*(part for part in parts if not isinstance(part, Duration)))
        return self.reach_goals_within(goals, duration) if isinstance(goals, Goals) else None

    def goals_without(self, goals: Goals, avoided: State) -> _Found:
        between = self.goals_without_between(goals, avoided)
        if between is None or avoided.level > ATOM:
            return None
        goal = " then ".join(state.at(OR) for state in goals.states)
        never = f"if `{avoided.text}` must hold at no step of play"
        return [Reading((f"reach {goal}", f"avoid {avoided.text}"), never), *between]

    def held_last_without(self, goals: Goals, state: State, duration: Duration, avoided: State) -> Reading | None:
        """Return the goal of `reach a then b for 2 s without c`, if c is about these 2 s alone."""
        if duration.is_steps or not are_simple(state, avoided) or state == avoided:
            return None
        held = f"time_holding({joined([state, avoided.negated()], 'and').text}) >= {duration.text}"
        goal = " then ".join([*(each.at(OR) for each in goals.states), held])
        return Reading((f"reach {goal}",), f"if `{avoided.text}` must not hold in those {duration.text}")

    def goals_without_between(self, goals: Goals, avoided: State) -> _Readings | None:
        """Return the readings of `reach a then b with no c in between`: the first and the last step count, or not."""
        first, last = goals.states[0], goals.states[-1]
        if len(goals.states) < 2 or any(state.text == avoided.text for state in goals.states):
            return None
        free = [joined([state, avoided.negated()], "and") for state in goals.states]
        some = "one with " * _may_last(first)
        which, between = f"{some}`{first.text}` to `{last.text}`", f"`{first.text}` and `{last.text}`"
        return [
            Reading((_without(free, avoided),), f"if no step from {which} may have it, these two included"),
            Reading((_without([first, *free[1:-1], last], avoided),), f"if only no step between {between} may have it"),
        ]

    def change_alone(self, state: State) -> _Found:
        """Return the goal of `phase becomes results`, which no word makes a rule."""
        settled = self.settled.get(state.text)
        if settled is None:
            return None
        return Reading((f"reach {settled.text if state.text.startswith('begins ') else state.text}",))

    # The values of an enum.

    def order(self, name: Term, *values: Term) -> _Found:
        """Return both readings of `quest: none -> active -> done`: goals, or the order of all changes."""
        goals, rule = [self.enum(name, value) for value in values], self.only_goes(name, *values)
        if not isinstance(rule, Reading):
            return None
        clause = f"reach {' then '.join(state.text for state in goals if state is not None)}"
        return [
            Reading((clause,), "if it must go through them"),
            Reading(rule.clauses, "if it may change in this order only"),
        ]

    def only_goes(self, name: Term, *values: Term) -> _Found:
        if name.declared is None or len(values) < _FEWEST_VALUES:
            return None
        following: dict[str, list[str]] = {value.text: [value.text] for value in values}
        for value, after in pairwise(value.text for value in values):
            following[value] += [after] if after not in following[value] else []
        if not following.keys() <= {*name.declared.values}:
            return None
        clauses = []
        for value, allowed in following.items():
            states = joined([State(f"{name.text} is {text}") for text in allowed], "or")
            clauses.append(f"keep {name.text} is {value} implies weak_next {states.at(ATOM)}")
        return Reading(tuple(clauses))

    def only_from(self, *parts: Term) -> _Found:
        """Return the rule of `guard becomes chase only from suspicious`, or of `chase only from suspicious`."""
        name = parts[0] if parts[0].kind == "ENUM" else self.enum_of(*parts)
        if name is None:
            return None
        value, *before = parts[1:] if parts[0].kind == "ENUM" else parts
        state, origin = self.enum_begins(name, value), self.enum(name, *before)
        if state is None or origin is None:
            return None
        return Reading((f"keep {state.text} implies previously {origin.at(ATOM)}",))

    def only_to(self, name: Term, value: Term, *after: Term) -> _Found:
        state, following = self.enum_ends(name, value), self.enum(name, *after)
        return None if state is None or following is None else Reading((f"keep {state.text} implies {following.text}",))

    def only_to_first(self, value: Term, name: Term, *after: Term) -> _Found:
        return self.only_to(name, value, *after)

    def reach_keeping(self, goal: State, kept: State) -> Reading:
        """Return the rule of `reach a and b until then`."""
        return Reading((f"require {kept.at(ATOM)} until {goal.at(ATOM)}",))

    def values_only_after(self, name: Term, *values: Term) -> _Found:
        states = [self.enum(name, value) for value in values]
        known = [state for state in states if state is not None]
        if len(known) < len(states):
            return None
        pairs = zip(known[::2], known[1::2], strict=True)
        return Reading(tuple(f"keep {late.text} implies once {early.at(ATOM)}" for late, early in pairs))

    # What comes right after another thing.

    def value_follows(self, name: Term, late: Term, early: Term) -> _Found:
        one, other = self.enum(name, late), self.enum(name, early)
        return None if one is None or other is None else self.directly_follows(one, other)

    def directly_follows(self, late: State, early: State) -> _Found:
        if max(late.level, early.level) > ATOM:
            return None
        return Reading((f"keep {begun_text(late)} implies previously {early.at(ATOM)}",))

    def directly_followed(self, early: State, late: State) -> _Found:
        if max(late.level, early.level) > ATOM:
            return None
        return Reading((f"keep ends {early.at(ATOM)} implies {late.at(OR)}",))

    def never_follows(self, late: State, early: State) -> _Found:
        if max(late.level, early.level) > ATOM:
            return None
        before = State(f"previously {early.at(ATOM)}")
        return Reading((f"avoid {joined([before, late], 'and').text}",))

    def never_directly_after(self, late: State, early: State) -> _Found:
        """Return the readings of `no b right after a`: at the step after each step with a, or after its end."""
        clause = self.never_follows(late, early)
        if not isinstance(clause, Reading):
            return None
        if not _may_last(early) or _are_values(late, early):
            return clause
        ended = joined([State(f"ends {early.at(ATOM)}"), late], "and")
        return [
            Reading(clause.clauses, f"if the step after each step with `{early.text}` counts"),
            Reading((f"avoid {ended.text}",), f"if only the step at which `{early.text}` has ended counts"),
        ]

    def must_be_directly_after(self, late: State, early: State) -> _Found:
        """Return the readings of `b right after a`: each a is followed by b, or b follows a alone."""
        follows = self.directly_follows(late, early)
        if not isinstance(follows, Reading) or self.is_coming:
            return None  # `b comes right after a` is about b alone
        next_ = State(f"weak_next {late.at(ATOM)}")
        ended = f"keep ends {early.at(ATOM)} implies {late.at(OR)}"
        readings = [
            Reading((ended,), f"if it must hold where `{early.text}` ends"),
            Reading((f"keep {early.at(OR)} implies {next_.text}",), f"if at the step after each `{early.text}`"),
            Reading(follows.clauses, f"if it may begin only there, and need not come after each `{early.text}`"),
        ]
        return readings if _may_last(early) else readings[1:]

    def reach_directly_after(self, late: State, early: State) -> _Found:
        if is_negative(late) or max(late.level, early.level) > ATOM:
            return None
        return Reading((f"reach {joined([State(f'previously {early.at(ATOM)}'), late], 'and').text}",))

    def directly_after(self, event: State, answers: Sequence[Asked]) -> _Found:
        """Return the readings of `right after a, b`: at the step after each step with a, or after its end."""
        if any(asked.answer.kind not in ("now", "always") for asked in answers):
            return self.first("after", event, [*answers])
        if event.level > ATOM or any(asked.is_formula or asked.answer.keyword == "reach" for asked in answers):
            return None
        states = [self.settled.get(asked.answer.state.text, asked.answer.state) for asked in answers]
        asked_for = joined(states, "and")
        after_each = Reading((f"keep {event.text} implies weak_next {asked_for.at(ATOM)}",))
        if not _may_last(event):
            return after_each
        return [
            Reading(after_each.clauses, f"if the step after each step with `{event.text}` counts"),
            Reading(
                (f"keep ends {event.at(ATOM)} implies {asked_for.at(OR)}",),
                f"if only the step at which `{event.text}` has ended counts",
            ),
        ]

    def never_goes(self, early: State, late: State) -> _Found:
        return self.never_follows(late, early)


def _without(states: Sequence[State], avoided: State) -> str:
    """Return the clause of goals with no step between one and the next that has something."""
    *before, goal = states
    for state in reversed(before):
        following = f"next ({avoided.negated().at(ATOM)} until {goal.at(ATOM)})"
        goal = joined([state, State(following)], "and")
    return f"reach {goal.text}"


def _denied_after(when: When, event: Event, answers: list[Asked]) -> list[Reading] | None:
    """Return the readings of `no b for 2 s after a`, if a may last: from each step with a on, or from its end on."""
    answer = answers[0].answer
    is_denied = answer.kind == "lasting" and is_negative(answer.state) and are_simple(answer.state)
    if when != "after" or answers[1:] or not is_denied or not isinstance(event, State) or not _may_last(event):
        return None
    if event.text == answer.state.negated().text:
        return None  # an event that must not come again
    ending = event.text if event.text.isidentifier() else f"({event.text})"
    denied = f"always for {answer.time} {answer.state.at(ATOM)}"
    return [
        Reading((f"keep {event.at(OR)} implies {denied}",), f"from each step with `{event.text}` on"),
        Reading((f"keep ends {ending} implies {denied}",), "from its end on"),
    ]


def _may_last(event: State) -> bool:
    """Whether an event is a bool, or the value of an enum."""
    return event.text.isidentifier() or (event.level == ATOM and re.fullmatch(r"\w+ is \w+", event.text) is not None)


def _are_values(one: State, other: State) -> bool:
    """Whether two conditions are different values of one enum, of which the second ends the first."""
    values = [state.text.split(" ") for state in (one, other)]
    is_enum = all(len(words) == 3 and words[1] == "is" for words in values)
    return is_enum and values[0][0] == values[1][0] and values[0] != values[1]


def _may_begin(state: State) -> bool:
    """Whether the beginning of a goal is a condition that a writer may mean by it."""
    return state.level == ATOM and not state.text.startswith(("time", "not "))


def _goal(event: Event) -> State | None:
    """Return a goal: `hidden for 4 steps` begins at the first of them, behind the goal before."""
    if isinstance(event, Held) and event.sign in ("<", "<="):
        return None  # the first step of it would do
    if not isinstance(event, Held) or not event.duration.is_steps or event.sign not in ("", ">="):
        return as_state(event)
    number, held = event.duration.number, event.state.at(ATOM)
    if not number.isdecimal() or int(number) < 2:
        return None
    last = int(number) - 1
    return State(f"(always for {number} steps {held}) and next after {last} step{'s' * (last > 1)} {held}", AND)


def _counted_goals(events: Sequence[Event]) -> list[Goals] | None:
    """Return `a then b 2 times` as `a then b then b`, since a count begins at the first step, not at the goal before.

    Each step counts, or each beginning.
    """
    readings = []
    for is_begun, condition in ((True, "if steps in a row count once"), (False, _EACH_STEP)):
        states: list[State] = []
        for at, event in enumerate(events):
            if at and isinstance(event, Counted):
                if event.sign not in ("", ">=") or not event.number.isdecimal():
                    return None
                states += [State(begun_text(event.state)) if is_begun else event.state] * int(event.number)
            else:
                state = _goal(event)
                if state is None:
                    return None
                states.append(state)
        if len(states) > _MOST_GOALS:
            return None
        readings.append(Goals(tuple(states), condition))
    return readings


def _last_of(goals: Goals) -> State:
    """Return the condition of the last goal at a step before which the others have come, in their order."""
    whole, *later = goals.states
    for state in later:
        whole = joined([state, State(f"previously once {whole.at(ATOM)}")], "and")
    return whole
