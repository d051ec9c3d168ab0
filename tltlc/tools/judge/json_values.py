"""Convert the verdicts of traces, and the steps of a monitor, to JSON values."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.formats.json import entry
from tltlc.monitor.run import RunStep, TraceOutcome
from tltlc.tools.judge.summary import cause_groups, group_json, unread_codes
from tltlc.tools.judge.verdict import JudgedTrace, RejectionCause


def step_values(fspa: Fspa, row: RunStep) -> dict[str, Any]:
    """Return a step of a monitor of ``fspa`` as a JSON object."""
    step = row.step
    return {
        "step": row.number,
        "state": step.state,
        "label": step.label,
        "label_english": step.label_english,
        "verdict": step.verdict,
        "accepting": step.accepting,
        "done": step.done,
        "progress": step.progress,
        "reward": step.reward,
        "atoms": {atom.name: value for atom, value in zip(fspa.atoms, row.values, strict=True)},
        "failed_clause": step.failed_clause,
        "failed_atom": step.failed_atom,
        "failed_step": step.failed_step,
    }


def outcome_values(outcome: TraceOutcome) -> dict[str, Any]:
    """Return the outcome of a trace as a JSON object."""
    return {
        "accepted": outcome.accepted,
        "verdict": outcome.verdict,
        "steps": outcome.steps,
        "progress": outcome.progress,
        "reward": outcome.total_reward,
    }


def trace_values(trace: JudgedTrace) -> dict[str, Any]:
    """Return the result of one trace as a JSON object."""
    values: dict[str, Any] = {"trace": trace.name, "accepted": None, "verdict": None}
    cause = trace.so_far
    if trace.verdict is not None:
        cause = trace.verdict.cause
        outcome = outcome_values(trace.verdict.outcome)
        verdict = trace.verdict
        values |= {"samples": verdict.samples, **outcome, "remaining": verdict.remaining, "unmet": verdict.unmet}
    return {**values, "cause": _cause_values(cause), "diagnostics": list(map(entry, trace.diagnostics))}


def summary_values(traces: Sequence[JudgedTrace], total: int, others: Sequence[str]) -> dict[str, Any]:
    """Return the summary of many traces as a JSON object.

    ``total`` is the number of traces to judge, which is greater than the number of ``traces`` if not
    all were judged. ``others`` are the files that are not traces, by their names.
    """
    codes = unread_codes(traces)
    return {
        "complete": len(traces) == total,
        "total": total,
        "accepted": sum(trace.verdict is not None and trace.verdict.outcome.accepted for trace in traces),
        "unread": sum(codes.values()),
        "unread_codes": codes,
        "not_traces": list(others),
        "causes": list(map(group_json, cause_groups(traces))),
    }


def _cause_values(cause: RejectionCause | None) -> dict[str, Any] | None:
    if cause is None:
        return None
    return {"kind": cause.kind, "step": cause.step, "clauses": list(cause.clauses), "atoms": list(cause.atoms)}
