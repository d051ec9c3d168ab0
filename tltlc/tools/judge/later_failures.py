"""Find the clauses that a trace breaks beside the one at which it fails, each judged alone."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator

from tltlc.core.record import record
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.monitor.traces import TraceSample
from tltlc.resolve.spec import Signal
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.trace_run import TraceRunner


@record
class LaterFailure:
    """A clause that a trace breaks, too: the index of the clause in the spec, and the step, from 1."""

    clause: int
    step: int


class KeptSamples:
    """Keeps the samples of a trace in 8 bytes for each signal."""

    def __init__(self, signals: Iterable[Signal], *, clock_varies: bool) -> None:
        self._names = (*(signal.name for signal in signals), *((STEP_LENGTH,) if clock_varies else ()))
        self._columns = tuple(array("d") for _ in self._names)
        self._count = 0

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep them."""
        for sample in samples:
            yield sample
            # The monitor has taken the sample: it is not faulty.
            self._count += 1
            for name, column in zip(self._names, self._columns, strict=True):
                column.append(sample[name])

    def all(self) -> list[TraceSample]:
        """Return the samples that the monitor has taken, in order."""
        if not self._names:
            return [{} for _ in range(self._count)]
        return [dict(zip(self._names, values, strict=True)) for values in zip(*self._columns, strict=True)]


def later_failures(
    clauses: Clauses, texts: tuple[str, ...], samples: list[TraceSample], named: int | None
) -> tuple[LaterFailure, ...]:
    """Return the clauses that the samples break, in the order of the steps, without the clause ``named``.

    ``texts`` are the texts of all clauses of the spec, in order. A clause is broken at the first step after which no
    continuation meets it, whatever the other clauses ask for. A clause whose automaton alone would be too large is
    not judged.
    """
    failures: dict[int, int] = {}
    for part in clauses.parts:
        if part.text in texts and (index := texts.index(part.text)) != named and index not in failures:
            runner = TraceRunner(part.fspa)
            step = runner.run(samples)[0].broken_at if runner.can_break else None
            if step is not None:
                failures[index] = step
    return tuple(LaterFailure(clause, step) for clause, step in sorted(failures.items(), key=lambda item: item[::-1]))
