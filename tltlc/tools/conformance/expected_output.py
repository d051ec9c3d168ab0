"""The output that a monitor must give for a trace: a row for each sample, and an error if it must reject one."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from math import isfinite
from typing import Any, Final, Literal

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import schedule
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import AtomValue, Before, StepLength, VariableKey
from tltlc.monitor import Monitor, Step
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.trace_rows import TraceLines, TraceTable, read_rows
from tltlc.monitor.traces import TraceSample, read_trace
from tltlc.resolve.spec import Atom, Register

RejectionKind = Literal[
    "no sample",
    "missing signal",
    "missing time",
    "bad cell",
    "wrong dt",
    "not finite",
    "by zero",
    "no root",
    "too large",
    "together",
]

COLUMNS: Final = (
    *("step", "state", "verdict", "accepting", "done", "progress", "reward"),
    *("robustness", "limiting", "failed_clause", "failed_atom", "failed_step"),
)


@record
class Rejection:
    """Why and where a monitor must reject a trace.

    ``kind`` is the reason, and ``names`` are the signals, atoms or registers at fault. ``step`` is the number of
    the sample, from 1. ``line`` is the number, from 1, of the line that cannot be read. It is None if
    all lines can be read, but the monitor must reject a sample, or there is no sample.
    """

    kind: RejectionKind
    step: int
    names: tuple[str, ...] = ()
    line: int | None = None

    def document(self) -> dict[str, Any]:
        """Return the rejection as it appears in the index of the corpus."""
        return {"kind": self.kind, "step": self.step, "names": list(self.names), "line": self.line}


@record
class ExpectedOutput:
    """The expected rows without the header, the rejection or None, and the number of warnings."""

    rows: tuple[tuple[str, ...], ...]
    rejection: Rejection | None
    warnings: int

    def table(self) -> str:
        """Return the rows as CSV, with a header."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(self.rows)
        return text.getvalue()


def expected_output(fspa: Fspa, trace: bytes) -> ExpectedOutput:
    """Return what every monitor of the automaton must print for the CSV file ``trace``."""
    monitor, rows, sample = Monitor(fspa), list[tuple[str, ...]](), TraceSample()
    rejection = None
    try:
        for sample in read_trace(io.BytesIO(trace), "trace", fspa.signals, clock_varies=fspa.clock_varies):
            rows.append(_row_cells(len(rows) + 1, monitor.step(sample)))
    except TltlError as error:
        rejection = _rejection(monitor, error.diagnostics[0], trace, sample)
    return ExpectedOutput(tuple(rows), rejection, len(monitor.notices))


def _row_cells(number: int, step: Step) -> tuple[str, ...]:
    flags = [str(flag).lower() for flag in (step.accepting, step.done)]
    numbers = [f"{value:.17g}" for value in (step.progress, step.reward, step.robustness)]
    texts = (step.limiting, step.failed_clause, step.failed_atom, step.failed_step)
    names = ("" if text is None else str(text) for text in texts)
    return (str(number), str(step.state), step.verdict, *flags, *numbers, *names)


def _rejection(monitor: Monitor, error: Diagnostic, trace: bytes, sample: TraceSample) -> Rejection:
    """Convert the diagnostic of a trace that a monitor rejects to a :class:`Rejection`.

    ``sample`` is the last sample that was read. The names at fault are computed from the sample or
    the trace, not read from the text of the diagnostic.
    """
    fspa, step = monitor.fspa, monitor.steps + 1
    if error.code == "TLT0620":
        return Rejection("no sample", step)
    if error.code == "TLT0619":
        return Rejection("wrong dt", step)
    if error.code == "TLT0612":
        return Rejection("not finite", step, tuple(_infinite_signals(fspa, sample)[:1]))
    if error.code == "TLT0613":
        kind, name = _without_value(monitor, sample)
        return Rejection(kind, step, (name,))
    if error.code == "TLT0614":
        return Rejection("together", step, _conflicting_atoms(monitor, sample))
    label = error.labels[0]
    line, _ = label.source.position(label.span.start)
    if error.code == "TLT0621":
        missing = _missing_signals(fspa, trace)
        return Rejection("missing signal" if missing else "missing time", step, missing or ("time", "dt"), line)
    return Rejection("bad cell", step, line=line)


