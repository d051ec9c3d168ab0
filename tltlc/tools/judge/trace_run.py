"""Run an automaton over the samples of a trace, fast with generated Python code, else step by step."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from contextlib import suppress
from itertools import accumulate
from operator import attrgetter
from typing import Any, Final

from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import TraceOutcome
from tltlc.monitor.traces import TraceSample

_SAMPLES_PER_STATE: Final = 20
"""The generated monitor is loaded after this many samples for each state of the automaton.

Loading takes time, and is worth it only for long or many traces.
"""


@record
class TraceRun:
    """The result of a run of an automaton over a trace.

    ``state`` is the state in which the run ends, and ``done`` says whether the episode has ended.
    ``arrivals`` has a pair for each change of state: the new state, and how many samples it took to
    get there. For example, ``((0, 0), (2, 5))`` means that the run starts in state 0, and that
    sample 5 leads to state 2.
    ``broken_at`` is the number, from 1, of the first sample after which the verdict is ``violated``,
    and ``broken_state`` is the state before that sample. Both are None if the verdict is never
    ``violated``.
    """

    outcome: TraceOutcome
    state: int
    done: bool
    arrivals: tuple[tuple[int, int], ...]
    broken_at: int | None = None
    broken_state: int | None = None


class TraceRunner:
    """Runs one automaton over one trace after another.

    Once many samples have been run, the automaton is compiled to Python code, the generated monitor.
    It computes the same steps as :class:`~tltlc.monitor.monitor.Monitor` in a tenth of the time, but
    reports errors in other words. So a trace with faulty samples is run again with ``Monitor``.

    With ``episodes``, a run stops when the episode ends, at the latest with the last sample. Then
    the trace is accepted if the episode is a success.
    """

    def __init__(self, fspa: Fspa, *, episodes: bool = False) -> None:
        self._fspa, self._episodes = fspa, episodes
        self.can_break = any(state.verdict == "violated" for state in fspa.states)
        """Whether a trace can violate the automaton."""
        self._generated: Any = None
        self._samples = 0

    def run(self, samples: Sequence[TraceSample], *, cut_off: bool = False) -> tuple[TraceRun, tuple[Diagnostic, ...]]:
        """Run the automaton over ``samples``, of which there must be at least one.

        Return the result of the run, and warnings about values that were clamped to their range.
        Pass ``cut_off`` if the trace goes on after ``samples``; then the last of ``samples`` does
        not end the episode.

        Raises:
            MonitorError: the errors of :meth:`~tltlc.monitor.monitor.Monitor.step`.
        """
        self._samples += len(samples)
        if self._generated is None and self._samples >= _SAMPLES_PER_STATE * len(self._fspa.states):
            self._generated = _generated_monitor(self._fspa)
        if self._generated is not None:
            generated = self._generated()
            # The error of a faulty sample is a ValueError.
            with suppress(ValueError):
                result = self._fast_run(list(map(generated.step, samples)))
                if not generated.notices and (result.done or not self._episodes):
                    return result, ()
        monitor = Monitor(self._fspa)
        return self._slow_run(monitor, samples, cut_off=cut_off), tuple(monitor.notices)

    def _fast_run(self, steps: Sequence[Any]) -> TraceRun:
        """Return the result of a run, given what the generated monitor reported at each step.

        The verdict ``violated`` is final, and an episode that has ended stays ended. So bisection
        finds the first step with this verdict, and the step at which the episode ends.
        """
        if self._episodes:
            steps = steps[: bisect_left(steps, True, key=attrgetter("done")) + 1]
        last = steps[-1]
        *_, total = accumulate(map(attrgetter("reward"), steps))
        outcome = TraceOutcome(last.accepting, last.verdict, len(steps), last.progress, total)
        arrivals = _arrivals(list(map(attrgetter("state"), steps)))
        if last.verdict != "violated":
            return TraceRun(outcome, last.state, last.done, arrivals)
        broken = bisect_left(steps, True, key=lambda step: step.verdict == "violated")
        return TraceRun(outcome, last.state, last.done, arrivals, broken + 1, steps[broken - 1].state if broken else 0)

    def _slow_run(self, monitor: Monitor, samples: Sequence[TraceSample], *, cut_off: bool) -> TraceRun:
        """Run a monitor over the samples, step by step, and return the result."""
        total, number, states = 0.0, 0, [0]
        broken_at = broken_state = step = None
        last_number = len(samples) if self._episodes and not cut_off else None
        for number, sample in enumerate(samples, start=1):
            step = monitor.step(sample, last=number == last_number)
            total += step.reward
            if broken_at is None and step.verdict == "violated":
                broken_at, broken_state = number, states[-1]
            states.append(step.state)
            if self._episodes and step.done:
                break
        assert step is not None, "a trace has at least one sample"
        accepted = monitor.success if self._episodes else step.accepting
        outcome = TraceOutcome(accepted, step.verdict, number, step.progress, total)
        return TraceRun(outcome, step.state, step.done, _arrivals(states[1:]), broken_at, broken_state)


def _arrivals(states: Sequence[int]) -> tuple[tuple[int, int], ...]:
    """Return the field ``arrivals`` of :class:`TraceRun`; ``states`` has the state after each sample."""
    changes = (
        (after, number)
        for number, (before, after) in enumerate(zip((0, *states), states, strict=False), start=1)
        if before != after
    )
    return ((0, 0), *changes)


def _generated_monitor(fspa: Fspa) -> Any:
    """Generate Python code for an automaton, as ``tltlc compile -t python`` does; return its class ``Monitor``."""
    (text,) = emit("python", fspa).values()
    namespace: dict[str, Any] = {"__name__": f"<monitor of {fspa.name}>"}
    exec(compile(text, namespace["__name__"], "exec"), namespace)
    return namespace["Monitor"]
