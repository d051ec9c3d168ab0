"""Describe how recorded traces fail: which clauses of the spec they break or do not meet."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from tltl_runtime.game.episode import EndKind
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltlc.api import Fspa


def trace_end_text(fspa: Fspa, cause: EndKind, clauses: Sequence[str], traces: Sequence[ExplainedEpisode]) -> str:
    """Describe how ``traces`` failed: ``breaks `alive` at step 12``, ``ends before `goal` is met``.

    All of them have the same ``cause`` and the same failed ``clauses`` of the spec. The caller appends
    the number of traces. So if the text ends with a clause that is set off by a comma, a comma also
    follows the clause: ``breaks `alive`, mostly at step 12,``.
    """
    names = " and ".join(f"`{clause}`" for clause in clauses)
    unmet = f"before {names or 'the spec'} {'are' if len(clauses) > 1 else 'is'} met"
    if cause == "limit":
        return f"reaches the limit {unmet}"
    if cause == "stopped":
        return f"ends {unmet}"
    steps = [step for trace in traces if (step := _violation_step(fspa, trace)) is not None]
    usual = _usual_step_text(fspa, steps)
    return f"makes {names} impossible{usual}" if cause == "blocked" else f"breaks {names or 'the spec'}{usual}"


def _violation_step(fspa: Fspa, trace: ExplainedEpisode) -> int | None:
    """Return the number, from 1, of the sample that broke the spec; None if no sample did."""
    violated = (arrival.step for arrival in trace.arrivals if fspa.states[arrival.state].verdict == "violated")
    return next(violated, None)


def step_text(fspa: Fspa, step: int) -> str:
    """Return the number of a sample with its time from the first sample on: ``step 12 (1.1 s)``.

    Without a fixed clock, the time is left out.
    """
    return f"step {step}{_time_text(fspa, step)}"


def _time_text(fspa: Fspa, *steps: int) -> str:
    if fspa.clock_s is None or fspa.clock_varies:
        return ""
    return f" ({' to '.join(f'{(step - 1) * fspa.clock_s:.6g} s' for step in steps)})"


def _usual_step_text(fspa: Fspa, steps: Sequence[int]) -> str:
    if not steps:
        return ""
    step, count = Counter(steps).most_common(1)[0]
    if count == len(steps):
        return f" at {step_text(fspa, step)}"
    if 2 * count > len(steps):
        return f", mostly at {step_text(fspa, step)},"
    least, most = min(steps), max(steps)
    return f", at steps {least} to {most}{_time_text(fspa, least, most)},"
