"""Find the clauses that a trace has not met in the end, and what they look at there."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor.traces import TraceSample
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.trace_run import TraceRunner


@record
class OpenClause:
    """A clause that a trace has neither met nor broken: its index in the spec.

    ``atoms`` has the names of the atoms that decide what happens to the clause at the next step. ``needs_step`` says
    whether one more step like the last would meet the clause.
    """

    clause: int
    atoms: frozenset[str]
    needs_step: bool


def open_clauses(clauses: Clauses, texts: Sequence[str], samples: Sequence[TraceSample]) -> tuple[OpenClause, ...]:
    """Return the clauses that alone would not accept the samples, in the order of the spec.

    ``texts`` are the texts of all clauses of the spec, in order. A clause whose automaton alone would be too large is
    left out.
    """
    opened: dict[int, OpenClause] = {}
    for part in clauses.parts:
        if part.text in texts and (index := texts.index(part.text)) not in opened:
            runner = TraceRunner(part.fspa)
            ended = runner.run(samples)[0]
            if ended.outcome.verdict == "pending":
                needs_step = runner.run([*samples, samples[-1]])[0].outcome.accepted
                opened[index] = OpenClause(index, _atoms_after(part.fspa, ended.state), needs_step)
    return tuple(opened[index] for index in sorted(opened))


def _atoms_after(fspa: Fspa, state: int) -> frozenset[str]:
    """Return the names of the atoms in the guards of the edges that leave a state."""
    primes = (prime for edge in fspa.edges if edge.source == state for prime in edge.guard.primes)
    return frozenset(fspa.atoms[atom].name for prime in primes for atom, _ in prime)
