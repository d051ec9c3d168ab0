"""Find what a trace fails at: the clause that it breaks, and the atom that decides it."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Edge, Fspa, Implicant
from tltlc.core.record import record


@record
class Cause:
    """A reason why an edge leads into a trap: it applies if ``prime`` is true.

    ``clause`` is the index in ``Fspa.clauses`` of the clause that is broken then; None if only several
    clauses together cannot be met any more, or if the clauses are not known.
    """

    clause: int | None
    prime: Implicant

    @property
    def atom(self) -> int | None:
        """The atom that a person would name: the first that is false, or else the first that is true.

        It is the atom that had to hold but did not, such as ``has_key`` where a player opens the door
        without it. None if ``prime`` has no literals.
        """
        false = [atom for atom, polarity in self.prime if not polarity]
        return next(iter((*false, *(atom for atom, _ in self.prime))), None)


@record
class Failure:
    """The first step after which no continuation of a trace can meet the spec.

    ``step`` is its number, from 1, and ``state`` the state before it. ``cause`` is None if no trace at all
    can meet the spec.
    """

    step: int
    state: int
    cause: Cause | None


def breaks(fspa: Fspa, edge: Edge) -> bool:
    """Whether an edge leads into a trap from another state, so that the trace fails at this step."""
    return fspa.states[edge.target].verdict == "violated" and fspa.states[edge.source].verdict != "violated"


def causes(edge: Edge) -> tuple[Cause, ...]:
    """Return the causes of an edge into a trap; of several that apply, the first counts.

    First come the clauses in the order of the spec, then what only several clauses together rule out.
    """
    single = [Cause(broken.clause, prime) for broken in edge.broken for prime in broken.primes]
    joint = [
        Cause(None, prime) for prime in edge.guard.primes if not any(set(cause.prime) <= set(prime) for cause in single)
    ]
    return (*single, *joint)


def cause_of(edge: Edge, values: Sequence[float]) -> Cause:
    """Return the cause of an edge into a trap that applies at a step with these values of all atoms."""
    return next(
        cause for cause in causes(edge) if all((values[atom] > 0.0) == polarity for atom, polarity in cause.prime)
    )
