"""The verdicts of the shipped suite and Table I, as in RESULTS.md."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from benchmarks import suite, table1
from benchmarks.store import Record

V0 = ("navigation", "cover_and_hide", "branching")


def judged(**verdicts: str) -> dict[str, Record]:
    """Records of the suite with the required verdicts, except the given ones; ``_`` in a name
    stands for ``:``."""
    cases: dict[str, Any] = {}
    for name, required in {
        **suite.REQUIRED_VERDICTS,
        "branching:v1": ("pass",),
        "cover_and_hide:v1": ("pass",),
    }.items():
        figures = {"progress": 1.0, "reward": 0.7}
        reasons = ["the way ends at `corridor_block_2`"] if name == "navigation:v2" else ["met"]
        figures_of_verdict = {
            "verdict": required[-1],
            "certain": True,
            "episodes": 50,
            "pass_rate": 0.98,
            "reasons": reasons,
        }
        cases[name] = {**figures_of_verdict, "headline": reasons[0], **figures, "before": figures}
    for name, verdict in verdicts.items():
        cases[":".join(name.rsplit("_", 1))]["verdict"] = verdict
    return {suite.COMMAND: {"cases": cases, "source": "0"}}


def test_the_required_verdicts_meet_the_goal() -> None:
    ((_, figure, met),) = suite.goals(judged())
    assert met == "met" and "navigation:v2 fail" in figure
    assert suite.section(judged()).count("\n| ") == 2 + 9
    assert list(suite.goals({})) == [] and suite.section({}) == ""


@pytest.mark.parametrize(
    ("case", "verdict"), [("navigation_v0", "review"), ("navigation_v2", "review"), ("branching_v2", "pass")]
)
def test_another_verdict_misses_the_goal(case: str, verdict: str) -> None:
    ((_, figure, met),) = suite.goals(judged(**{case: verdict}))
    assert (figure, met) == (f"{':'.join(case.rsplit('_', 1))} {verdict}", "**missed**")


def test_the_block_that_shuts_the_corridor_must_be_named() -> None:
    records = judged()
    records[suite.COMMAND]["cases"]["navigation:v2"]["reasons"] = ["met in 0 of 25 episodes"]
    ((_, figure, met),) = suite.goals(records)
    assert (figure, met) == ("navigation:v2 does not name corridor_block_2", "**missed**")


def table_records(ours: float, imitation: float) -> dict[str, Record]:
    rows = {"ours": ours, "imitation": imitation, "expert": 1.0}
    cells = {f"{level} v0 {who}": dict.fromkeys(table1.FIGURES, figure) for level in V0 for who, figure in rows.items()}
    return {table1.COMMAND: {"table": "| level |", "cells": cells, "source": "0"}}


def test_ours_must_be_above_imitation_in_every_column() -> None:
    ((_, figure, met),) = table1.goals(table_records(0.9, 0.5))
    assert met == "met" and figure.startswith("navigation pass rate 0.90 against 0.50, navigation progress ")
    assert [met for *_, met in table1.goals(table_records(1.0, 1.0))] == ["**missed**"]
    assert "| level |" in table1.section(table_records(1.0, 0.5))
    assert list(table1.goals({})) == [] and table1.section({}) == ""


def test_the_figures_of_a_cell_are_means_over_its_episodes(tmp_path: Path) -> None:
    path = tmp_path / "navigation-v0-ours.json"
    path.write_text(
        '{"identity": "0", "content": [{"success": true, "progress": 1.0, "reward": 0.5},'
        ' {"success": false, "progress": 0.5, "reward": -0.5}]}',
        encoding="utf-8",
    )
    assert table1._figures(path) == {"pass rate": 0.5, "progress": 0.75, "reward": 0.0}
