"""Judge one recorded trace: whether it is accepted, and if not, which clauses are to blame."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import deciding_atoms
from tltlc.automaton.text import label_text
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.errors import MonitorError
from tltlc.monitor.failure import cause_of
from tltlc.monitor.failure_words import atom_words
from tltlc.monitor.guards import holds
from tltlc.monitor.long_steps import LongSteps, shortest_time
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.nearest_edge import nearest_edge
from tltlc.monitor.parquet import as_text
from tltlc.monitor.sample_times import times_fit
from tltlc.monitor.samples import Samples, SampleValues
from tltlc.monitor.traces import TraceSample, in_trace, read_trace
from tltlc.tools.judge.clauses import Clauses
from tltlc.tools.judge.measures import Measure, measure
from tltlc.tools.judge.plain_csv import plain_columns
from tltlc.tools.judge.trace_run import TraceRun, TraceRunner
from tltlc.tools.judge.verdict import JudgedTrace, RejectionCause, TraceDetails, TraceVerdict

_MOST_JOINT: Final = 50
"""A :class:`Judge` caches at most this many automata that stand for several clauses at once."""


class Judge:
    """Judges traces by a spec, one after the other.

    ``fspa`` is the automaton of the spec. If a trace is not accepted, the
    :class:`~tltlc.tools.judge.verdict.RejectionCause` in the result names those of ``clauses`` that the
    trace breaks or does not meet. If ``clauses`` is None, no clauses are named. With
    ``episodes``, a trace is judged as an episode: the samples after the goal, after a
    violation, or after the step limit of the spec do not count. With ``sparse``, a bool that a trace does not
    have counts as false. With ``details``, each verdict also has
    :class:`~tltlc.tools.judge.verdict.TraceDetails`: how the trace moved through the automaton.
    """

    def __init__(
        self,
        fspa: Fspa,
        clauses: Clauses | None = None,
        *,
        episodes: bool = False,
        details: bool = False,
        sparse: bool = False,
    ) -> None:
        self._fspa, self._clauses, self._episodes, self._with_details = fspa, clauses, episodes, details
        self._sparse = sparse
        self._runner = TraceRunner(fspa, episodes=episodes)
        self._clause_runners = [TraceRunner(part.fspa) for part in clauses.parts] if clauses else []
        self._joint_runners: dict[tuple[int, ...], TraceRunner | None] = {}
        self._samples = Samples(fspa, None, [])
        self._shortest_time_s = shortest_time(fspa)

    def judge(self, name: str, data: bytes) -> JudgedTrace:
        """Judge one trace. ``data`` is the content of its file, and ``name`` its name in messages.

        No error is raised. If the trace cannot be read, or if the monitor rejects one of its
        samples, the result has no verdict, but the errors in ``diagnostics``. An error after the
        end of an episode does not count.
        """
        samples: list[TraceSample] = []
        steps = LongSteps(self._shortest_time_s)
        try:
            text = as_text(data, name, self._fspa.signals)
            plain = self._plain_samples(text)
            if plain is None:
                # This keeps the samples before an error.
                fspa = self._fspa
                read = read_trace(
                    io.BytesIO(text),
                    name,
                    fspa.signals,
                    fspa.clock_s,
                    clock_varies=fspa.clock_varies,
                    sparse=self._sparse,
                )
                samples.extend(steps.watched(read))
            samples = plain or samples
            run, warnings = self._runner.run(samples)
        except TltlError as error:
            return self._unjudged(name, samples, error)
        return self._judged(name, samples, run, (*warnings, *steps.warnings()))

    def verdict(self, samples: Sequence[TraceSample]) -> TraceVerdict:
        """Judge samples that are in memory, at least one.

        Raises:
            MonitorError: the errors of :meth:`~tltlc.monitor.monitor.Monitor.step`.
        """
        return self._verdict(samples, self._runner.run(samples)[0])

    def _judged(
        self, name: str, samples: Sequence[TraceSample], run: TraceRun, warnings: Sequence[Diagnostic]
    ) -> JudgedTrace:
        return JudgedTrace(name, self._verdict(samples, run), in_trace(name, warnings))

    def _verdict(self, samples: Sequence[TraceSample], run: TraceRun) -> TraceVerdict:
        cause = None if run.outcome.accepted else self._cause(samples, run)
        details = self._details(samples, run) if self._with_details else None
        unmet = label_text(self._fspa, run.state if run.broken_state is None else run.broken_state)
        return TraceVerdict(run.outcome, label_text(self._fspa, run.state), cause, len(samples), details, unmet)

    def _details(self, samples: Sequence[TraceSample], run: TraceRun) -> TraceDetails:
        unmet = run.state if run.broken_state is None else run.broken_state
        nearest = missed = None
        if not run.outcome.accepted:
            ends = [number for _, number in run.arrivals[1:]] + [run.outcome.steps]
            stays = [
                range(start, end) for (state, start), end in zip(run.arrivals, ends, strict=True) if state == unmet
            ]
            values = list(self._samples.of_trace(samples, stays[-1]))
            nearest = nearest_edge(self._fspa, unmet, [sample_values.atoms for sample_values in values])
            if nearest is not None:
                known = self._known(samples[stays[-1][nearest.row]], values[nearest.row])
                missed = measure(self._fspa, nearest.atom, known)
        return TraceDetails(run.arrivals, unmet, nearest, missed)

    def _unjudged(self, name: str, samples: Sequence[TraceSample], error: TltlError) -> JudgedTrace:
        """Return the result for a trace that has an error.

        ``samples`` are the samples that could be read. The result has no verdict, with one
        exception: if traces are judged as episodes, and the episode ends before the error, the
        error does not matter, and the trace is judged as usual.
        """
        diagnostics = in_trace(name, error.diagnostics) if isinstance(error, MonitorError) else error.diagnostics
        samples = self._faultless(samples)
        if not samples:
            return JudgedTrace(name, None, diagnostics)
        run, warnings = self._runner.run(samples, cut_off=True)
        if self._episodes and run.done:
            return self._judged(name, samples, run, warnings)
        return JudgedTrace(name, None, diagnostics, None if run.broken_at is None else self._cause(samples, run))

    def _faultless(self, samples: Sequence[TraceSample]) -> Sequence[TraceSample]:
        """Return the samples before the first one that the monitor rejects; all samples if it rejects none."""
        with suppress(MonitorError):
            if samples:
                self._runner.run(samples)
            return samples
        monitor = Monitor(self._fspa)
        for count, sample in enumerate(samples):
            try:
                monitor.step(sample)
            except MonitorError:
                return samples[:count]
        return samples

    def _plain_samples(self, data: bytes) -> list[TraceSample] | None:
        """Return the samples of a trace in plain CSV, which :func:`plain_columns` reads fast.

        Return None for any other trace, for times of samples that
        :class:`~tltlc.monitor.sample_times.SampleTimes` rejects, and if the clock varies.
        """
        if self._fspa.clock_varies:
            return None
        plain = plain_columns(data, self._fspa.signals)
        if plain is None:
            return None
        columns, times = plain
        if times is not None and not times_fit(times, self._fspa.clock_s):
            return None
        names = tuple(signal.name for signal in self._fspa.signals)
        return [dict(zip(names, values, strict=True)) for values in zip(*columns, strict=True)]

    def _cause(self, samples: Sequence[TraceSample], run: TraceRun) -> RejectionCause:
        """Return why a trace is not accepted."""
        samples = samples[: run.outcome.steps]
        if run.broken_at is None or run.broken_state is None:
            limit = self._fspa.limit_steps
            is_late = self._episodes and limit is not None and len(samples) >= limit
            return RejectionCause("late" if is_late else "unfinished", len(samples), self._texts(self._unmet(samples)))
        until = samples[: run.broken_at]
        (values,) = self._samples.of_trace(until, range(run.broken_at - 1, run.broken_at))
        breaking = self._breaking_atoms(values.atoms, run.broken_state)
        atoms = tuple(self._fspa.atoms[atom].name for atom in breaking)
        words = tuple(atom_words(self._fspa, atom) for atom in breaking) if self._fspa.registers else ()
        measured = self._measure(breaking, self._known(until[-1], values))
        broken = [
            index
            for index, runner in enumerate(self._clause_runners)
            if runner.can_break and runner.run(until)[0].broken_at is not None
        ]
        if not broken and (blocked := self._blocked(until)):
            return RejectionCause("blocked", run.broken_at, self._texts(blocked), atoms, measured, words)
        return RejectionCause("broken", run.broken_at, self._texts(broken), atoms, measured, words)

    def _unmet(self, samples: Sequence[TraceSample]) -> list[int]:
        """Return the indices of the clauses that would not accept the samples as a whole trace."""
        return [
            index for index, runner in enumerate(self._clause_runners) if not runner.run(samples)[0].outcome.accepted
        ]

    def _blocked(self, samples: Sequence[TraceSample]) -> list[int]:
        """Return the indices of the clauses that are not met yet, and never will be without breaking others.

        A clause is met if it accepts ``samples`` as a whole trace. A clause that is not met is in
        the result if no continuation of ``samples`` satisfies both this clause and all clauses that
        are met now. The result is empty if not all clauses of the spec are known.
        """
        if self._clauses is None or not self._clauses.are_all:
            return []
        unmet = self._unmet(samples)
        met = [index for index in range(len(self._clause_runners)) if index not in unmet]
        return [index for index in unmet if self._is_broken(tuple(sorted((*met, index))), samples)]

    def _is_broken(self, chosen: tuple[int, ...], samples: Sequence[TraceSample]) -> bool:
        """Whether no continuation of the samples can satisfy all of the chosen clauses.

        ``chosen`` has the indices of the clauses. False as well if their common automaton would be
        too large.
        """
        assert self._clauses is not None
        if chosen not in self._joint_runners:
            if len(self._joint_runners) == _MOST_JOINT:
                self._joint_runners.clear()
            automaton = self._clauses.together(chosen)
            self._joint_runners[chosen] = None if automaton is None else TraceRunner(automaton)
        runner = self._joint_runners[chosen]
        return runner is not None and runner.run(samples)[0].broken_at is not None

    def _texts(self, indices: Sequence[int]) -> tuple[str, ...]:
        return tuple(self._clauses.parts[index].text for index in indices) if self._clauses else ()

    def _known(self, sample: TraceSample, values: SampleValues) -> Mapping[str, float]:
        """Return the values that atoms read at a sample, by name: those of its signals and of the registers."""
        names = (register.name for register in self._fspa.registers)
        return {**sample, **dict(zip(names, values.registers, strict=True))}

    def _measure(self, atoms: Sequence[int], known: Mapping[str, float]) -> Measure | None:
        """Measure the first of the atoms that is a comparison, at a sample; None if none of them is."""
        measures = (measure(self._fspa, atom, known) for atom in atoms)
        return next((result for result in measures if result is not None), None)

    def _breaking_atoms(self, values: Sequence[float], state: int) -> tuple[int, ...]:
        """Return the indices of the atoms that break the spec at a sample, or the reasons for them.

        ``values`` are the values of all atoms at the sample, and ``state`` is the state before it.
        """
        (edge,) = (edge for edge in self._fspa.edges_from(state) if holds(edge.guard, values))
        return deciding_atoms(self._fspa, [atom for atom, _ in cause_of(edge, values).prime], values)
