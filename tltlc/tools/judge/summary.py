"""Count the reasons why traces are not accepted, and say them in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from statistics import median_low
from typing import Final

from tltlc.core.record import record
from tltlc.tools.judge.step_times import seconds_text
from tltlc.tools.judge.verdict import JudgedTrace, Kind, RejectionCause, TraceVerdict

_ORDER: Final[tuple[Kind, ...]] = ("broken", "blocked", "late", "unfinished")


@record
class CauseGroup:
    """Traces that are not accepted for the same reason.

    ``kind`` and ``clauses`` are those of their :class:`~tltlc.tools.judge.verdict.RejectionCause`. ``traces``
    are the names of the traces, and ``steps`` has, in the same order, the step of the cause in each trace.
    """

    kind: Kind
    clauses: tuple[str, ...]
    traces: tuple[str, ...]
    steps: tuple[int, ...]

    @property
    def usual_step(self) -> int | None:
        """The step that more than half of the traces have in common; None if there is no such step."""
        step, count = Counter(self.steps).most_common(1)[0]
        return step if 2 * count > len(self.steps) else None

    @property
    def step_range(self) -> tuple[int, int, int]:
        """The least step, the median (the lower one of two), and the greatest step."""
        return min(self.steps), median_low(self.steps), max(self.steps)


def cause_groups(traces: Iterable[JudgedTrace]) -> tuple[CauseGroup, ...]:
    """Return the traces that are not accepted, in groups with the same cause; see :func:`group_causes`."""
    verdicts = ((trace.name, trace.verdict) for trace in traces)
    return group_causes(
        (name, verdict.cause) for name, verdict in verdicts if verdict is not None and verdict.cause is not None
    )


def group_causes(causes: Iterable[tuple[str, RejectionCause]]) -> tuple[CauseGroup, ...]:
    """Return groups of traces that are not accepted for the same reason.

    ``causes`` has pairs of the name of a trace and the cause. The groups are sorted by the kind of
    their cause: ``broken``, ``blocked``, ``late``, ``unfinished``. Within a kind, larger groups come
    first.
    """
    groups: dict[tuple[Kind, tuple[str, ...]], list[tuple[str, int]]] = {}
    for name, cause in causes:
        groups.setdefault((cause.kind, cause.clauses), []).append((name, cause.step))
    ordered = sorted(groups.items(), key=lambda group: (_ORDER.index(group[0][0]), -len(group[1])))
    return tuple(
        CauseGroup(kind, clauses, tuple(name for name, _ in members), tuple(step for _, step in members))
        for (kind, clauses), members in ordered
    )


def unread_codes(traces: Iterable[JudgedTrace]) -> dict[str, int]:
    """Count the traces that cannot be judged, by the code of the first error of each trace.

    Return a dict from codes to counts, with the most frequent code first.
    """
    return dict(Counter(trace.diagnostics[0].code for trace in traces if trace.verdict is None).most_common())


def summary_text(traces: Sequence[JudgedTrace]) -> str:
    """Summarize the results in one line: ``62 of 100 accepted; 30 break `avoid on_lava`, mostly at step 3``."""
    accepted = sum(trace.verdict is not None and trace.verdict.outcome.accepted for trace in traces)
    parts = [f"{accepted} of {len(traces)} accepted", *map(group_text, cause_groups(traces))]
    if codes := unread_codes(traces):
        listed = ", ".join(f"{count} {code}" for code, count in codes.items())
        parts.append(f"{sum(codes.values())} cannot be judged ({listed})")
    return "; ".join(parts)


def group_text(group: CauseGroup, total: int | None = None) -> str:
    """Describe a group in words: ``30 break `avoid on_lava`, mostly at step 3``.

    If ``total`` is given, the number of all traces, the text begins with ``30 of 100``.
    """
    clauses, one = _list_text(group.clauses), len(group.traces) == 1
    count = f"{len(group.traces)}" if total is None else f"{len(group.traces)} of {total}"
    if group.kind == "late":
        unmet = f"{clauses or 'the spec'} {_are(group.clauses)} met"
        return f"{count} {'reaches' if one else 'reach'} the limit before {unmet}"
    if group.kind == "unfinished":
        left = f"before {clauses} {_are(group.clauses)} met" if clauses else "too early"
        return f"{count} {'ends' if one else 'end'} {left}"
    if group.kind == "blocked":
        return f"{count} {'makes' if one else 'make'} {clauses} impossible, {_steps_text(group)}"
    return f"{count} {'breaks' if one else 'break'} {clauses or 'the spec'}, {_steps_text(group)}"


def group_json(group: CauseGroup) -> dict[str, object]:
    """Return a group as JSON data, without the names of its traces."""
    return {
        "kind": group.kind,
        "clauses": list(group.clauses),
        "count": len(group.traces),
        "usual_step": group.usual_step,
        "steps": dict(zip(("least", "median", "greatest"), group.step_range, strict=True)),
    }


def _are(clauses: Sequence[str]) -> str:
    return "are" if len(clauses) > 1 else "is"


def _list_text(clauses: Sequence[str]) -> str:
    return " and ".join(f"`{clause}`" for clause in clauses)


def _steps_text(group: CauseGroup) -> str:
    least, middle, most = group.step_range
    if least == most:
        return f"at step {least}"
    if group.usual_step is not None:
        return f"mostly at step {group.usual_step}"
    return f"at steps {least} to {most}, half of them by step {middle}"


def trace_text(trace: JudgedTrace) -> str:
    """Describe the result of one trace in words: ``not accepted: breaks `avoid on_lava` at step 3 of 50``."""
    if trace.verdict is None:
        so_far = f"; before that, it {_breaking_text(trace.so_far)}" if trace.so_far else ""
        return f"cannot be judged: {trace.diagnostics[0].title}{so_far}"
    return _verdict_text(trace.verdict)


def _verdict_text(verdict: TraceVerdict) -> str:
    cause = verdict.cause
    if cause is None:
        return f"accepted: {verdict.outcome.verdict} after {_steps_of(verdict)}"
    return f"not accepted: {rejection_text(verdict, cause)}"


def rejection_text(verdict: TraceVerdict, cause: RejectionCause, step_s: float | None = None) -> str:
    """Say why a trace is not accepted: ``breaks `avoid on_lava` at step 3 of 50``.

    ``cause`` is that of the ``verdict``. With ``step_s``, the time between two samples in seconds, the text
    also has the time of the step, from the first sample on.
    """
    if cause.kind in ("broken", "blocked"):
        time = seconds_text(None if step_s is None else (cause.step - 1) * step_s)
        return f"{_breaking_text(cause)} of {verdict.samples}{time}{_reason_text(cause)}"
    clauses, steps = _list_text(cause.clauses), _steps_of(verdict)
    if cause.kind == "late":
        return f"{clauses or 'the spec'} {_are(cause.clauses)} not met at the limit, after {steps}"
    left = f"{clauses} {_are(cause.clauses)} not met" if clauses else "it is too short"
    return f"{left} after {steps}"


def _steps_of(verdict: TraceVerdict) -> str:
    steps = verdict.outcome.steps
    if steps < verdict.samples:
        return f"{steps} of {verdict.samples} steps"
    return f"{steps} step{'' if steps == 1 else 's'}"


def _reason_text(cause: RejectionCause) -> str:
    """Return what was measured at the step, or the atoms that the clauses do not name; empty if they name all."""
    if cause.measure is not None and cause.measure.text is not None:
        return f": {cause.measure.text}"
    in_words = zip(cause.atoms, cause.words or cause.atoms, strict=True)
    unnamed = [words for atom, words in in_words if not any(atom in clause for clause in cause.clauses)]
    return f": {_list_text(unnamed)}" if unnamed else ""


def _breaking_text(cause: RejectionCause) -> str:
    clauses = _list_text(cause.clauses)
    what = f"makes {clauses} impossible" if cause.kind == "blocked" else f"breaks {clauses or 'the spec'}"
    return f"{what} at step {cause.step}"
