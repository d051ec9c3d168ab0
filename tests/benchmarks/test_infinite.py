"""The section of the report on infinite traces: its table and its goals."""

from __future__ import annotations

from typing import Any

from benchmarks import infinite
from benchmarks.store import Record


def records(states: int = 4, ms: float = 2.0) -> dict[str, Record]:
    """Records of two corpora with one formula each."""
    row: dict[str, Any] = {"formula": "F a", "states": states, "without": states - 1, "ms": ms, "spot_parity_states": 5}
    families = {**row, "rabinizer31_states": 6, "rabinizer31_wall_ms": 600.0}
    return {"families": {"rows": [families]}, "owl": {"rows": [{**row, "owl_states": 4}]}}


def test_goals_are_met_or_missed() -> None:
    assert list(infinite.goals({})) == [] and infinite.section({}) == ""
    assert [verdict for *_, verdict in infinite.goals(records())] == ["met", "met", "met"]
    assert [verdict for *_, verdict in infinite.goals(records(states=5))] == ["**missed**", "met", "met"]
    assert [verdict for *_, verdict in infinite.goals(records(ms=20.0))] == ["met", "met", "**missed**"]


def test_traps_are_counted_if_the_peer_counts_them() -> None:
    section = infinite.section(records())
    assert "| 1 | 4 | Spot, deterministic parity | 5 | 1 / 0 / 0 |" in section
    assert "| 1 | 3 | Owl, deterministic Rabin | 4 | 1 / 0 / 0 |" in section


def test_every_formula_of_the_table_can_be_compiled() -> None:
    lines = infinite.TABLE.read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 30 + 785
    record = infinite._made(dict(zip(lines[0].split("\t"), lines[1].split("\t"), strict=True)))
    assert (record["states"], record["spot_parity_states"], record["rabinizer31_states"]) == (4, 4, 4)
