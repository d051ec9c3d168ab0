"""Keep the step at which a trace fails, and say what it has to do with the spec."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any

from tltlc.automaton.memory import schedule
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.value_phrases import VALUES, value_words
from tltlc.core.record import record
from tltlc.expression.tree import AtomValue, SignalValue, nodes
from tltlc.monitor.failure_words import atom_words, shortened, unmet_words
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import RunStep
from tltlc.monitor.traces import TraceSample
from tltlc.program.flags import Flags
from tltlc.tools.judge.asked_since import asked_since
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.kept_samples import KeptSamples
from tltlc.tools.judge.measures import measure, short_number
from tltlc.tools.judge.step_times import StepTimes, seconds_text
from tltlc.tools.judge.step_values import StepValue, enum_of, register_value, signal_value


@record
class ClausePlace:
    """Where a clause begins: the name of its file, and the number of the line, from 1."""

    file: str
    line: int


class FailingStep:
    """Notes the step at which a trace fails: what was measured there.

    ``places`` are the places of the clauses of the spec, none if they are not known; then ``clauses`` is not called.
    ``clauses`` returns automata for the single clauses.
    """

    def __init__(self, monitor: Monitor, places: Sequence[ClausePlace], clauses: Callable[[], Clauses]) -> None:
        self._monitor, self._places, self._clauses = monitor, places, clauses
        self._times = StepTimes(monitor.fspa)
        self._kept = KeptSamples(monitor.fspa.signals, clock_varies=monitor.fspa.clock_varies)
        self._sample: TraceSample = {}
        self._number = 0
        self._values: tuple[float, ...] = ()
        self._known: dict[str, float] = {}

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep what the judgement needs of them."""
        timed = self._times.watched(samples)
        for sample in self._kept.watched(timed) if self._places else timed:
            self._sample = sample
            yield sample

    def noted(self, rows: Iterable[RunStep]) -> Iterator[RunStep]:
        """Yield the steps unchanged, and keep what was measured at the one that fails."""
        for row in rows:
            if row.step.failed_step == row.number:
                names = (register.name for register in self._monitor.fspa.registers)
                self._number, self._values = row.number, row.values
                self._known = {**self._sample, **dict(zip(names, self._monitor.registers, strict=True))}
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
        values = dict.fromkeys(value for atom, _ in failed.cause.prime for value in self._values_of(atom))
        if values:
            yield f"at step {failed.step}: {', '.join(value.text for value in values)}"
        since = self._asked_since()
        if since is not None:
            yield f"the clause asked for this from step {since}{seconds_text(self.seconds(since))} on"
        yield f"what remained before: {shortened(unmet_words(fspa, failed))}"

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
            "atoms": {fspa.atoms[atom].name: self._values[atom] for atom, _ in prime},
            "unmet": unmet_words(fspa, failed),
            "asked_since": self._asked_since(),
        }

    def _asked_since(self) -> int | None:
        failed = self._monitor.failure
        if failed is None or not self._places:
            return None
        return asked_since(self._clauses(), self._monitor.fspa.clauses, self.samples(), failed)

    def _values_of(self, atom: int) -> tuple[StepValue, ...]:
        """Return the value of an atom, or for a comparison the values that it compares."""
        fspa, value = self._monitor.fspa, self._values[atom]
        if fspa.atoms[atom].timer is not None:
            return (StepValue(atom_words(fspa, atom)),)
        measured = measure(fspa, atom, self._known)
        if measured is not None and measured.number is not None:
            return (StepValue(measured.quantity, measured.number),)
        speaker, name = Speaker(fspa), fspa.atoms[atom].name
        if speaker.is_about_past(name):
            fact = speaker.fact(name, holds=value > 0.0, is_first=self._number == 1)
            return (StepValue(atom_words(fspa, atom), _truth(value)) if fact is None else StepValue(fact),)
        if AtomValue(name) in Flags(fspa, schedule(fspa)):
            return (StepValue(atom_words(fspa, atom), _truth(value)),)
        registers = {register.name: register for register in fspa.registers}
        read = fspa.atoms[atom].expression
        words = {
            name: value_words(register, speaker.event_text(register))
            if register.kind in VALUES
            else speaker.quantity_text(name)
            for name, register in registers.items()
        }
        values = {signal.name: signal_value(signal, self._known[signal.name]) for signal in fspa.signals}
        values |= {
            name: register_value(register, self._known[name], fspa.clock_s) for name, register in registers.items()
        }
        found = {node.name for node in nodes(read) if isinstance(node, SignalValue)}
        names = sorted(found, key=lambda name: (name in registers, name))
        reads = tuple(StepValue(words.get(name, name), values[name]) for name in names)
        if measured is not None or enum_of(fspa, atom) is not None:
            return reads
        return (StepValue(atom_words(fspa, atom), short_number(value), reads),)


def _truth(value: float) -> str:
    return "true" if value > 0.0 else "false"
