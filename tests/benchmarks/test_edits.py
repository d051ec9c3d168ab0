"""Random edits of levels: their kinds, their ground truth, and the report of the verdicts on them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from benchmarks import edits, edits_report
from benchmarks.random_edits import EDIT_REQUESTS, HARMLESS, Edit, EditRequest, random_edits
from benchmarks.store import Record, Store, source_digest


@pytest.fixture(scope="module")
def made_edits() -> tuple[Edit, ...]:
    pytest.importorskip("pybullet")
    return all_edits(15)


def all_edits(seed: int) -> tuple[Edit, ...]:
    return random_edits(seed, edits._assets({request.asset for request in EDIT_REQUESTS}), edits._loads)


def load_edited_level(edit: Edit, tmp_path: Path) -> Any:
    from tltl_runtime.stealth.levels.file import load_level

    path = tmp_path / "edit.toml"
    path.write_text(edit.overlay, encoding="utf-8")
    return load_level(edit.level, f"v0+{path}")


def test_thirty_edits_cover_all_levels_and_many_are_harmless(made_edits: tuple[Edit, ...]) -> None:
    assert [edit.number for edit in made_edits] == list(range(1, 31))
    assert {edit.level for edit in made_edits} == {"branching", "cover_and_hide", "navigation"}
    assert len([edit for edit in made_edits if edit.kind in HARMLESS]) >= 10
    assert all_edits(15) == made_edits
    assert all_edits(16) != made_edits


@pytest.mark.parametrize("number", range(1, 31))
def test_each_edit_loads_and_changes_what_its_kind_says(
    made_edits: tuple[Edit, ...], number: int, tmp_path: Path
) -> None:
    from tltl_runtime.stealth.levels.file import load_level

    edit = made_edits[number - 1]
    now, before = load_edited_level(edit, tmp_path), load_level(edit.level)
    known = {solid.name: solid for solid in before.solids}
    solids = [(new, known[new.name]) for new in now.solids if new.name in known and new != known[new.name]]
    differs = [name for name in ("solids", "enemies", "movers") if getattr(now, name) != getattr(before, name)]
    assert len(differs) == (edit.kind != "words")
    if edit.kind == "hair" and solids:
        for new, old in solids:
            assert max(abs(a - b) for a, b in zip(new.box.low, old.box.low, strict=True)) < 0.001
    if edit.kind == "top":
        assert all(new.box.low == old.box.low and new.box.high[2] > old.box.high[2] >= 2.0 for new, old in solids)
    if edit.kind == "behind":
        assert len(now.solids) == len(before.solids) + 1
        assert solids == []
    if edit.kind == "shut":
        (new, _), *_ = solids
        assert new.box.high[1] - new.box.low[1] > 3.6
        assert new.box.high[2] - new.box.low[2] >= 1.8


def test_an_edit_that_does_not_load_is_drawn_again() -> None:
    pytest.importorskip("pybullet")
    tried: list[str] = []

    def loads(level: str, overlay: str) -> bool:
        tried.append(overlay)
        return len(tried) > 2

    wanted = (EditRequest("navigation", "corridor", "hair"),)
    assets = edits._assets({"corridor"})
    (edit,) = random_edits(1, assets, loads, wanted)
    assert edit.overlay == tried[2] not in tried[:2]
    with pytest.raises(ValueError, match="no edit of the kind hair of corridor loads in navigation"):
        random_edits(1, assets, lambda *_: False, wanted)


def verdict_record(truth: str, verdict: str, **others: object) -> Record:
    rates = {"pass_rate": 0.96, "progress": 0.98, "reward": 0.7}
    return {
        "doc": "A block moves.",
        "truth": truth,
        "expert": {"episodes": 25, "successes": 24, "same": 3},
        "verdict": verdict,
        "certain": True,
        "episodes": 50,
        "same": 7,
        "now": rates,
        "before": {**rates, "reward": 0.75},
        **others,
    }


def test_the_goals_count_missed_infeasible_edits_and_false_alarms() -> None:
    records = {
        "expert navigation": {"ways": ["a"] * 25, "successes": 25},
        "01 a": verdict_record("infeasible", "fail"),
        "02 b": verdict_record("in part", "review", certain=False),
        "03 c": verdict_record("changed", "fail"),
        "04 d": verdict_record("unchanged", "pass"),
    }
    assert [row[1:] for row in edits_report.goals(records)] == [("0 of 2", "met"), ("0 of 1", "met")]
    bad = {**records, "05 e": verdict_record("in part", "pass"), "06 f": verdict_record("unchanged", "review")}
    missed = [("1 of 3: 05 e", "**missed**"), ("1 of 2: 06 f", "**missed**")]
    assert [row[1:] for row in edits_report.goals(bad)] == missed
    many = {f"{number} g": verdict_record("unchanged", "pass" if number else "fail") for number in range(20)}
    assert [row[1:] for row in edits_report.goals(many)] == [("1 of 20: 0 g", "met")]
    text = edits_report.section({**records, "07 h": {"failed": "it cannot be played"}})
    assert "for 25 of 25 in navigation before" in " ".join(text.split())
    assert "| infeasible | 0 | 0 | 1 |" in text
    assert "a `pass` of an infeasible one, seen in 0 of 2, may have a probability of up to 78%; a finding" in text
    assert "So few" not in edits_report.section(bad)
    row = "| A block moves. | in part | 24 of 25 | 3 | `review` * | 48 of 50 | 7 | 0.98 (0.98) | 0.70 (0.75) |"
    assert f"| 02 b {row}" in text
    assert text.endswith("Failed: 07 h (it cannot be played).")
    assert edits_report.section({"expert navigation": records["expert navigation"]}) == ""


@pytest.mark.slow
def test_a_quick_run_has_the_ground_truth_and_is_resumed(tmp_path: Path) -> None:
    for package in edits.NEEDED:
        pytest.importorskip(package)
    store, messages = Store(tmp_path / "results.json"), list[str]()
    for _ in range(2):
        edits.measure(store, 0.0, messages.append, edits.QUICK, tmp_path / "edits")
    words, shut = "01 navigation corridor words", "02 navigation corridor shut"
    assert [line.partition(":")[0] for line in messages] == ["expert navigation", words, shut]
    assert [path.name for path in (tmp_path / "edits").iterdir()] == [source_digest(*edits.SOURCES)]
    records = store.section(edits.SECTION)
    assert records[words]["truth"] == "unchanged"
    assert records[words]["same"] == records[words]["episodes"] == 25
    assert records[words]["now"] == records[words]["before"]
    assert records[shut]["truth"] == "infeasible"
    assert records[shut]["expert"] == {"episodes": 1, "successes": 0, "same": 0}
    assert records[shut]["verdict"] == "fail"
    # A suite is never certain that a policy passes after so few episodes.
    assert (records[words]["verdict"], records[words]["certain"]) == ("review", False)
