"""Find the step at which a broken clause began to ask for what failed: where its time limit counts from."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Final

from tltlc.automaton.fspa import Edge, Fspa
from tltlc.monitor.failure import Failure
from tltlc.monitor.guards import holds
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import run
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.traces import TraceSample
from tltlc.resolve.sources import names_read
from tltlc.tools.judge.clauses import Clauses

_COUNTING: Final = ("waiting", "time_since")
"""The kinds of registers from which timers read the time since an event."""


def asked_since(clauses: Clauses, texts: Sequence[str], samples: Sequence[TraceSample], failure: Failure) -> int | None:
    """Return the step, from 1, at which the clause that a trace breaks began to ask for what failed.

    In ``keep begins alarm implies eventually within 2 s safe`` it is the step at which the alarm begins. ``texts`` are
    the texts of all clauses of the spec, and ``samples`` those of the trace, at least up to the failure. Of several
    steps that ask for the same, it is the last. Return None if the clause is not known or its automaton alone would be
    too large, if it asks from the first step on, or if it looks at the failing step alone.
    """
    if failure.cause is None or failure.cause.clause is None:
        return None
    text = texts[failure.cause.clause]
    part = next((part for part in clauses.parts if part.text == text), None)
    if part is None:
        return None
    step = _last_start(part.fspa, samples, failure.step)
    if step == failure.step:
        step = _timer_start(part.fspa, samples, failure.step)
    return step if step is not None and 1 < step < failure.step else None


def _last_start(fspa: Fspa, samples: Sequence[TraceSample], last: int) -> int | None:
    """Return the last step from which the automaton, begun anew there, is violated first at the step ``last``.

    The registers remember the whole trace. None if the automaton is not violated at ``last``.
    """
    leaving: list[list[Edge]] = [[] for _ in fspa.states]
    for edge in fspa.edges:
        leaving[edge.source].append(edge)
    starts: dict[int, int] = {}
    for row in run(Monitor(fspa), samples[:last]):
        # The states of all automata begun so far; of those in one state, the last begun stands for all.
        starts[0] = row.number
        after: dict[int, int] = {}
        for state, start in starts.items():
            target = next(edge.target for edge in leaving[state] if holds(edge.guard, row.values))
            after[target] = max(start, after.get(target, 0))
        starts = {state: start for state, start in after.items() if fspa.states[state].verdict != "violated"}
        if row.number == last:
            return max((start for state, start in after.items() if state not in starts), default=None)
    return None


def _timer_start(fspa: Fspa, samples: Sequence[TraceSample], last: int) -> int | None:
    """Return the step from which the timers of the automaton count; None if they do not count from a single event."""
    read = _read_by_timers(fspa)
    counting = [index for index, register in enumerate(fspa.registers) if register.name in read]
    counting = [index for index in counting if fspa.registers[index].kind in _COUNTING]
    if len(counting) != 1:
        return None
    monitor = Monitor(fspa)
    for _ in run(monitor, samples[:last]):
        pass
    register, passed = fspa.registers[counting[0]], monitor.registers[counting[0]]
    if register.unit == "steps":
        # What waits has waited for one step at the step of its event.
        return last - round(passed) + (register.kind == "waiting")
    times = list(accumulate((sample[STEP_LENGTH] for sample in samples[1:last]), initial=0.0))
    return min(range(1, last + 1), key=lambda step: abs(times[-1] - times[step - 1] - passed))


def _read_by_timers(fspa: Fspa) -> set[str]:
    """Return the names of the signals and registers that timers read, and those that these registers read."""
    read = {name for atom in fspa.atoms if atom.timer is not None for name in names_read(atom.expression)}
    # A register reads only those before it.
    for register in reversed(fspa.registers):
        if register.name in read:
            read.update(names_read(register.update))
    return read
