"""Timers: atoms that say how much time has passed, and the registers behind them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

from tltlc.core.names import full_name
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When, depth
from tltlc.io.limits import ARITHMETIC
from tltlc.logic.formula import TRUE, Formula, and_, atom, not_, rebuild
from tltlc.logic.text.printer import ascii_text, operand_text
from tltlc.resolve import registers
from tltlc.resolve.context import Context
from tltlc.resolve.registers import RegisterDraft
from tltlc.resolve.spec import Timer
from tltlc.resolve.values import number_text

_MOST_PARTS: Final = 1_000
"""The most parts of the formulas that one timer is about; their texts are in its name."""
_MOST_DEPTH: Final = ARITHMETIC.depth // 2
"""The greatest depth of their robustness, since an update adds operators to it."""


def in_time(low: int, time: str, event_words: str) -> str:
    """Return "within 5 s after a" where the goal must come at a later sample (``low`` is 1), else "within 5 s of a"."""
    return f"within {time} {'after' if low else 'of'} {event_words}"


class Reached(NamedTuple):
    """The condition that a sample of a chain is reached in time, and the words for it: "within 5 s after a"."""

    formula: Formula
    words: str


class TimedGoal(NamedTuple):
    """A goal that came in time: ``event`` holds at its samples, and ``words`` says it.

    ``text`` is the goal alone. It must come at most ``length`` after the goal before it, at a later sample
    if ``low`` is 1.
    """

    event: Formula
    words: str
    text: str
    low: int = 0
    length: float = 0


class TimerAtoms:
    """Makes the timers of one clause. ``source`` and ``span`` are the place of the clause, for errors.

    A length of time is a number of steps on a fixed clock (:class:`Timers`), and a number of seconds on
    one that varies (:class:`tltlc.resolve.elapsed.ElapsedTimers`).
    """

    def __init__(self, context: Context, source: SourceFile, span: Span) -> None:
        self.context, self.source, self.span = context, source, span

    def at_least(self, register: str, length: float) -> Expression:
        """Return the robustness of "the register, which counts time, is at least ``length``"."""
        raise NotImplementedError

    def at_most(self, register: str, length: float) -> Expression:
        """Return the robustness of "the register, which counts time, is at most ``length``"."""
        raise NotImplementedError

    def may_be_at_most(self, register: str, length: float) -> Expression:
        """Return the robustness of "at the next sample, the register may be at most ``length``"."""
        raise NotImplementedError

    def ends_before_next(self, length: float) -> Expression:
        """Return the robustness of "at the next sample, more than ``length`` has passed since the first one"."""
        raise NotImplementedError

    def recent(self, low: int, length: float, event: Formula, event_words: str) -> Formula:
        """Return the atom of "``event`` held at most ``length`` ago", at an earlier sample if ``low`` is 1.

        ``event_words`` is the event in words. ``low`` is 0 or 1.
        """
        value = self.at_most(self._age(low, event), length)
        return self._timer("recent" if low else "lately", value, self.time(length), event_words)

    def time(self, length: float) -> str:
        """Return a length of time as a text for people."""
        raise NotImplementedError

    def fits(self, *formulas: Formula) -> bool:
        """Whether timers about these formulas, which have no temporal operators, are not too large."""
        size = sum(self.context.tree_size(formula) for formula in formulas)
        return size <= _MOST_PARTS and all(depth(registers.robustness(formula)) <= _MOST_DEPTH for formula in formulas)

    def now(self, state: Formula) -> Formula:
        """Return ``state`` as one atom."""
        return state if state.op == "atom" else self._atom(f"({_text(state)})", SignalValue(self.kept(state)))

    def text(self, formula: Formula) -> str:
        """Return the text of a formula in the names of timers."""
        return _text(formula)

    def operand_text(self, formula: Formula) -> str:
        """Return the text of a formula in the names of timers, in brackets if it needs them as an operand."""
        return _operand_text(formula)

    def earlier(self, low: int, event: Formula) -> Formula:
        """Return the atom of "``event`` has held", at this sample or before; if ``low`` is 1, before this sample."""
        once = f"once {operand_text(event)}"
        self._register(registers.once(once, self._value(event)))
        has_held = self._timer(once, SignalValue(once))
        return self.previous(has_held) if low else has_held

    def previous(self, state: Formula) -> Formula:
        """Return the atom of "``state`` held at the sample before this one"."""
        name = f"previously {self.operand_text(state)}"
        self._register(registers.previously(name, self.kept(state)))
        return self._timer(name, SignalValue(name))

    def chain(self, goals: Sequence[TimedGoal]) -> Formula:
        """Return the atom of "this sample is the last of the goals, and all came in time".

        Where it does not hold, its robustness is the share of the chain that is done, less 1: k of n goals
        have come and may still be followed in time, and the next one is near.
        """
        done: list[Expression] = [self._nearness(goals[0])]
        for number, (goal, following) in enumerate(pairwise(goals), start=1):
            waits = registers.holds(self.at_most(self._age(following.low, goal.event), following.length))
            near = When(((waits, self._nearness(following)),), Const(0.0))
            goals_done = Op("+", (Const(float(number)), near))
            done.append(When(((self._continues(goal, following), goals_done),), Const(0.0)))
        share = Op("/", (Op("max", tuple(done)), Const(float(len(goals)))))
        last = SignalValue(self.kept(goals[-1].event))
        value = When(((registers.holds(last), last),), Op("-", (share, Const(1.0))))
        return self._timer("chain", value, *_chain_arguments(goals, self), later=_later(goals))

    def lost(self, goals: Sequence[TimedGoal], length: float) -> Formula:
        """Return the atom of "``length`` is over, and no goal may still be followed in time"."""
        alive = tuple(self._continues(goal, following) for goal, following in pairwise(goals))
        value = When(((Condition("or", alive), Const(-1.0)),), self.ends_before_next(length))
        return self._timer("lost", value, *_chain_arguments(goals, self), later=_later(goals))

    def _nearness(self, goal: TimedGoal) -> Expression:
        """Return how near a goal that may come at this sample is: from 0 to 1."""
        value = SignalValue(self.kept(goal.event))
        return Op("+", (Const(1.0), Op("min", (Const(0.0), value))))

    def _continues(self, goal: TimedGoal, following: TimedGoal) -> Condition:
        """Return the condition that the next sample may be the goal that follows."""
        in_time = registers.holds(self.may_be_at_most(self._age(following.low, goal.event), following.length))
        return Condition("or", (registers.holds(SignalValue(self.kept(goal.event))), in_time))

    def in_place_of(self, old: Formula, new: Formula) -> Formula:
        """Return the bounded operator ``new``, which gets the place in the text of the one that it replaces."""
        self.context.bound_of[new] = self.context.bound_of[old]
        return new

    def _age(self, low: int, event: Formula) -> str:
        """Return the register with the age of the latest event: at this sample, or before it if ``low`` is 1."""
        if low == 0:
            return self.time_since(event)
        name = f"age({_text(event)})"
        self._register(registers.age(name, self.kept(event), *self._step()))
        return name

    def time_since(self, event: Formula) -> str:
        """Return the name of the register with the time since ``event`` last held."""
        name = f"time_since({ascii_text(event)})"
        self._register(registers.time_since(name, registers.truth(event), *self._step()))
        return name

    def _step(self) -> tuple[Expression, str]:
        """Return the length of a step, and the unit of registers that count time."""
        varies = self.context.clock_varies
        return registers.step_length(varies), "s" if varies else "steps"

    def _register(self, draft: RegisterDraft) -> None:
        self.context.register(draft, self.source, self.span)

    def kept(self, state: Formula) -> str:
        """Return the name of the register that keeps the robustness of ``state`` for the next sample."""
        name = f"last {operand_text(state)}"
        self._register(registers.last(name, self._value(state), -1.0, 1.0, -1.0))
        return name

    def _value(self, state: Formula) -> Expression:
        return registers.robustness(state)

    def _atom(self, name: str, value: Expression) -> Formula:
        return self.context.atom(name, value, "", self.source, self.span)

    def _timer(self, base: str, value: Expression, *arguments: str, later: Sequence[bool] = ()) -> Formula:
        return self.context.atom(base, value, "", self.source, self.span, arguments, Timer(tuple(later)))


class Timers(TimerAtoms):
    """Makes the timers of one clause on a fixed clock. All lengths and bounds are numbers of steps."""

    def passed(self, steps: int, event: Formula | None = None, event_words: str | None = None) -> Formula:
        """Return the atom of "``event`` last held ``steps`` or more steps ago", or never.

        Without an event, the steps count from the first sample. ``steps`` is at least 1. ``event_words`` is the
        event in words, by default its text.
        """
        if event is None:
            return self._timer("passed", self.at_least(self._samples(), steps + 1), self.time(steps))
        value = self.at_least(self.time_since(event), steps)
        return self._timer("passed", value, self.time(steps), event_words or _text(event))

    def lasted(self, steps: int) -> Formula:
        """Return the atom of "this is sample ``steps``, counted from 0, or a later one".

        It is named by the time that all samples up to this one take.
        """
        return self._timer("lasted", self.at_least(self._samples(), steps + 1), self.time(steps + 1))

    def between(self, low: int, high: int) -> Formula:
        """Return the formula of "from ``low`` to ``high`` steps after the first sample"."""
        over = self._timer("over", self.at_least(self._samples(), high + 2), self.time(high))
        return and_(self.passed(low), not_(over)) if low else not_(over)

    def held(self, steps: int, state: Formula) -> Formula:
        """Return the atom of "``state`` has held without a break for ``steps`` steps or more"."""
        register = f"time_holding({ascii_text(state)})"
        kept, truth = self.kept(state), registers.truth(state)
        self._register(registers.time_holding(register, truth, kept, registers.step_length(False), "steps"))
        return self._timer("held", self.at_least(register, steps), self.time(steps + 1), _text(state))

    def response(self, request: Formula, goal: Formula, low: int, high: int) -> tuple[Formula, Formula]:
        """Return the atoms of "a request waits for its goal" and "it has waited for too long".

        A request is a sample with ``request``. Its goal must come from ``low`` to ``high`` steps later;
        ``low`` is 0 or 1.
        """
        strict = low == 1
        answer = f"next {_operand_text(goal)}" if strict else _text(goal)
        pair = (answer,) if request is TRUE else (_text(request), answer)
        due, waiting = full_name("due", pair), full_name("waiting", pair)
        self._register(registers.due(due, self._value(request), self._value(goal), strict))
        step = registers.step_length(False)
        self._register(registers.waiting(waiting, registers.truth(request), registers.truth(goal), strict, step))
        time = f"{'the next ' if strict else ''}{self.time(high)}"
        late = self._timer("late", self.at_least(waiting, high + 1), time, *pair[:-1], _text(goal))
        return self._timer("due", SignalValue(due), *pair), late

    def breach(self, low: int, high: int, event: Formula, rule: Formula) -> Formula:
        """Return the atom of "``event`` held from ``low`` to ``high`` steps ago, and ``rule`` does not hold".

        One atom, since each further one in a clause multiplies the prime implicants of guards.
        """
        # Like `for` in the language, a rule that begins at the event has a time that counts all of its samples.
        time = f"the next {self.time(high)}" if low else self.time(high + 1)
        value = Op("min", (self.at_most(self._age(low, event), high), self._value(not_(rule))))
        return self._breach(value, time, _text(event), _text(rule))

    def breach_from_start(self, low: int, high: int, rule: Formula) -> Formula:
        """Return the atom of "it is sample ``low`` to ``high``, counted from 0, and ``rule`` does not hold"."""
        samples = self._samples()
        inside = self.at_most(samples, high + 1)
        if low:
            inside = Op("min", (inside, self.at_least(samples, low + 1)))
        time = self.time(high + 1) if low == 0 else f"{self.time(low)} to {self.time(high)}"
        return self._breach(Op("min", (inside, self._value(not_(rule)))), time, _text(rule))

    def broken(self, rule: Formula) -> Formula:
        """Return the atom of "``rule`` does not hold"."""
        return self._breach(self._value(not_(rule)), _text(rule))

    def _breach(self, value: Expression, *arguments: str) -> Formula:
        name = full_name("breach", arguments)
        self._register(registers.breach(name, value))
        return self._timer("breach", SignalValue(name), *arguments)

    def _samples(self) -> str:
        self._register(registers.samples())
        return registers.SAMPLES

    def at_least(self, register: str, length: float) -> Expression:
        """Return the robustness of "the register is at least ``length``", a number of at least 1."""
        border = length - 0.5
        margin = Op("-", (registers.saturated(register, 2 * border), Const(border)))
        return Op("/", (margin, Const(border)))

    def at_most(self, register: str, length: float) -> Expression:
        """Return the robustness of "the register is at most ``length``"."""
        border = length + 0.5
        return Op("/", (Op("-", (Const(border), registers.saturated(register, 2 * border))), Const(border)))

    def may_be_at_most(self, register: str, length: float) -> Expression:
        """Return the robustness of "at the next sample, the register may be at most ``length``"."""
        return self.at_most(register, length - 1)

    def ends_before_next(self, length: float) -> Expression:
        """Return the robustness of "this is sample ``length``, counted from 0, or a later one"."""
        return self.at_least(self._samples(), length + 1)

    def time(self, length: float) -> str:
        """Return a number of steps as a text for people: in seconds if there is a clock."""
        steps, period = int(length), self.context.clock_s
        if period is None:
            return f"{steps} step{'s' * (steps != 1)}"
        seconds = round(steps * period, 6)
        # On a fast clock, a rounded time would not tell the steps apart.
        return f"{number_text(seconds)} s" if abs(seconds / period - steps) < 1e-3 else f"{steps} steps"


def _chain_arguments(goals: Sequence[TimedGoal], timers: TimerAtoms) -> tuple[str, ...]:
    """Return the goals of a chain and the times between them: ``a``, ``5 s``, ``b``.

    A time is ``up to 5 s`` where the two goals may come at one sample.
    """
    first, *others = goals
    times = (f"{'' if goal.low else 'up to '}{timers.time(goal.length)}" for goal in others)
    return (first.text, *(text for time, goal in zip(times, others, strict=True) for text in (time, goal.text)))


def _later(goals: Sequence[TimedGoal]) -> list[bool]:
    return [goal.low == 1 for goal in goals[1:]]


def _text(formula: Formula) -> str:
    return ascii_text(_with_edges(formula))


def _operand_text(formula: Formula) -> str:
    return operand_text(_with_edges(formula))


def _with_edges(formula: Formula) -> Formula:
    """Return a formula for names, with ``begins p`` in place of ``p & !previously p``, and ``ends p`` likewise."""
    done: dict[Formula, Formula] = {}
    for node in formula.bottom_up():
        done[node] = _edge(node) or rebuild(node, tuple(done[operand] for operand in node.args))
    return done[formula]


def _edge(node: Formula) -> Formula | None:
    if node.op != "and" or len(node.args) != 2:
        return None
    now, before = node.args
    if before.op == "not" and before.args[0] is atom(f"previously {operand_text(now)}"):
        return atom(f"begins {operand_text(now)}")
    if now.op == "not" and before is atom(f"previously {operand_text(now.args[0])}"):
        return atom(f"ends {operand_text(now.args[0])}")
    return None
