"""Say what counts at the edges of goals, times and events: at the same step, at the first step, where play ends."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.remembered_formulas import (
    broken_rule,
    counted,
    counted_since,
    names_read,
    past_operands,
    waited_for,
)
from tltlc.automaton.text import times_of
from tltlc.automaton.value_phrases import value_words
from tltlc.core.names import ComparisonName, split_name
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Condition, Const, SignalValue, nodes
from tltlc.logic import formula as f
from tltlc.logic.bounded_operators import Bounded, bounded_operator
from tltlc.logic.formula import Formula
from tltlc.logic.text.phrases import bracketed_phrase, is_state
from tltlc.logic.text.sequences import next_goal
from tltlc.monitor.failure_words import atom_words
from tltlc.resolve.spec import Atom, Register

_WAITS: Final = ("late", "passed", "recent")
"""The timers, whose first argument is a time, that say how long something may take."""
_LASTING: Final = ("breach", "lasted", "lately")
"""Those that say how long something must last."""
_MOST_GOALS: Final = 4
_FROM_NEXT: Final = "the next "
"""What stands before a time that begins at the next step."""


def boundaries(fspa: Fspa) -> tuple[str, ...]:
    """Return a sentence for each place where a reader may count one step more or less than the spec.

    They speak of finite traces, so that there are none over infinite ones, nor if another tool made the automaton.
    """
    if fspa.semantics == "infinite" or not isinstance(fspa.formula, Formula):
        return ()
    return tuple(dict.fromkeys(_Boundaries(fspa, fspa.formula).all()))


class _Boundaries:
    """Finds what counts at the edges of one spec."""

    def __init__(self, fspa: Fspa, formula: Formula) -> None:
        self._fspa, self._formula, self._speaker = fspa, formula, Speaker(fspa)
        self._registers = {register.name: register for register in fspa.registers}

    def all(self) -> Iterator[str]:
        yield from self._goals()
        yield from self._events()
        yield from self._ends()
        yield from self._times()
        for index, item in enumerate(self._fspa.atoms):
            yield from self._time_in_a_row(index, item)
        yield from self._windows()
        for register in self._fspa.registers:
            yield from self._since(register)
        if any(map(self._is_sum_of_fractions, self._fspa.atoms)):
            yield "results with fractions are rounded: an exact limit may be missed by the last digit"

    def _goals(self) -> Iterator[str]:
        """Yield what is to know of goals behind `then`: they may have come, or begun, before."""
        goals: dict[str, None] = {}
        for node in self._formula.walk():
            following = next_goal(node)
            if following is None or following.link != "then" or following.steps is not None:
                continue
            goal, before = _state_of(following.body), _state_of(node)
            if goal is not f.TRUE and self._may_last(before, goal):
                goals[bracketed_phrase(self._speaker.spoken(goal))] = None
        goals.update(dict.fromkeys(self._goals_behind_earlier_ones()))
        if goals:
            rest = ", and so on" if len(goals) > _MOST_GOALS else ""
            names = ", then ".join([*goals][:_MOST_GOALS])
            yield f"then {names}{rest}: any later step counts, also if it began before; `begins` asks for a beginning"
        if self._is_goal_order():
            yield "before its turn, a goal does not count, and breaks nothing"

    def _goals_behind_earlier_ones(self) -> Iterator[str]:
        """Yield what must come together with something at an earlier step: b in `reach b and previously once a`."""
        bodies = [operator.body for operator, _ in _bounded_operators(self._formula) if operator.op == "F"]
        for node, is_positive in _signed(self._formula):
            # A time from the first step of play on is an `until`.
            bodies += node.args[-1:] if node.op in ("F", "U") and is_positive else ()
        if not bodies:
            return
        remembered = (part for register in self._fspa.registers for part in past_operands(register) or ())
        bodies = [*remembered, *bodies]
        for body in bodies:
            earlier = [name for name in body.atoms() if self._speaker.is_earlier(name)] if body.op == "and" else []
            goal = f.and_(*(part for part in body.args if part.op == "atom" and part.name not in earlier))
            if earlier and goal is not f.TRUE and not any(map(self._speaker.is_about_past, goal.atoms())):
                yield bracketed_phrase(self._speaker.spoken(goal))

    def _is_goal_order(self) -> bool:
        """Whether the spec asks for goals in order, and does not only forbid an order."""
        return any(next_goal(node) is not None and is_positive for node, is_positive in _signed(self._formula))

    def _may_last(self, before: Formula, goal: Formula) -> bool:
        """Whether a goal may hold at the step of the goal before it, and be no event, which holds at single steps."""
        names, earlier = set(goal.atoms()), set(before.atoms())
        if names & earlier or any(map(self._speaker.is_about_past, names)):
            return False
        atoms = self._fspa.atoms
        groups = ({atoms[index].name for index in group} for group in self._fspa.exclusive)
        return not any(group & names and group & earlier for group in groups)

    def _events(self) -> Iterator[str]:
        """Yield what is to know of beginnings: which steps they are, and that the first step may be one."""
        turns = (turn for literals in self._conjunctions() for turn in self._speaker.turns(literals)[0])
        begun = dict.fromkeys(turn.text for turn in turns if turn.verb == "begin")
        if begun:
            names = ", ".join(begun)
            yield f"{names}: at the first of its steps in a row; also at the first step of play, if it holds there"

    def _conjunctions(self) -> Iterator[tuple[Formula, ...]]:
        """Yield the parts of the conjunctions in guards, in the formula, and in what timers remember."""
        atoms = [f.atom(item.name) for item in self._fspa.atoms]
        guards = [edge.guard.primes for edge in self._fspa.edges]
        broken = [clause.primes for edge in self._fspa.edges for clause in edge.broken]
        for prime in dict.fromkeys(prime for primes in (*guards, *broken) for prime in primes):
            yield tuple(atoms[index] if holds else f.not_(atoms[index]) for index, holds in prime)
        formulas = [self._formula]
        for register in self._fspa.registers:
            answer, rule = waited_for(register), broken_rule(register, self._registers)
            formulas += answer[:2] if answer is not None else ()
            formulas += rule if rule is not None else ()
        for formula in formulas:
            for node in formula.walk():
                if node.op == "and":
                    yield node.args

    def _ends(self) -> Iterator[str]:
        """Yield what is to know of `until`: what it keeps may have ended at the step that ends it."""
        for node, is_positive in _signed(self._formula):
            if node.op not in ("U", "W") or not is_positive or not all(map(is_state, node.args)):
                continue
            kept, end = node.args
            if set(kept.atoms()) & set(end.atoms()) or not self._speaker.timers.isdisjoint(node.atoms()):
                continue
            denied = kept.op == "not"
            words = bracketed_phrase(self._speaker.spoken(kept.args[0] if denied else kept))
            free = f"{words} is allowed" if denied else f"{words} is not asked for"
            yield f"until {bracketed_phrase(self._speaker.spoken(end))}: at that step itself, {free}"

    def _times(self) -> Iterator[str]:
        """Yield what is to know of `within` and `for`: which steps count, and what the end of play does."""
        counts = times_of(self._fspa)
        waits, lasting, later = dict[str, None](), dict[str, None](), dict[str, None]()
        for operator, is_next in _bounded_operators(self._formula):
            time = counts.time(operator.steps + (is_next or operator.op == "G"))
            (waits if operator.op == "F" else later if is_next else lasting)[time] = None
            if operator.op == "F" and any(part.op in ("G", "W", "U", "R") for part in operator.body.walk()):
                yield "what must hold from then on may also hold and end again before that step"
        for item in self._fspa.atoms:
            if item.timer is not None and item.base in (*_WAITS, *_LASTING) and len(item.arguments) > 1:
                time = item.arguments[0].removeprefix(_FROM_NEXT)
                is_next = time != item.arguments[0]
                (waits if item.base in _WAITS else later if is_next else lasting)[time] = None
        for time in waits:
            yield f"within {time}: up to and including the step {time} later"
        if waits:
            yield "where play ends before that, what has not come counts as missed"
        for time in lasting:
            yield f"for {time}: from that step on, but no longer at the step {time} later"
        for time in later:
            yield f"for the next {time}: up to and including the step {time} later"
        if lasting or later:
            yield "where play ends during such a time, nothing more is asked for"

    def _time_in_a_row(self, index: int, item: Atom) -> Iterator[str]:
        """Yield from which step in a row on an atom that compares a `time_holding` holds."""
        read = [self._registers[name] for name in names_read(item) if name in self._registers]
        if len(read) != 1 or read[0].kind != "time_holding":
            return
        change, held = _change(self._fspa, item, read[0]), counted(read[0], self._registers)
        if change is None or held is None or self._speaker.turns(held.args)[0]:
            return
        number, holds = change
        words = atom_words(self._fspa, index, holds=holds)
        yield f"{words}: from the {_ordinal(number)} step in a row with {self._speaker.object_text(held)}"

    def _windows(self) -> Iterator[str]:
        """Yield the step at the edge of the last seconds."""
        windows = filter(None, map(self._speaker.window, self._fspa.atoms))
        counts = [register for register in self._fspa.registers if register.kind == "times_within"]
        for time in dict.fromkeys((*map(self._window_of, counts), *(time for time, is_recent in windows if is_recent))):
            yield f"in the last {time}: at this step, or at one up to and including the step {time} before"

    def _window_of(self, register: Register) -> str:
        """Return the time in which a register of ``times_within(p, T)`` counts, in whole steps of the clock."""
        limits = (node.args[1] for node in nodes(register.update) if isinstance(node, Condition) and node.op == "<=")
        steps = next((limit.value for limit in limits if isinstance(limit, Const)), None)
        if self._fspa.clock_varies or steps is None:
            return split_name(register.name)[1][-1]
        return times_of(self._fspa).time(int(steps))

    def _since(self, register: Register) -> Iterator[str]:
        """Yield what is to know of counts and values since an event, and of times in all."""
        operand, event = counted(register, self._registers), counted_since(register)
        words = "it" if operand is None else self._speaker.object_text(operand)
        if register.kind == "value_at" and event is not None:
            value = value_words(register, self._speaker.event_text(register))
            yield f"{value}: at {self._speaker.noun_text(event)} itself, the one of that step"
        if register.kind == "times_since" and event is not None:
            begun = f"{words} since {self._speaker.noun_text(event)}"
            yield f"{begun}: what begins at that very step counts, what goes on from before does not"
        if register.kind == "total_time_since" and event is not None:
            yield f"how long {words} has held since {self._speaker.noun_text(event)}: that very step counts"
        if register.kind in ("total_time", "total_time_since"):
            yield f"how long {words} has held in all: the first step of play adds nothing, since no time has passed"

    def _is_sum_of_fractions(self, item: Atom) -> bool:
        """Whether an atom compares what is computed from numbers with fractions, in which digits may be rounded."""
        name, read = item.base, names_read(item)
        if not isinstance(name, ComparisonName):
            return False
        if not any(sign in f"{name.left} {name.right}" for sign in (" + ", " - ", " * ", " / ")):
            return False
        for register in filter(None, map(self._registers.get, tuple(read))):
            read.update(node.name for node in nodes(register.update) if isinstance(node, SignalValue))
        return any(signal.name in read and signal.type not in ("int", "bool") for signal in self._fspa.signals)


def _state_of(body: Formula) -> Formula:
    """Return the conditions of a goal on its own step, without what follows."""
    return f.and_(*(part for part in (body.args if body.op == "and" else (body,)) if is_state(part)))


def _bounded_operators(formula: Formula) -> Iterator[tuple[Bounded, bool]]:
    """Yield the bounded operators of a formula, each with whether it begins at the next step.

    Inside a negation, F is yielded for G, and G for F.
    """
    for node, is_positive in _signed(formula):
        is_next = node.op in ("X", "N")
        operator = bounded_operator(node.args[0] if is_next else node)
        if operator is not None:
            yield operator if is_positive else operator._replace(op="G" if operator.op == "F" else "F"), is_next


def _signed(formula: Formula) -> Iterator[tuple[Formula, bool]]:
    """Yield the parts of a formula, each with whether it stands inside an even number of negations.

    Of a bounded operator, or a `next` before one, the parts are those of its operand.
    """
    pending, seen = [(formula, True)], set[tuple[Formula, bool]]()
    while pending:
        node, is_positive = item = pending.pop()
        if item in seen:
            continue
        seen.add(item)
        yield item
        operator = bounded_operator(node.args[0] if node.op in ("X", "N") else node)
        if operator is not None:
            pending.append((operator.body, is_positive))
            continue
        denied = node.args[:1] if node.op in ("not", "implies") else ()
        pending += ((part, is_positive != (index < len(denied))) for index, part in enumerate(node.args))


def _change(fspa: Fspa, item: Atom, register: Register) -> tuple[int, bool] | None:
    """Return at which step in a row, from 1, an atom that compares a time changes, and its truth from then on.

    None if the number of steps is not known, or if the atom never changes.
    """
    if register.unit != "steps" or register.high is None:
        return None
    if not isinstance(item.base, ComparisonName) or item.base.operator == "==":
        return None
    params = {param.name: param.value for param in fspa.params}

    def holds(steps: int) -> bool:
        return evaluate(item.expression, {register.name: float(steps)}, params) > 0.0

    low, high = 0, int(register.high)
    if holds(low) == holds(high):
        return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) == holds(low) else (low, middle)
    return high + 1, holds(high)


def _ordinal(number: int) -> str:
    endings = {1: "st", 2: "nd", 3: "rd"}
    return f"{number:,}{'th' if number % 100 in (11, 12, 13) else endings.get(number % 10, 'th')}"
