"""The figures of the report, computed from records."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from benchmarks import summary
from benchmarks.ltlf2dfa_peer import notation
from benchmarks.reference import Reference, references
from benchmarks.report import render
from benchmarks.store import Record, Store
from tests.reference_formulas import read_formula

REFERENCES = [
    Reference("one", "f", "F a", 2, spot_ms=0.3, mona_ms=9.0),
    Reference("two", "f", "F b", 2, spot_ms=0.6, mona_ms=None),
    Reference("three", "g", "G b", 2, spot_ms=None, mona_ms=5.0),
]
RECORDS: dict[str, Record] = {
    "one": {
        "family": "f",
        "states_expected": 2,
        "minimal_ms": 0.1,
        "guarded_ms": 0.2,
        "build_ms": 1.0,
        "build_mb": 9.0,
        "states": 2,
        "mona_ms": 3.0,
        "mona_states": 2,
        "ltlf2dfa_ms": 50.0,
        "ltlf2dfa_states": 2,
    },
    "two": {
        "family": "f",
        "states_expected": 2,
        "minimal_ms": 0.4,
        "build_ms": 9000.0,
        "build_mb": 9.0,
        "states": 3,
        "mona_failed": "over 20 s",
        "ltlf2dfa_failed": "over 20 s",
    },
    "three": {
        "family": "g",
        "states_expected": 700,
        "minimal_ms": 1.0,
        "build_failed": "TLT0501",
        "mona_ms": 1.0,
        "mona_states": 700,
        "ltlf2dfa_failed": "left out",
    },
}


def test_the_time_of_spot_is_estimated_by_the_factor_of_mona() -> None:
    estimates = summary.spot_estimates(RECORDS, REFERENCES)
    # The factors are 3/9 and 1/5; their median is 4/15.
    assert estimates == pytest.approx({"one": 0.1, "two": 0.6 * 4 / 15})


def test_a_family_is_summarized() -> None:
    row, other = summary.families(RECORDS, REFERENCES, timeout_s=20)
    assert (row.name, row.formulas, row.ltlf2dfa_solved, row.ltlf2dfa_tried) == ("f", 2, 1, 2)
    assert row.minimal_ms == pytest.approx(0.25)
    assert row.to_spot == pytest.approx(0.25 / 0.13)
    # Compared with `minimal`, LTLf2DFA takes 500 times as long on one formula, and at least 50,000 times on
    # the other. Compared with `build`, it takes 50 times as long, and at least 2.2 times.
    assert str(row.ltlf2dfa_over_minimal) == "500"
    assert str(row.ltlf2dfa_over_build) == "≥ 2"
    assert other.ltlf2dfa_over_minimal is None and other.ltlf2dfa_tried == 0
    assert math.isnan(other.to_spot)


def test_formulas_that_missed_a_goal_are_listed() -> None:
    assert summary.unsolved(RECORDS) == ["two"]
    assert summary.wrong_sizes(RECORDS) == ["two"]


def test_a_report_of_partial_results_renders(tmp_path: Path) -> None:
    store = Store(tmp_path / "results.json")
    store.put("machine", "facts", {"processor": "abacus"})
    store.put("machine", "options", {"peer_timeout_s": 20.0})
    first = references()[0]
    store.put("compile", first.name, RECORDS["one"] | {"family": first.family, "source": "x"})
    text = render(Store(tmp_path / "results.json"))
    assert "| processor | abacus |" in text
    assert f"| {first.family} | 1 | 0.10 | 0.20 | 1.00 | 3.00 |" in text
    assert "nan" not in text


def test_the_batched_monitor_has_its_goals_and_table(tmp_path: Path) -> None:
    store = Store(tmp_path / "results.json")
    store.put("machine", "facts", {"processor": "abacus"})
    store.put("machine", "options", {"peer_timeout_s": 20.0})
    assert "Many automata" not in render(store)
    rates = {"steps_per_s": {"batch": 12_000_000, "scalar": 60_000}, "batch_to_scalar": [190.0, 200.0, 210.0]}
    store.put("batch", "cover_and_hide", rates | {"count": 4096, "source": "x"})
    store.put("batch", "navigation", {"left_out": "torch is not installed"})
    text = render(store)
    assert "| 12.0 million on cover_and_hide | met |" in text
    assert "| cover_and_hide | 12,000,000 | 60,000 | 200.0 (190.0–210.0) | – |" in text
    gpu = {"gpu": "abacus", "gpu_count": 1_000_000, "gpu_ms": [1.0, 1.25, 1.5]}
    store.put("batch", "cover_and_hide", rates | gpu | {"count": 4096})
    assert "| 1.25 ms on cover_and_hide | **missed** |" in render(store)


def test_a_store_discards_one_section_or_all(tmp_path: Path) -> None:
    store = Store(tmp_path / "results.json")
    for section in ("compile", "game"):
        store.put(section, "one", {"x": 1})
    store.discard("game")
    assert store.section("game") == {}
    assert store.section("compile") == Store(tmp_path / "results.json").section("compile") == {"one": {"x": 1}}
    store.discard(None)
    assert store.section("compile") == {}


def test_the_reference_table_is_readable() -> None:
    rows = {row.name: row for row in references()}
    assert rows["seq1"].states == 3 and rows["seq1"].mona_ms == 8.8
    assert rows["branch5"].states is None and rows["branch5"].mona_ms is None
    for row in rows.values():
        read_formula(row.formula)


@pytest.mark.parametrize(
    ("text", "renamed"),
    [
        ("F(a & X (b U c)) -> G !a", "F(p0 & X (p1 U p2)) -> G !p0"),
        ("WX a <-> (b R a)", "WX p0 <-> (p1 R p0)"),
        ("true & (a | b | c)", "true & (p0 | p1 | p2)"),
    ],
)
def test_the_notation_of_ltlf2dfa_is_the_same_formula(text: str, renamed: str) -> None:
    assert read_formula(notation(read_formula(text))) is read_formula(renamed)
