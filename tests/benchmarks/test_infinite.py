"""The section of the report on infinite traces: its table and its goals."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import infinite
from benchmarks.store import Record

PEERS = (
    ("corpus", "formula", "spot_parity_states", "owl_states", "rabinizer31_states", "rabinizer31_wall_ms"),
    ("families", "F a", "5", "", "6", "600"),
    ("owl", "F a", "5", "4", "", ""),
)


@pytest.fixture
def small_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A table of two corpora with one formula each."""
    table = tmp_path / "infinite.tsv"
    table.write_text("".join("\t".join(row) + "\n" for row in PEERS), encoding="utf-8")
    monkeypatch.setattr(infinite, "TABLE", table)


def records(states: int = 4, ms: float = 2.0) -> dict[str, Record]:
    """Records of two corpora with one formula each."""
    record: Record = {"states": [states], "without": [states - 1], "ms": [ms]}
    return {"families": record, "owl": record}


@pytest.mark.usefixtures("small_table")
def test_goals_are_met_or_missed() -> None:
    assert list(infinite.goals({})) == [] and infinite.section({}) == ""
    assert [verdict for *_, verdict in infinite.goals(records())] == ["met", "met", "met"]
    assert [verdict for *_, verdict in infinite.goals(records(states=5))] == ["**missed**", "met", "met"]
    assert [verdict for *_, verdict in infinite.goals(records(ms=20.0))] == ["met", "met", "**missed**"]


@pytest.mark.usefixtures("small_table")
def test_traps_are_counted_if_the_peer_counts_them() -> None:
    section = infinite.section(records())
    assert "| 1 | 4 | Spot, deterministic parity | 5 | 1 / 0 / 0 |" in section
    assert "| 1 | 3 | Owl, deterministic Rabin | 4 | 1 / 0 / 0 |" in section


def test_every_formula_of_the_table_can_be_compiled() -> None:
    lines = infinite.TABLE.read_text(encoding="utf-8").splitlines()
    assert len(lines) == 1 + 30 + 785
    row = infinite._table_rows("families")[0]
    assert infinite._automaton_figures(row["formula"])["states"] == 4
    assert (row["spot_parity_states"], row["rabinizer31_states"]) == ("4", "4")


def test_the_table_must_have_the_formulas_that_were_measured() -> None:
    with pytest.raises(ValueError, match="longer"):
        infinite.section(records())
