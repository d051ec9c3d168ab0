"""The tool ``monitor``: judge recorded traces by a spec."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any, Final

from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.compiled_input import Input
from tltlc.interfaces.mcp.answer import Answer, WrongUseError, diagnostic_text, guarded, with_diagnostics
from tltlc.interfaces.mcp.schemas import ONE_SPEC, PATHS, SETTINGS, SOURCE, TEXTS, arguments, result
from tltlc.interfaces.mcp.spec_argument import read_spec
from tltlc.interfaces.mcp.tool import Tool
from tltlc.io.files import read_bytes
from tltlc.io.limits import JUDGED_TRACE
from tltlc.monitor import Monitor
from tltlc.monitor.packed import unpacked
from tltlc.monitor.parquet import as_text
from tltlc.monitor.run import RunStep
from tltlc.monitor.run import run as monitor_steps
from tltlc.monitor.traces import TraceSample, read_trace
from tltlc.tools.judge.failing_step import FailingStep
from tltlc.tools.judge.json_values import step_values, summary_values, trace_values
from tltlc.tools.judge.judge import Judge
from tltlc.tools.judge.measures import short_number
from tltlc.tools.judge.pool import judge_files
from tltlc.tools.judge.step_values import atom_value, truths
from tltlc.tools.judge.summary import summary_text, trace_text
from tltlc.tools.judge.trace_files import find_traces
from tltlc.tools.judge.verdict import JudgedTrace

MOST_ROWS: Final = 200
"""An answer shows at most this many steps of a trace."""

_TRACE_NAME: Final = "<trace>"
"""The name, in messages, of a trace that is no file."""
_TRACES: Final = ("traces", "trace_text", "rows")


def run(arguments: Mapping[str, Any]) -> Answer:
    """Judge traces by a spec."""
    if sum(name in arguments for name in _TRACES) != 1:
        raise WrongUseError(
            "give the trace in one of these: `traces` (paths), `trace_text` (CSV or JSON lines), `rows`"
        )
    empty = {"spec": None, "traces": [], "failure": None, **summary_values((), 0, ()), "rows": []}
    return guarded(empty, lambda: _judge(arguments))


def _judge(arguments: Mapping[str, Any]) -> Answer:
    compiled = read_spec(arguments).compiled()
    fspa = compiled.only_automaton()
    names: Sequence[str] = ()
    others: Sequence[str] = ()
    errors: tuple[Diagnostic, ...] = ()
    if "traces" in arguments:
        files = find_traces(arguments["traces"])
        names, others, errors = files.traces, files.others, files.errors
    data = None if "traces" in arguments else _trace_data(arguments)
    traces = _judged(compiled, names, data, episodes=arguments.get("episodes", False))
    rows = _rows(arguments, fspa, names, data)
    failing = _failing_step(compiled, traces[0], data) if len(traces) == 1 else None
    document = {
        "spec": fspa.name,
        "traces": list(map(trace_values, traces)),
        "failure": None if failing is None else failing.values(),
        **summary_values(traces, len(traces), others),
        "rows": [step_values(fspa, row) for row in rows],
    }
    lines = [f"{trace.name}: {trace_text(trace)}" for trace in traces]
    lines += [summary_text(traces)] if len(traces) > 1 else []
    lines += [] if failing is None else failing.details()
    known = truths(fspa) if rows else frozenset()
    lines += [_row_text(fspa, row, known) for row in rows]
    reported = [(trace, diagnostic) for trace in traces for diagnostic in trace.diagnostics]
    missing = [diagnostic for trace, diagnostic in reported if trace.verdict is None and not diagnostic.labels]
    lines += [f"\n{diagnostic_text(diagnostic)}" for _, diagnostic in reported if diagnostic not in missing]
    return with_diagnostics(document, (*compiled.diagnostics, *errors, *missing), "\n".join(lines))


def _trace_data(arguments: Mapping[str, Any]) -> bytes:
    """Return the trace in the arguments as CSV or JSON lines."""
    text: str = arguments.get("trace_text", "")
    if "rows" in arguments:
        text = "".join(f"{json.dumps(row)}\n" for row in arguments["rows"])
    return text.encode(errors="replace")


def _judged(compiled: Input, names: Sequence[str], data: bytes | None, *, episodes: bool) -> list[JudgedTrace]:
    """Judge the files ``names``, or the one trace in ``data``."""
    fspa, clauses = compiled.only_automaton(), compiled.clauses()
    if data is not None:
        return [Judge(fspa, clauses, episodes=episodes).judge(_TRACE_NAME, data)]
    # A worker process may not start processes of its own.
    return list(judge_files(fspa, clauses, names, 1, episodes=episodes))


def _rows(arguments: Mapping[str, Any], fspa: Fspa, names: Sequence[str], data: bytes | None) -> list[RunStep]:
    """Return the steps that ``from_step`` and ``to_step`` ask for, up to the first that cannot be read."""
    if "from_step" not in arguments and "to_step" not in arguments:
        return []
    first = arguments.get("from_step", 1)
    last = min(arguments.get("to_step", first + MOST_ROWS - 1), first + MOST_ROWS - 1)
    name = _TRACE_NAME
    if data is None:
        if len(names) != 1:
            raise WrongUseError(f"`from_step` and `to_step` are for one trace, and `traces` names {len(names)}")
        (name,) = names
        data = _trace_file(name)
    rows: list[RunStep] = []
    # The verdict has the error of a trace that cannot be read.
    with suppress(TltlError):
        rows.extend(islice(monitor_steps(Monitor(fspa), _samples(fspa, name, data)), first - 1, last))
    return rows


def _failing_step(compiled: Input, trace: JudgedTrace, data: bytes | None) -> FailingStep | None:
    """Return the step that broke the spec, with what was measured there; None if no step of the trace did.

    ``data`` is the trace, or None if it is a file.
    """
    cause = trace.so_far if trace.verdict is None else trace.verdict.cause
    if cause is None or cause.kind not in ("broken", "blocked"):
        return None
    fspa = compiled.only_automaton()
    monitor = Monitor(fspa)
    failing = FailingStep(monitor, compiled.clause_places(), compiled.clauses)
    # The file may have changed since it was judged.
    with suppress(TltlError):
        samples = _samples(fspa, trace.name, _trace_file(trace.name) if data is None else data)
        for _ in failing.noted(monitor_steps(monitor, islice(failing.watched(samples), cause.step))):
            pass
    return failing


def _trace_file(name: str) -> bytes:
    return unpacked(read_bytes(name, name, JUDGED_TRACE.size), name)


def _samples(fspa: Fspa, name: str, data: bytes) -> Iterator[TraceSample]:
    stream = io.BytesIO(as_text(data, name, fspa.signals))
    return read_trace(stream, name, fspa.signals, fspa.clock_s, clock_varies=fspa.clock_varies)


def _row_text(fspa: Fspa, row: RunStep, known: frozenset[int]) -> str:
    values = (atom_value(index, value, known) for index, value in enumerate(row.values))
    atoms = ", ".join(f"{atom.name} {value}" for atom, value in zip(fspa.atoms, values, strict=True))
    return f"step {row.number}: {row.step.verdict}, progress {short_number(row.step.progress)}; {atoms}"


_STEP: Final = {"type": "integer", "minimum": 1, "maximum": 10**12}

_CAUSE: Final = {
    "type": ["object", "null"],
    "required": ["kind", "step", "clauses", "atoms"],
    "properties": {
        "kind": {
            "enum": ["broken", "blocked", "late", "unfinished"],
            "description": "from `step` on, `broken`: nothing can meet the clauses any more; `blocked`: nothing can "
            "without breaking others; `late`: the episode has reached its limit; `unfinished`: the trace ends",
        },
        "step": {"type": "integer", "minimum": 1},
        "clauses": {**TEXTS, "description": "the clauses to blame, as in the source"},
        "atoms": {**TEXTS, "description": "the atoms whose values at `step` broke the spec"},
    },
    "description": "why the trace is not accepted",
}

_FAILURE: Final = {
    "type": ["object", "null"],
    "required": [
        "failed_step",
        "failed_clause",
        "failed_atom",
        "clause",
        "file",
        "line",
        "atoms",
        "unmet",
        "asked_since",
    ],
    "properties": {
        "failed_step": {"type": "integer", "minimum": 1},
        "failed_clause": {"type": ["string", "null"], "description": "the clause to blame, if it is a single one"},
        "failed_atom": {"type": ["string", "null"]},
        "clause": {"type": ["integer", "null"], "description": "the number of the clause, from 1"},
        "file": {"type": ["string", "null"]},
        "line": {"type": ["integer", "null"], "description": "where the clause begins"},
        "atoms": {
            "type": "object",
            "additionalProperties": {"type": "number"},
            "description": "the values of the atoms that decided; an atom holds if its value is above 0",
        },
        "unmet": {"type": "string", "description": "what remained to be satisfied before this step, in words"},
        "asked_since": {
            "type": ["integer", "null"],
            "minimum": 1,
            "description": "the step at which the clause began to ask for what failed: its time limit counts from here",
        },
    },
    "description": "of a single trace: the step that broke the spec; null if no step did",
}

_TRACE: Final = {
    "type": "object",
    "required": ["trace", "accepted", "verdict", "cause", "diagnostics"],
    "properties": {
        "trace": {"type": "string"},
        "accepted": {"type": ["boolean", "null"], "description": "null if the trace cannot be judged"},
        "verdict": {"enum": ["satisfied", "holding", "pending", "violated", None]},
        "samples": {"type": "integer"},
        "steps": {"type": "integer"},
        "progress": {"type": "number"},
        "reward": {"type": "number"},
        "remaining": {"type": "string", "description": "the formula that remains to be satisfied"},
        "cause": _CAUSE,
        "diagnostics": {
            "type": "array",
            "items": {"type": "object", "required": ["code", "severity", "title", "help", "labels"]},
        },
    },
}

TOOL: Final = Tool(
    name="monitor",
    title="Judge traces by a spec",
    description=(
        "Judge recorded play by one spec: whether each trace is accepted, and if not, at which step which clause "
        "failed. Give the trace as `traces` (files or folders with CSV, JSON lines, Parquet or tapes), `trace_text`, "
        'or as `rows`, a list of objects such as {"noise": 0.2, "seen": false}. With `from_step` and `to_step`, the '
        f"answer also has the values of the atoms at these steps (at most {MOST_ROWS})."
    ),
    arguments=arguments(
        {
            **SOURCE,
            **ONE_SPEC,
            "traces": {**PATHS, "minItems": 1, "description": "paths of traces, or of folders with traces"},
            "trace_text": {"type": "string", "description": "a trace as CSV with a header, or as JSON lines"},
            "rows": {
                "type": "array",
                "items": {"type": "object"},
                "description": "a trace: the values of the signals at each step, by name",
            },
            "episodes": {
                "type": "boolean",
                "description": "judge each trace as an episode, which ends at the goal, at a violation or at the limit",
            },
            "from_step": {**_STEP, "description": "the first step to show, from 1"},
            "to_step": {**_STEP, "description": "the last step to show"},
            **SETTINGS,
        }
    ),
    result=result(
        {
            "spec": {"type": ["string", "null"]},
            "traces": {"type": "array", "items": _TRACE},
            "failure": _FAILURE,
            "complete": {"type": "boolean"},
            "total": {"type": "integer"},
            "accepted": {"type": "integer", "description": "how many traces are accepted"},
            "unread": {"type": "integer", "description": "how many traces cannot be judged"},
            "unread_codes": {"type": "object", "additionalProperties": {"type": "integer"}},
            "not_traces": TEXTS,
            "causes": {"type": "array", "items": {"type": "object"}, "description": "the traces that fail, by cause"},
            "rows": {
                "type": "array",
                "items": {
                    "type": "object",
                    "required": ["step", "state", "verdict", "progress", "reward", "atoms"],
                    "properties": {"atoms": {"type": "object", "additionalProperties": {"type": "number"}}},
                },
                "description": "the steps `from_step` to `to_step`; an atom holds if its value is above 0",
            },
        }
    ),
    run=run,
)
