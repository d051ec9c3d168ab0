"""Timers in seconds, for a clock that varies: each sample brings its own time since the sample before."""

from __future__ import annotations

from tltlc.core.names import full_name
from tltlc.core.source import SourceFile, Span
from tltlc.expression.tree import Const, Expression, Op, SignalValue
from tltlc.logic.formula import TRUE, Formula, not_
from tltlc.resolve import registers
from tltlc.resolve.context import Context
from tltlc.resolve.timers import TimerAtoms, Timers
from tltlc.resolve.values import number_text


class ElapsedTimers(TimerAtoms):
    """Makes the timers of one clause on a clock that varies. All lengths and bounds are in seconds, above 0."""

    def at_least(self, register: str, length: float) -> Expression:
        """Return the robustness of "the register is at least ``length``"; it is above 0 also where they are equal."""
        return registers.negated(self._less_than(register, length))

    def at_most(self, register: str, length: float) -> Expression:
        """Return the robustness of "the register is at most ``length``"; it is above 0 also where they are equal."""
        return registers.negated(self._more_than(register, length))

    def may_be_at_most(self, register: str, length: float) -> Expression:
        """Return the robustness of "at the next sample, the register may be at most ``length``".

        The next step may take 0 s.
        """
        return self.at_most(register, length)

    def ends_before_next(self, length: float) -> Expression:
        """Return the robustness of "more than ``length`` has passed since the first sample"."""
        return self._more_than(self._elapsed(), length)

    def time(self, length: float) -> str:
        """Return a number of seconds as a text for people."""
        return f"{number_text(length)} s"

    def over(self, length: float) -> Formula:
        """Return the atom of "more than ``length`` has passed since the first sample"."""
        return self._timer("over", self._more_than(self._elapsed(), length), self.time(length))

    def lasted(self, length: float) -> Formula:
        """Return the atom of "``length`` or more has passed since the first sample"."""
        return self._timer("lasted", self.at_least(self._elapsed(), length), self.time(length))

    def held(self, length: float, state: Formula) -> Formula:
        """Return the atom of "``state`` held at the samples before this one, which begin ``length`` or more ago"."""
        register = f"run({self.text(state)})"
        self._register(registers.run(register, self.kept(state)))
        return self._timer("held", self.at_least(register, length), self.time(length), self.text(state))

    def response(self, request: Formula, goal: Formula, length: float) -> tuple[Formula, Formula]:
        """Return the atoms of "a request waits for its goal" and "it has waited for more than ``length``"."""
        pair = (self.text(goal),) if request is TRUE else (self.text(request), self.text(goal))
        time = self.time(length)
        due, waiting = full_name("due", pair), full_name("waiting", (time, *pair))
        self._register(registers.due(due, self._value(request), self._value(goal), strict=False))
        asks, comes = registers.truth(request), registers.truth(goal)
        self._register(registers.waiting_time(waiting, asks, comes, length))
        # While nothing waits, the register is -1, which is no time.
        value = Op("max", (self._more_than(waiting, length), Const(-1.0)))
        return self._timer("due", SignalValue(due), *pair), self._timer("late", value, time, *pair)

    def breach(self, length: float, event: Formula, rule: Formula) -> Formula:
        """Return the atom of "``event`` held less than ``length`` ago, and ``rule`` does not hold"."""
        arguments = (self.time(length), self.text(event), self.text(rule))
        return self._breach(self._less_than(self.time_since(event), length), rule, arguments)

    def breach_from_start(self, length: float, rule: Formula) -> Formula:
        """Return the atom of "less than ``length`` has passed since the first sample, and ``rule`` does not hold"."""
        return self._breach(self._less_than(self._elapsed(), length), rule, (self.time(length), self.text(rule)))

    def _breach(self, inside: Expression, rule: Formula, arguments: tuple[str, ...]) -> Formula:
        name = full_name("breach", arguments)
        self._register(registers.breach(name, Op("min", (inside, self._value(not_(rule))))))
        return self._timer("breach", SignalValue(name), *arguments)

    def _more_than(self, register: str, length: float) -> Expression:
        return Op("/", (Op("-", (registers.saturated(register, 2 * length), Const(length))), Const(length)))

    def _less_than(self, register: str, length: float) -> Expression:
        return Op("/", (Op("-", (Const(length), registers.saturated(register, 2 * length))), Const(length)))

    def _elapsed(self) -> str:
        self._register(registers.elapsed())
        return registers.ELAPSED


def timers_of(context: Context, source: SourceFile, span: Span) -> Timers | ElapsedTimers:
    """Return what makes the timers of a clause on the clock of the program."""
    make = ElapsedTimers if context.clock_varies else Timers
    return make(context, source, span)
