"""``tltlc table1``: the cells are played and cached, and the table is printed and written."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tltl_runtime.cli import table1
from tltl_runtime.regression.table1 import paper_table, table_cells
from tltl_runtime.regression.table1.paper_table import VARIANTS
from tltl_runtime.support.folder_lock import lock_folder
from tltl_runtime.training.files.settings import read_settings
from tltlc.diagnostics.diagnostic import Diagnostic

Run = Callable[..., Outcome]
LEVEL = "cover_and_hide"
ONE = ("--workers", "1")


@pytest.fixture(autouse=True)
def _small(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Restrict the table to one level and one episode in each cell."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(paper_table, "LEVELS", (LEVEL,))
    monkeypatch.setattr(table_cells, "EPISODES", 1)


def models(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    monkeypatch.setattr(paper_table, "MODELS", names)


def cells(folder: Path) -> dict[str, int]:
    """The modification time of each cell's file, in nanoseconds."""
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("*.json")}


@pytest.mark.slow
def test_the_expert_and_the_shipped_policies_fill_the_table(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "expert", "ours")
    result = tltlc("table1", "--shipped", *ONE)
    assert result.status == 0, result.err
    assert result.err.splitlines() == [
        f"{LEVEL}:{variant}, {model}" for model in ("expert", "ours") for variant in VARIANTS
    ]
    assert Path("table1/table1.md").read_text(encoding="utf-8") == result.out
    rows = [line for line in result.out.splitlines() if line.startswith(f"| {LEVEL} | ")]
    assert [row.split(" | ")[1] for row in rows] == ["expert", "ours"] * 2
    assert all(row.split(" | ")[2].startswith("1.00") for row in rows), "both meet their spec on v0"
    assert result.out.count("*the paper: human*") == result.out.count("*the paper: ours*") == 2
    before = cells(Path("table1"))
    assert set(before) == {f"{LEVEL}-{variant}-{model}.json" for variant in VARIANTS for model in ("expert", "ours")}

    # A second call plays only the missing cell.
    Path(f"table1/{LEVEL}-v1-ours.json").unlink()
    Path("table1/table1.md").unlink()
    again = tltlc("table1", "--shipped", *ONE)
    assert (again.status, again.out) == (0, result.out)
    after = cells(Path("table1"))
    assert {name for name in after if after[name] != before[name]} == {f"{LEVEL}-v1-ours.json"}
    assert Path("table1/table1.md").read_text(encoding="utf-8") == result.out


def test_a_folder_is_used_by_one_run_at_a_time(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "expert")
    with lock_folder(Path("mine"), Diagnostic("TLT0931", "busy"), ""):
        result = tltlc("table1", "--out", "mine", *ONE)
    assert (result.status, result.out) == (1, "")
    assert result.err == (
        "error[TLT0931]: another run of `tltlc table1` is using `mine`\n"
        "  help: wait until it ends, or name another folder with --out\n"
    )
    assert cells(Path("mine")) == {}


def test_the_folder_of_a_training_is_rejected_as_output(tltlc: Run) -> None:  # noqa: F811
    Path("mine").mkdir()
    Path("mine/run.json").touch()
    result = tltlc("table1", "--out", "mine", *ONE)
    assert (result.status, result.out) == (3, "")
    assert result.err.startswith("error[TLT0005]: cannot write into `mine`: it is the folder of a training\n")


def test_a_stopped_run_reports_the_command_that_resumes_it(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    def stopped(_: object) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(table1, "_table", stopped)
    again = "stopped: what is finished is kept in `{}`; to go on: tltlc table1 --out {}\n"
    result = tltlc("table1")
    assert (result.status, result.out, result.err) == (130, "", again.format("table1", "table1"))
    words = "mine --shipped --minutes 0.5 --workers 1"
    assert tltlc("table1", "--out", *words.split()).err == again.format("mine", words)


@pytest.mark.parametrize("minutes", ["nan", "inf", "-1"])
def test_an_invalid_limit_is_rejected(tltlc: Run, minutes: str) -> None:  # noqa: F811
    result = tltlc("table1", "--minutes", minutes, *ONE)
    assert result.status == 2 and "invalid value for '--minutes'" in result.err


def test_an_unfinished_training_is_reported(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "imitation")
    began: list[list[str]] = []
    monkeypatch.setattr(table1, "_train", began.append)
    result = tltlc("table1", "--minutes", "5", *ONE)
    ((*_, place, method, name, _, steps, minutes, limit),) = began
    assert (method, name, minutes, limit) == ("--method", "imitation", "--minutes", "5")
    assert int(steps) == read_settings().stop.steps
    assert (result.status, result.out) == (1, "")
    assert result.err == f"error[TLT0930]: the training in `{place}` did not finish\n  help: run the command again\n"


@pytest.mark.slow
def test_a_very_short_training_fills_its_cells(tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    models(monkeypatch, "imitation")
    result = tltlc("table1", "--minutes", "0.01", *ONE)
    assert result.status == 0, result.err
    (folder,) = Path("table1").glob(f"{LEVEL}-imitation-*")
    record = json.loads((folder / "record.json").read_text(encoding="utf-8"))
    assert (record["end"], record["settings"]["stop"]["minutes"]) == ("minutes", 0.01)
    # Its only update was a cloning update.
    assert record["imitated"]["cloned"] == record["steps"] > 0
    rows = [line for line in result.out.splitlines() if line.startswith(f"| {LEVEL} | imitation")]
    assert len(rows) == 2 and all(row.endswith("min, 100.0 % cloned |") for row in rows)

    monkeypatch.setattr(table1, "_train", lambda arguments: pytest.fail(f"it trains again: {arguments}"))
    Path(f"table1/{LEVEL}-v2-imitation.json").unlink()
    again = tltlc("table1", "--minutes", "0.01", *ONE)
    assert (again.status, again.out) == (0, result.out)
