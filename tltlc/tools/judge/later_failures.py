"""Find the clauses that a trace breaks beside the one at which it fails, each judged alone."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.monitor.traces import TraceSample
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.trace_run import TraceRunner


@record
class LaterFailure:
    """A clause that a trace breaks, too: the index of the clause in the spec, and the step, from 1."""

    clause: int
    step: int


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