def _missing_signals(fspa: Fspa, trace: bytes) -> tuple[str, ...]:
    """Return the signals of the automaton for which the trace has no column."""
    table = read_rows(TraceLines(io.BytesIO(trace), "trace"))
    header = table.header if isinstance(table, TraceTable) else ()
    return tuple(signal.name for signal in fspa.signals if signal.name not in header)


def _infinite_signals(fspa: Fspa, sample: TraceSample) -> list[str]:
    """Return the signals whose values are infinite or NaN."""
    return [signal.name for signal in fspa.signals if not isfinite(sample[signal.name])]


def _without_value(monitor: Monitor, sample: TraceSample) -> tuple[RejectionKind, str]:
    """Return why a sample gives some atom or register no value, and the name of the one that monitors report."""
    fspa, values, params = monitor.fspa, _known(monitor, sample), _params(monitor.fspa)
    too_large: str | None = None
    for step in schedule(fspa):
        part = fspa.atoms[step.index] if step.kind == "atom" else fspa.registers[step.index]
        try:
            value = evaluate(part.expression if isinstance(part, Atom) else part.update, values, params)
        except ZeroDivisionError:
            return "by zero", part.name
        except OverflowError:
            return "too large", part.name
        except ValueError:
            return "no root", part.name
        too_large = too_large or (None if isfinite(value) else part.name)
        # With registers, a monitor checks each value at once. Without, it computes all values before it checks any, so
        # an exception in a later atom comes first.
        if too_large is not None and fspa.registers:
            break
        values[_key(part)] = min(max(value, -1.0), 1.0) if isinstance(part, Atom) else value
    assert too_large is not None, "some value does not exist"
    return "too large", too_large


def _conflicting_atoms(monitor: Monitor, sample: TraceSample) -> tuple[str, ...]:
    """Return the atoms that hold in the first exclusive group of which more than one atom holds."""
    fspa, values, params = monitor.fspa, _known(monitor, sample), _params(monitor.fspa)
    for step in schedule(fspa):
        part = fspa.atoms[step.index] if step.kind == "atom" else fspa.registers[step.index]
        values[_key(part)] = evaluate(part.expression if isinstance(part, Atom) else part.update, values, params)
    holds = [values[AtomValue(atom.name)] > 0.0 for atom in fspa.atoms]
    holding = [[atom for atom in group if holds[atom]] for group in fspa.exclusive]
    return tuple(fspa.atoms[atom].name for atom in next(group for group in holding if len(group) > 1))


def _known(monitor: Monitor, sample: TraceSample) -> dict[VariableKey, float]:
    """Return what is known at a sample that a monitor rejected: signals, registers before it, and its step length."""
    values: dict[VariableKey, float] = dict(_clamp(monitor.fspa, sample).items())
    for register, value in zip(monitor.fspa.registers, monitor.registers, strict=True):
        values[Before(register.name)] = value
    if monitor.fspa.clock_varies:
        values[StepLength()] = sample[STEP_LENGTH]
    return values


def _key(part: Atom | Register) -> VariableKey:
    return AtomValue(part.name) if isinstance(part, Atom) else part.name


def _params(fspa: Fspa) -> dict[str, float]:
    return {param.name: param.value for param in fspa.params}


def _clamp(fspa: Fspa, sample: Mapping[str, float]) -> dict[str, float]:
    """Return the values of the signals, clamped to their ranges."""
    values = {}
    for signal in fspa.signals:
        value = sample[signal.name]
        value = value if signal.low is None or value >= signal.low else signal.low
        values[signal.name] = value if signal.high is None or value <= signal.high else signal.high
    return values
