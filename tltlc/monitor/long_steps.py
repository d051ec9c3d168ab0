"""Warn about a recording whose steps are longer than the times in its spec: they may be in milliseconds."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import Const, Expression, Op, ParamValue, SignalValue, nodes
from tltlc.monitor.samples import STEP_LENGTH, number_text
from tltlc.monitor.traces import TraceSample

CODE: Final = "TLT0625"

_LONG_S: Final = 1.0
"""Frames take less than this, and more than this many milliseconds."""

_MOST_SHORT: Final = 0.1
"""The share of the steps that may be as short as the shortest time of the spec."""


class LongSteps:
    """Counts the long steps of one recording.

    ``shortest_s`` is the shortest time of the spec in seconds (:func:`shortest_time`). With None, there is
    never a warning.
    """

    def __init__(self, shortest_s: float | None) -> None:
        self._shortest_s = shortest_s
        self._count = self._long = self._short = 0
        self._total_s = 0.0

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples of the recording unchanged, and count their steps.

        The length of the first sample counts for nothing, and steps without a length are left out.
        """
        for number, sample in enumerate(samples):
            if number and self._shortest_s is not None and (length := sample[STEP_LENGTH]) > 0.0:
                self._count += 1
                self._total_s += length
                self._long += length >= _LONG_S
                self._short += length <= self._shortest_s
            yield sample

    def warnings(self) -> tuple[Diagnostic, ...]:
        """Return a warning if the median of the steps is 1 s or more, and 9 in 10 exceed the shortest time."""
        if self._shortest_s is None or not self._count:
            return ()
        if 2 * self._long < self._count or self._short > _MOST_SHORT * self._count:
            return ()
        mean_s = float(f"{self._total_s / self._count:.3g}")
        title = (
            f"the trace has a step every {number_text(mean_s)} s on average, and the shortest time in the spec is "
            f"{number_text(self._shortest_s)} s"
        )
        help_ = "`dt` and `time` are in seconds: if these are milliseconds, divide them by 1000"
        return (Diagnostic(CODE, title, help=help_, severity="warning"),)


def shortest_time(fspa: Fspa) -> float | None:
    """Return the shortest time with which an automaton compares a register, in seconds.

    None without such a time, and on a clock that does not vary. Params have their default values.
    """
    if not fspa.clock_varies:
        return None
    in_seconds = {register.name for register in fspa.registers if register.unit == "s"}
    params = {param.name: param.value for param in fspa.params}
    expressions = (*(atom.expression for atom in fspa.atoms), *(register.update for register in fspa.registers))
    borders = (border for expression in expressions for border in _borders(expression, in_seconds))
    times: list[float] = []
    for border in borders:
        with suppress(ArithmeticError, ValueError):  # the monitor reports an atom without a value
            times.append(evaluate(border, {}, params))
    return min((time for time in times if time > 0.0), default=None)


def _borders(expression: Expression, registers: set[str]) -> Iterator[Expression]:
    """Yield each expression without signals from which one of the registers is subtracted, or the reverse."""
    for node in nodes(expression):
        if not isinstance(node, Op) or node.op != "-":
            continue
        for read, border in (node.args, node.args[::-1]):
            value = read.args[0] if isinstance(read, Op) and read.op == "min" else read
            is_time = isinstance(value, SignalValue) and value.name in registers
            if is_time and all(isinstance(part, (Const, ParamValue, Op)) for part in nodes(border)):
                yield border
