"""``tltlc table1``: the cells are played and kept, and the table is printed and written."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tltl_runtime.cli import table1
from tltl_runtime.regression.table1 import paper_table, table_cells
from tltl_runtime.regression.table1.paper_table import VARIANTS
from tltl_runtime.support.folder_lock import held
from tltl_runtime.training.run.settings import read_settings
from tltlc.diagnostics.diagnostic import Diagnostic

Run = Callable[..., Outcome]
LEVEL = "cover_and_hide"
ONE = ("--workers", "1")


@pytest.fixture(autouse=True)
def _small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One level, and few episodes."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(paper_table, "LEVELS", (LEVEL,))
    monkeypatch.setattr(table_cells, "EPISODES", 2)


def models(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    monkeypatch.setattr(paper_table, "MODELS", names)


def cells(folder: Path) -> dict[str, int]:
    """When each cell was written."""
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("*.json")}


def test_the_expert_and_the_shipped_policies(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "expert", "ours")
    found = tltlc("table1", "--shipped", *ONE)
    assert found.status == 0, found.err
    assert found.err.splitlines() == [f"{LEVEL}:{each}, {model}" for model in ("expert", "ours") for each in VARIANTS]
    assert Path("table1/table1.md").read_text(encoding="utf-8") == found.out
    rows = [line for line in found.out.splitlines() if line.startswith(f"| {LEVEL} | ")]
    assert [row.split(" | ")[1] for row in rows] == ["expert", "ours"] * 2
    assert all(row.split(" | ")[2].startswith("1.00") for row in rows), "both meet their spec on v0"
    assert found.out.count("*the paper: human*") == found.out.count("*the paper: ours*") == 2
    before = cells(Path("table1"))
    assert set(before) == {f"{LEVEL}-{each}-{model}.json" for each in VARIANTS for model in ("expert", "ours")}

    # Called again it plays what is missing, and nothing else.
    Path(f"table1/{LEVEL}-v1-expert.json").unlink()
    Path("table1/table1.md").unlink()
    again = tltlc("table1", "--shipped", *ONE)
    assert (again.status, again.out) == (0, found.out)
    after = cells(Path("table1"))
    assert {name for name in after if after[name] != before[name]} == {f"{LEVEL}-v1-expert.json"}
    assert Path("table1/table1.md").read_text(encoding="utf-8") == found.out


def test_a_folder_is_one_runs(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "expert")
    with held(Path("mine"), Diagnostic("TLT0931", "busy"), ""):
        found = tltlc("table1", "--out", "mine", *ONE)
    assert (found.status, found.out) == (1, "")
    assert found.err == (
        "error[TLT0931]: another run of `tltlc table1` is at work in `mine`\n"
        "  help: wait for its end, or name another folder with --out\n"
    )
    assert cells(Path("mine")) == {}


def test_the_folder_of_a_training_is_none_for_a_table(tltlc: Run) -> None:  # noqa: F811
    Path("mine").mkdir()
    Path("mine/run.json").touch()
    found = tltlc("table1", "--out", "mine", *ONE)
    assert (found.status, found.out) == (3, "")
    assert found.err.startswith("error[TLT0005]: cannot write into `mine`: it is the folder of a training\n")


def test_asked_to_end_it_says_how_to_go_on(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    def stopped(_: object) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(table1, "_table", stopped)
    again = "stopped: what is over is kept in `{}`; to go on: tltlc table1 --out {}\n"
    found = tltlc("table1")
    assert (found.status, found.out, found.err) == (130, "", again.format("table1", "table1"))
    words = "mine --shipped --minutes 0.5 --workers 1"
    assert tltlc("table1", "--out", *words.split()).err == again.format("mine", words)


@pytest.mark.parametrize("minutes", ["nan", "inf", "-1"])
def test_a_limit_is_a_number(tltlc: Run, minutes: str) -> None:  # noqa: F811
    found = tltlc("table1", "--minutes", minutes, *ONE)
    assert found.status == 2 and "invalid value for '--minutes'" in found.err


def test_a_training_that_did_not_end_is_told(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "imitation")
    began: list[list[str]] = []
    monkeypatch.setattr(table1, "_train", began.append)
    found = tltlc("table1", "--minutes", "5", *ONE)
    ((*_, place, method, name, _, steps, minutes, limit),) = began
    assert (method, name, minutes, limit) == ("--method", "imitation", "--minutes", "5")
    assert int(steps) == read_settings().stop.steps
    assert (found.status, found.out) == (1, "")
    assert found.err == f"error[TLT0930]: the training in `{place}` did not end\n  help: run the command again\n"


@pytest.mark.slow
def test_a_training_of_moments(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "imitation")
    found = tltlc("table1", "--minutes", "0.01", *ONE)
    assert found.status == 0, found.err
    (folder,) = Path("table1").glob(f"{LEVEL}-imitation-*")
    made = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    assert (made["end"], made["settings"]["stop"]["minutes"]) == ("minutes", 0.01)
    # Its only update cloned it.
    assert made["imitated"]["cloned"] == made["steps"] > 0
    rows = [line for line in found.out.splitlines() if line.startswith(f"| {LEVEL} | imitation")]
    assert len(rows) == 2 and all(row.endswith("min, 100.0 % cloned |") for row in rows)

    monkeypatch.setattr(table1, "_train", lambda arguments: pytest.fail(f"it trains again: {arguments}"))
    Path(f"table1/{LEVEL}-v2-imitation.json").unlink()
    again = tltlc("table1", "--minutes", "0.01", *ONE)
    assert (again.status, again.out) == (0, found.out)
