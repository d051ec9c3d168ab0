"""Say why a trace fails, and which clauses it breaks, too."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tltlc.interfaces.compiled_input import Input
from tltlc.monitor.failure_words import failure_words
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import RunStep
from tltlc.monitor.traces import TraceSample
from tltlc.tools.judge.failing_step import FailingStep
from tltlc.tools.judge.later_failures import LaterFailure, later_failures
from tltlc.tools.judge.step_times import seconds_text


class TraceFailure:
    """Notes why a trace fails while ``monitor`` takes its samples.

    ``spec`` is the input with the spec. Its clauses are judged alone if they are in the source: an artefact has only
    the formula of all clauses.
    """

    def __init__(self, monitor: Monitor, spec: Input) -> None:
        self._monitor, self._spec, self._places = monitor, spec, spec.clause_places()
        self._failing = FailingStep(monitor, self._places, spec.clauses)

    def watched(self, samples: Iterable[TraceSample]) -> Iterator[TraceSample]:
        """Yield the samples unchanged, and keep what the judgement needs of them."""
        return self._failing.watched(samples)

    def noted(self, rows: Iterable[RunStep]) -> Iterator[RunStep]:
        """Yield the steps unchanged, and keep what was measured at the one that fails."""
        return self._failing.noted(rows)

    def lines(self, judgement: str, steps: int | None = None) -> Iterator[str]:
        """Yield the lines that say why the trace fails; none if it does not.

        The last line begins with ``judgement``, such as "not accepted". ``steps`` is the number of steps of the trace;
        None if an error ended the reading.
        """
        fspa, failed = self._monitor.fspa, self._monitor.failure
        if failed is None:
            return
        yield from self._failing.details()
        for later in self._later():
            place = self._places[later.clause]
            at = f"{place.file}:{place.line}: {fspa.clauses[later.clause]}"
            yield f"also: clause {later.clause + 1} at step {later.step}{self._time_text(later.step)}: {at}"
        yield f"{judgement}: {failure_words(fspa, failed, steps, self._time_text(failed.step))}"

    def open_lines(self) -> Iterator[str]:
        """Yield the lines about the clauses that the trace has not met; call it only if the trace does not fail."""
        yield from self._failing.open_details()

    def values(self) -> dict[str, Any] | None:
        """Return the failure as JSON values; None if the trace does not fail.

        Beside the fields of :meth:`FailingStep.values`, ``seconds`` is the time of the step since the first one, None
        without a clock, and ``also`` has an object for each clause that is broken, too.
        """
        values, failed = self._failing.values(), self._monitor.failure
        if values is None or failed is None:
            return None
        also = [
            {
                "failed_step": later.step,
                "seconds": self._failing.seconds(later.step),
                "failed_clause": self._monitor.fspa.clauses[later.clause],
                "clause": later.clause + 1,
                "file": self._places[later.clause].file,
                "line": self._places[later.clause].line,
            }
            for later in self._later()
        ]
        return {**values, "seconds": self._failing.seconds(failed.step), "also": also}

    def _later(self) -> tuple[LaterFailure, ...]:
        failed = self._monitor.failure
        if len(self._places) < 2 or failed is None or failed.cause is None:
            return ()
        texts = self._monitor.fspa.clauses
        return later_failures(self._spec.clauses(), texts, self._failing.samples(), failed.cause.clause)

    def _time_text(self, step: int) -> str:
        return seconds_text(self._failing.seconds(step))
