"""Keep the step at which a trace fails, and say what it has to do with the spec."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from tltlc.automaton.memory import schedule
from tltlc.automaton.value_phrases import VALUES, value_words
from tltlc.core.record import record
from tltlc.expression.tree import AtomValue, SignalValue, nodes
from tltlc.monitor.failure_words import atom_words, unmet_words
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import RunStep
from tltlc.monitor.traces import TraceSample
from tltlc.program.flags import Flags
from tltlc.tools.judge.measures import measure, short_number


@record
class ClausePlace:
    """Where a clause begins: the name of its file, and the number of the line, from 1."""

    file: str
    line: int


class FailingStep:
    """Notes the step at which a trace fails: what was measured there.

    ``places`` are the places of the clauses of the spec, none if they are not known.
    """

    def __init__(self, monitor: Monitor, places: Sequence[ClausePlace]) -> None:
        self._monitor, self._places = monitor, places
        self._sample: TraceSample = {}
        self._values: tuple[float, ...] = ()
        self._known: dict[str, float] = {}

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep the last one."""
        for self._sample in samples:
            yield self._sample

    def noted(self, rows: Iterable[RunStep]) -> Iterator[RunStep]:
        """Yield the steps unchanged, and keep what was measured at the one that fails."""
        for row in rows:
            if row.step.failed_step == row.number:
                names = (register.name for register in self._monitor.fspa.registers)
                self._values = row.values
                self._known = {**self._sample, **dict(zip(names, self._monitor.registers, strict=True))}
            yield row

    def details(self) -> Iterator[str]:
        """Yield lines with the clause, the values of the atoms and signals, and what remained before the step."""
        fspa, failed = self._monitor.fspa, self._monitor.failure
        if failed is None or failed.cause is None:
            return
        clause = failed.cause.clause
        if clause is not None:
            place = self._places[clause] if self._places else None
            named = f"clause {clause + 1}" if place is None else f"{place.file}:{place.line}"
            yield f"{named}: {fspa.clauses[clause]}"
        values = ", ".join(self._value_words(atom) for atom, _ in failed.cause.prime)
        if values:
            yield f"at step {failed.step}: {values}"
        yield f"what remained before: {unmet_words(fspa, failed)}"

    def values(self) -> dict[str, Any] | None:
        """Return the failure as JSON values; None if the trace does not fail.

        ``clause`` is the number of the clause, from 1. ``atoms`` has the values of the atoms that decide the
        failure, and ``unmet`` says in words what remained before it.
        """
        fspa, failed = self._monitor.fspa, self._monitor.failure
        if failed is None:
            return None
        clause, prime = (failed.cause.clause, failed.cause.prime) if failed.cause else (None, ())
        place = self._places[clause] if clause is not None and self._places else None
        atom = failed.cause.atom if failed.cause else None
        return {
            "failed_step": failed.step,
            "failed_clause": None if clause is None else fspa.clauses[clause],
            "failed_atom": None if atom is None else fspa.atoms[atom].name,
            "clause": None if clause is None else clause + 1,
            "file": None if place is None else place.file,
            "line": None if place is None else place.line,
            "atoms": {fspa.atoms[atom].name: self._values[atom] for atom, _ in prime},
            "unmet": unmet_words(fspa, failed),
        }

    def _value_words(self, atom: int) -> str:
        """Return the value of an atom, or for a comparison the values that it compares."""
        fspa = self._monitor.fspa
        if fspa.atoms[atom].timer is not None:
            return atom_words(fspa, atom)
        measured = measure(fspa, atom, self._known)
        if measured is not None and measured.text is not None:
            return measured.text
        if AtomValue(fspa.atoms[atom].name) in Flags(fspa, schedule(fspa)):
            return f"{atom_words(fspa, atom)} is {'true' if self._values[atom] > 0.0 else 'false'}"
        read = [node.name for node in nodes(fspa.atoms[atom].expression) if isinstance(node, SignalValue)]
        words = {register.name: value_words(register) for register in fspa.registers if register.kind in VALUES}
        measures = [f"{words.get(name, name)} is {short_number(self._known[name])}" for name in dict.fromkeys(read)]
        if measured is not None:
            return ", ".join(measures)
        value = f"{atom_words(fspa, atom)} is {short_number(self._values[atom])}"
        return f"{value} ({', '.join(measures)})" if measures else value
