"""The verdicts of ``tltlc regress`` on the suite that comes with tltlc, beside those that are asked for."""

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

ASKED: Final[Mapping[str, Sequence[str]]] = {
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
"""The case whose reasons are to name what shuts the way."""


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Run the suite where the store does not have its verdicts yet."""
    if find_spec("torch") is None or find_spec("pybullet") is None:
        say(f"{SECTION} left out: torch or pybullet is not installed (the extra `rl`, Python 3.10 or 3.11)")
        return
    measure_missing(store, SECTION, [COMMAND], lambda _: _verdicts(), say, done="cases")


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """A row of the table of goals, once the suite was run."""
    cases = _cases(records)
    if not cases:
        return
    wrong = [f"{name} {cases[name]['verdict']}" for name, asked in ASKED.items() if cases[name]["verdict"] not in asked]
    case, block = BLOCKED
    if not any(block in each for each in cases[case]["reasons"]):
        wrong.append(f"{case} does not name {block}")
    yield (
        "of the shipped suite all v0 `pass`, navigation v1 does not `fail`, navigation v2 does and names what shuts "
        "the corridor, cover_and_hide v2 and branching v2 do not `pass`",
        ", ".join(wrong) or ", ".join(f"{name} {each['verdict']}" for name, each in cases.items()),
        met_or_missed(not wrong),
    )


def section(records: Mapping[str, Record]) -> str:
    """The section on the shipped suite."""
    cases = _cases(records)
    if not cases:
        return ""
    body = [
        (
            name,
            f"`{each['verdict']}`" + ("" if each["certain"] else " *"),
            f"{round(each['pass_rate'] * each['episodes'])} of {each['episodes']}",
            *(f"{each[figure]:.2f} ({each['before'][figure]:.2f})" for figure in ("progress", "reward")),
            each["headline"],
        )
        for name, each in cases.items()
    ]
    header = ("case", "verdict", "met", "progress", "reward", "why")
    return f"""
## The shipped suite

`python -m benchmarks --only {SECTION}` runs `{COMMAND}`. *Met*: the episodes that meet the spec, of those that were
played until the verdict was certain; a `*` marks one that is not. *Progress* and *reward* are means, those of the
baseline in brackets.

{table(header, body)}
"""


def _verdicts() -> Record:
    with tempfile.TemporaryDirectory() as place:
        path = Path(place) / "report.json"
        command = [sys.executable, "-m", "tltlc", "regress", "--out", place, "--json", str(path)]
        made = run(command, TIMEOUT_S, cwd=ROOT)
        if made.status not in (0, 1):
            return {"failed": f"exit status {made.status}"}
        report = json.loads(path.read_text(encoding="utf-8"))
    return {
        "cases": {case["name"]: _kept(case) for case in report["cases"]},
        "source": source_digest("tltlc", "runtime"),
    }


def _kept(case: Mapping[str, Any]) -> Record:
    keys = ("verdict", "certain", "episodes", "pass_rate", "headline", "reasons")
    return {**{key: case[key] for key in keys}, **_means(case), "before": _means(case["baseline"])}


def _means(figures: Mapping[str, Any]) -> Record:
    return {key: figures[key]["mean"] for key in ("progress", "reward")}


def _cases(records: Mapping[str, Record]) -> dict[str, Record]:
    found: dict[str, Record] = records.get(COMMAND, {}).get("cases", {})
    return found
