"""Keep the step at which a trace fails, or else its last, and say what it has to do with the spec."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from typing import Any

from tltlc.core.record import record
from tltlc.monitor.failure_words import shortened, unmet_words
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import RunStep
from tltlc.monitor.traces import TraceSample
from tltlc.tools.judge.asked_since import asked_since
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.kept_samples import KeptSamples
from tltlc.tools.judge.measured_step import MeasuredStep
from tltlc.tools.judge.open_clauses import open_clauses
from tltlc.tools.judge.step_times import StepTimes, seconds_text


@record
class ClausePlace:
    """Where a clause begins: the name of its file, and the number of the line, from 1."""

    file: str
    line: int


class FailingStep:
    """Notes what was measured at the step at which a trace fails, or else at its last.

    ``places`` are the places of the clauses of the spec, none if they are not known; then ``clauses`` is not called.
    ``clauses`` returns automata for the single clauses.
    """

    def __init__(self, monitor: Monitor, places: Sequence[ClausePlace], clauses: Callable[[], Clauses]) -> None:
        self._monitor, self._places, self._clauses = monitor, places, clauses
        self._times = StepTimes(monitor.fspa)
        self._kept = KeptSamples(monitor.fspa.signals, clock_varies=monitor.fspa.clock_varies)
        self._sample: TraceSample = {}
        self._step = MeasuredStep()

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep what the judgement needs of them."""
        timed = self._times.watched(samples)
        for sample in self._kept.watched(timed) if self._places else timed:
            self._sample = sample
            yield sample

    def noted(self, rows: Iterable[RunStep]) -> Iterator[RunStep]:
        """Yield the steps unchanged, and keep what was measured at the one that fails, or else at the last."""
        for row in rows:
            if row.step.failed_step in (None, row.number):
                self._step = self._measured(row)
            yield row

    def samples(self) -> list[TraceSample]:
        """Return the samples that the monitor has taken, in order; none if the places of the clauses are not known."""
        return self._kept.all() if self._places else []

    def seconds(self, step: int) -> float | None:
        """Return the time of a step that was read; ``step`` counts from 1. None if the spec has no clock."""
        return self._times.seconds(step)

    def details(self) -> Iterator[str]:
        """Yield lines: the clause, the values of the atoms and signals, since when it asked, and what remained."""
        fspa, failed = self._monitor.fspa, self._monitor.failure
        if failed is None or failed.cause is None:
            return
        clause = failed.cause.clause
        if clause is not None:
            place = self._places[clause] if self._places else None
            named = f"clause {clause + 1}" if place is None else f"{place.file}:{place.line}"
            yield f"{named}: {fspa.clauses[clause]}"
        values = self._words(atom for atom, _ in failed.cause.prime)
        if values:
            yield f"at step {failed.step}: {values}"
        since = self._asked_since()
        if since is not None:
            yield f"the clause asked for this from step {since}{seconds_text(self.seconds(since))} on"
        yield f"what remained before: {shortened(unmet_words(fspa, failed))}"

    def open_details(self) -> Iterator[str]:
        """Yield two lines for each clause that the trace has not met: the clause, and what it looks at in the end.

        The trace must not fail. There are no lines if the places of the clauses are not known.
        """
        if not self._places or not self._step.number:
            return
        fspa = self._monitor.fspa
        for item in open_clauses(self._clauses(), fspa.clauses, self.samples()):
            place = self._places[item.clause]
            yield f"{place.file}:{place.line}: {fspa.clauses[item.clause]}"
            values = self._words(index for index in range(len(fspa.atoms)) if self._is_told(index, item.atoms))
            after = "needs a later step" if item.needs_step else ""
            if reason := "; ".join(filter(None, (after, values))):
                yield f"not met at step {self._step.number}, the last: {reason}"

    def values(self) -> dict[str, Any] | None:
        """Return the failure as JSON values; None if the trace does not fail.

        ``clause`` is the number of the clause, from 1. ``atoms`` has the values of the atoms that decide the
        failure, and ``unmet`` says in words what remained before it. ``asked_since`` is the step, from 1, at which the
        clause began to ask for what failed, as :func:`asked_since` returns it.
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
            "atoms": {fspa.atoms[atom].name: self._step.values[atom] for atom, _ in prime},
            "unmet": unmet_words(fspa, failed),
            "asked_since": self._asked_since(),
        }

    def _asked_since(self) -> int | None:
        failed = self._monitor.failure
        if failed is None or not self._places:
            return None
        return asked_since(self._clauses(), self._monitor.fspa.clauses, self.samples(), failed)

    def _measured(self, row: RunStep) -> MeasuredStep:
        names = (register.name for register in self._monitor.fspa.registers)
        known = {**self._sample, **dict(zip(names, self._monitor.registers, strict=True))}
        return MeasuredStep(row.number, row.values, known)

    def _is_told(self, atom: int, names: Container[str]) -> bool:
        """Whether an atom is among these, and says something at the last step: a timer does where it holds."""
        item = self._monitor.fspa.atoms[atom]
        return item.name in names and (item.timer is None or self._step.values[atom] > 0.0)

    def _words(self, atoms: Iterable[int]) -> str:
        """Return what these atoms look at, each value once: ``has_key is false, health is 20``."""
        values = dict.fromkeys(value for atom in atoms for value in self._step.words(self._monitor.fspa, atom))
        return ", ".join(value.text for value in values)
