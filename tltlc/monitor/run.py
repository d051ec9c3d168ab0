"""Run a monitor over a whole trace, and return its steps as the rows of a table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import SupportsFloat

from tltlc.automaton.fspa import Fspa, Verdict
from tltlc.core.record import record
from tltlc.monitor.monitor import Monitor, Step


@record
class RunStep:
    """One step of a run: its number (from 1), the monitor's result, and the values of the atoms.

    The values are in the order of the automaton's atoms.
    """

    number: int
    step: Step
    values: tuple[float, ...]


@record
class TraceOutcome:
    """The judgement of a whole trace.

    ``accepted`` says whether the spec accepts the trace. ``verdict`` is the verdict of the last
    state, ``steps`` the number of samples, ``progress`` the best progress, in [0, 1], and
    ``total_reward`` the sum of the rewards of all steps.
    """

    accepted: bool
    verdict: Verdict
    steps: int
    progress: float
    total_reward: float


def run(monitor: Monitor, trace: Iterable[Mapping[str, SupportsFloat | str]]) -> Iterator[RunStep]:
    """Reset the monitor, then read the samples one by one and yield a step for each.

    Raises:
        TltlError: the errors of :meth:`Monitor.step`, and of reading the trace.
    """
    monitor.reset()
    for number, sample in enumerate(trace, start=1):
        step = monitor.step(sample)
        yield RunStep(number, step, monitor.values)


def header(fspa: Fspa) -> tuple[str, ...]:
    """Return the names of the columns for which :func:`cells` returns the texts."""
    return ("step", "state", "verdict", "progress", "reward", *(atom.name for atom in fspa.atoms))


def cells(row: RunStep) -> tuple[str, ...]:
    """Return the texts of a step, one for each column of :func:`header`.

    Numbers have up to 17 significant digits.
    """
    numbers = (row.step.progress, row.step.reward, *row.values)
    return (str(row.number), str(row.step.state), row.step.verdict, *(f"{number + 0.0:.17g}" for number in numbers))


def outcome(rows: Iterable[RunStep]) -> TraceOutcome:
    """Return the judgement of a trace, given all its steps.

    Raises:
        ValueError: there are no steps.
    """
    total = 0.0
    last: RunStep | None = None
    for last in rows:
        total += last.step.reward
    if last is None:
        raise ValueError("a trace has at least one sample")
    return TraceOutcome(last.step.accepting, last.step.verdict, last.number, last.step.progress, total)
