"""The corpus as files: a folder for each case, an index, and a page and a script for checking a monitor."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from tltlc import backends
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.expression.evaluate import MULTIPLIED_EXPONENTS
from tltlc.expression.tree import Const, Op, nodes
from tltlc.io.files import MAX_ARTEFACT_BYTES, read_source
from tltlc.tools.conformance import (
    arithmetic,
    borders,
    file_cases,
    memory,
    odd_traces,
    operators,
    random_cases,
    shapes,
    varying_clock,
)
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase
from tltlc.tools.conformance.expected_output import COLUMNS, ExpectedOutput, Rejection, expected_output

CASES: Final[CaseBuilders] = {
    **file_cases.CASES,
    **operators.CASES,
    **arithmetic.CASES,
    **borders.CASES,
    **shapes.CASES,
    **odd_traces.CASES,
    **random_cases.CASES,
    **memory.CASES,
    **varying_clock.CASES,
}

VERSION: Final = 1
TOLERANCE: Final = 1e-12
"""The largest allowed difference from an expected number, in cases that are not exact (:func:`is_exact`)."""

_ROUNDED_BY_LIBRARY: Final = ("exp", "tanh", "^")
"""Operators whose results depend on the mathematical library of the monitor's language."""


def files() -> backends.Files:
    """Return the content of every file of the corpus, by its path with slashes."""
    folders: backends.Files = {}
    index: list[dict[str, Any]] = []
    for make in CASES.values():
        case = make()
        outcomes = [expected_output(case.fspa, trace) for trace in case.traces]
        index.append(_index_entry(case, outcomes))
        folders.update(_case_files(case, outcomes))
    document = {"version": VERSION, "columns": list(COLUMNS), "tolerance": TOLERANCE, "cases": index}
    return {
        "README.md": _package_text("about.md"),
        "check.py": _package_text("check.py"),
        "index.json": json.dumps(document, indent=1, ensure_ascii=False) + "\n",
        **folders,
    }


def is_corpus(folder: Path) -> bool:
    """Whether a folder contains a corpus of any version, that is, whether its ``index.json`` is that of a corpus."""
    try:
        document = json.loads(read_source(folder / "index.json", max_bytes=MAX_ARTEFACT_BYTES).text)
    except (TltlError, ValueError, RecursionError):
        return False
    return isinstance(document, dict) and document.keys() >= {"version", "columns", "tolerance", "cases"}


def is_exact(fspa: Fspa) -> bool:
    """Whether all monitors of an automaton must compute the same numbers, to the last digit.

    This is so if IEEE 754 defines the result of each operation in the automaton's atoms and registers.
    """
    expressions = [*(atom.expression for atom in fspa.atoms), *(register.update for register in fspa.registers)]
    operations = [node for expression in expressions for node in nodes(expression) if isinstance(node, Op)]
    return all(node.op not in _ROUNDED_BY_LIBRARY or _is_product(node) for node in operations)


def _is_product(node: Op) -> bool:
    """Whether the node is a power with an exponent, such as 2, for which monitors multiply."""
    exponent = node.args[-1]
    return node.op == "^" and isinstance(exponent, Const) and exponent.value in MULTIPLIED_EXPONENTS


def _case_files(case: ConformanceCase, outcomes: Sequence[ExpectedOutput]) -> backends.Files:
    """Return the files of one case, by path; ``outcomes`` has the expected output for each trace."""
    name = case.fspa.name
    contents = backends.emit("json", case.fspa)
    if case.source is not None:
        contents[f"{name}.tltl"] = case.source
    for number, (trace, outcome) in enumerate(zip(case.traces, outcomes, strict=True), start=1):
        contents[f"{name}.{number}.csv"] = trace
        contents[f"{name}.{number}.expected.csv"] = outcome.table()
        if outcome.rejection is not None:
            contents[f"{name}.{number}.error.txt"] = _rejection_text(outcome.rejection)
    return {f"{name}/{file}": content for file, content in contents.items()}


def _rejection_text(rejection: Rejection) -> str:
    lines = [f"kind: {rejection.kind}", f"step: {rejection.step}", *(f"name: {name}" for name in rejection.names)]
    if rejection.line is not None:
        lines.insert(2, f"line: {rejection.line}")
    return "".join(f"{line}\n" for line in lines)


def _index_entry(case: ConformanceCase, outcomes: Sequence[ExpectedOutput]) -> dict[str, Any]:
    """Return the entry of a case in the index; ``outcomes`` has the expected output for each trace."""
    fspa, name = case.fspa, case.fspa.name
    traces = []
    for number, outcome in enumerate(outcomes, start=1):
        rejection = outcome.rejection
        error = rejection and rejection.document()
        stem = f"{name}/{name}.{number}"
        row: dict[str, Any] = {"trace": f"{stem}.csv", "expected": f"{stem}.expected.csv", "rows": len(outcome.rows)}
        traces.append(row | {"warnings": outcome.warnings, "error": error})
    return {
        "name": name,
        "about": case.about,
        "artefact": f"{name}/{name}.fspa.json",
        "source": None if case.source is None else f"{name}/{name}.tltl",
        "semantics": fspa.semantics,
        "judge": fspa.judge,
        "limit_steps": fspa.limit_steps,
        "exact": is_exact(fspa),
        "traces": traces,
    }


def _package_text(name: str) -> str:
    """Return the text of the file ``name`` in the folder of this module."""
    path = os.path.join(os.path.dirname(__file__), name)  # noqa: PTH118, PTH120
    with open(path, encoding="utf-8") as file:  # noqa: PTH123
        return file.read()
