"""The tool ``witness``: shortest traces that a spec accepts and rejects."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltlc.automaton.fspa import Fspa
from tltlc.interfaces.mcp.answer import Answer, guarded, with_diagnostics
from tltlc.interfaces.mcp.schemas import SETTINGS, SOURCE, SPEC, TEXTS, arguments, result
from tltlc.interfaces.mcp.spec_argument import read_spec, search_work
from tltlc.interfaces.mcp.tool import Tool
from tltlc.monitor import Monitor
from tltlc.tools.witness import captions
from tltlc.tools.witness.blocks import BlockWriter
from tltlc.tools.witness.chosen_traces import chosen_traces
from tltlc.tools.witness.text import as_csv, as_test
from tltlc.tools.witness.traces import Witness
from tltlc.tools.witness.transitions import Moves

_KINDS: Final = ("accepting", "rejecting", "cover")


def run(arguments: Mapping[str, Any]) -> Answer:
    """Find traces of the specs in a file."""
    return guarded({"traces": []}, lambda: _find(arguments))


def _find(arguments: Mapping[str, Any]) -> Answer:
    compiled = read_spec(arguments).compiled()
    kinds = arguments.get("kinds", _KINDS[:2])
    traces: list[dict[str, Any]] = []
    diagnostics = list(compiled.diagnostics)
    for fspa in compiled.automata:
        witnesses, warnings = chosen_traces(Moves(fspa), kinds, search_work(arguments))
        diagnostics += warnings
        if witnesses and not fspa.atoms:
            diagnostics.append(captions.no_atoms_error(fspa))
            continue
        traces += _traces(fspa, witnesses)
    return with_diagnostics({"traces": traces}, diagnostics, "\n".join(map(_text, traces)))


def _traces(fspa: Fspa, witnesses: tuple[Witness, ...]) -> list[dict[str, Any]]:
    blocks, monitor = BlockWriter(fspa), Monitor(fspa)
    covers = sum(witness.kind == "cover" for witness in witnesses)
    number, traces = 0, []
    for witness in witnesses:
        number += witness.kind == "cover"
        title = captions.title(fspa, witness, number, covers)
        traces.append(
            {
                "spec": fspa.name,
                "kind": witness.kind,
                "title": title,
                "atoms": [[atom.name for atom in fspa.atoms if atom.name in letter] for letter in witness.letters],
                "cycle": witness.cycle,
                "test": as_test(fspa, witness, title, blocks),
                "csv": as_csv(fspa, witness, monitor) if fspa.signals else None,
            }
        )
    return traces


def _text(trace: Mapping[str, Any]) -> str:
    return f"{trace['test']}\nThe same trace as CSV:\n{trace['csv']}" if trace["csv"] else f"{trace['test']}"


TOOL: Final = Tool(
    name="witness",
    title="Show traces of a spec",
    description=(
        "Find a shortest trace that a spec accepts and a shortest trace that violates it, as `test` blocks to paste "
        "into the file and as CSV with signals. Use it to see what a spec means, or to make traces for tests. "
        '`kinds: ["cover"]` gives traces that together take every edge of the automaton.'
    ),
    arguments=arguments(
        {
            **SOURCE,
            **SPEC,
            "kinds": {
                "type": "array",
                "items": {"enum": list(_KINDS)},
                "minItems": 1,
                "description": "which traces to find (default: accepting and rejecting)",
            },
            **SETTINGS,
        }
    ),
    result=result(
        {
            "traces": {
                "type": "array",
                "items": {
                    "type": "object",
                    "required": ["spec", "kind", "title", "atoms", "cycle", "test", "csv"],
                    "properties": {
                        "spec": {"type": "string"},
                        "kind": {"enum": list(_KINDS)},
                        "title": {"type": "string"},
                        "atoms": {
                            "type": "array",
                            "items": TEXTS,
                            "description": "for each step, the atoms that hold; all others do not hold",
                        },
                        "cycle": {
                            "type": ["integer", "null"],
                            "description": "the index of the first step that repeats for ever; null for finite traces",
                        },
                        "test": {"type": "string", "description": "a `test` block for the file of the spec"},
                        "csv": {"type": ["string", "null"], "description": "null if the spec has no signals"},
                    },
                },
            }
        }
    ),
    run=run,
)
