"""Compare the verdicts of ``tltlc regress`` on the shipped suite with the required verdicts."""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from benchmarks.markdown import met_or_missed, table
from benchmarks.measure import run
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

SECTION = "suite"
COMMAND: Final = "tltlc regress"
TIMEOUT_S: Final = 3600.0

REQUIRED_VERDICTS: Final[Mapping[str, Sequence[str]]] = {
    "navigation:v0": ("pass",),
    "cover_and_hide:v0": ("pass",),
    "branching:v0": ("pass",),
    "navigation:v1": ("pass", "review"),
    "navigation:v2": ("fail",),
    "cover_and_hide:v2": ("review", "fail"),
    "branching:v2": ("review", "fail"),
}
"""The verdicts that a case may have."""
BLOCKED: Final = ("navigation:v2", "corridor_block_2")
"""The case whose reasons must name the block that shuts the corridor, and the block."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Run the suite if the store has no verdicts."""
    if find_spec("torch") is None or find_spec("pybullet") is None:
        say(f"{SECTION} left out: torch or pybullet is not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    measure_missing(store, SECTION, [COMMAND], lambda _: _verdicts(), say, field="cases")


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the row of the table of goals, once the suite was run."""
    cases = _cases(records)
    if not cases:
        return
    wrong = [
        f"{name} {cases[name]['verdict']}"
        for name, required in REQUIRED_VERDICTS.items()
        if cases[name]["verdict"] not in required
    ]
    case, block = BLOCKED
    if not any(block in reason for reason in cases[case]["reasons"]):
        wrong.append(f"{case} does not name {block}")
    yield (
        "of the shipped suite all v0 `pass`, navigation v1 does not `fail`, navigation v2 does and names what shuts "
        "the corridor, cover_and_hide v2 and branching v2 do not `pass`",
        ", ".join(wrong) or ", ".join(f"{name} {case_record['verdict']}" for name, case_record in cases.items()),
        met_or_missed(not wrong),
    )


def section(records: Mapping[str, Record]) -> str:
    """Return the section on the shipped suite; empty without measurements."""
    cases = _cases(records)
    if not cases:
        return ""
    body = [
        (
            name,
            f"`{case_record['verdict']}`" + ("" if case_record["certain"] else " *"),
            f"{round(case_record['pass_rate'] * case_record['episodes'])} of {case_record['episodes']}",
            *(f"{case_record[figure]:.2f} ({case_record['before'][figure]:.2f})" for figure in ("progress", "reward")),
            case_record["headline"],
        )
        for name, case_record in cases.items()
    ]
    header = ("case", "verdict", "met", "progress", "reward", "why")
    return f"""
## The shipped suite

`python -m benchmarks --only {SECTION}` runs `{COMMAND}`. *Met*: how many episodes met the spec, of the episodes that
were played until the verdict was certain; `*` marks a verdict that is not certain. *Progress* and *reward* are means,
with those of the baseline in brackets.

{table(header, body)}
"""


def _verdicts() -> Record:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "report.json"
        command = [sys.executable, "-m", "tltlc", "regress", "--out", folder, "--json", str(path)]
        process_run = run(command, TIMEOUT_S, cwd=ROOT)
        if process_run.status not in (0, 1):
            return {"failed": f"exit status {process_run.status}"}
        report = json.loads(path.read_text(encoding="utf-8"))
    return {
        "cases": {case["name"]: _case_record(case) for case in report["cases"]},
        "source": source_digest("tltlc", "runtime"),
    }


def _case_record(case: Mapping[str, Any]) -> Record:
    keys = ("verdict", "certain", "episodes", "pass_rate", "headline", "reasons")
    return {**{key: case[key] for key in keys}, **_means(case), "before": _means(case["baseline"])}


def _means(figures: Mapping[str, Any]) -> Record:
    return {key: figures[key]["mean"] for key in ("progress", "reward")}


def _cases(records: Mapping[str, Record]) -> dict[str, Record]:
    cases: dict[str, Record] = records.get(COMMAND, {}).get("cases", {})
    return cases
