"""Commands accept ``LEVEL:VARIANT+OVERLAY`` as a level."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import click
import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.evaluation.untrained import untrained
from tltl_runtime.cli.support.training_run import TrainOptions, new_run
from tltl_runtime.policies.file import write_policy
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.training.files.run_file import read_run, write_run

Run = Callable[..., Outcome]
LEVEL = "cover_and_hide:v0+guard_alert+edits/wide.toml"
WIDE = 'doc = "The guard sees further."\n[change.guard]\nsight_range = 12.5\n'
BRIEF = "import stealth\nspec brief { limit 3 steps\n keep alive }\n"


@pytest.fixture(autouse=True)
def _inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "edits").mkdir()
    (tmp_path / "edits" / "wide.toml").write_text(WIDE, encoding="utf-8")
    (tmp_path / "brief.tltl").write_text(BRIEF, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


def test_check_accepts_overlays(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("check", "--level", LEVEL)
    assert result.status == 0, result.err
    assert f"{LEVEL} supplies" in result.err


def test_check_suggests_an_overlay_for_a_misspelt_one(tltlc: Run) -> None:  # noqa: F811
    missing = tltlc("check", "--level", "cover_and_hide:v0+edits/wider.toml")
    assert missing.status == 3 and "did you mean `edits/wide.toml`?" in missing.err


@pytest.mark.parametrize("command", ["demonstrate", "record"])
def test_demonstrate_and_record_accept_overlays(tltlc: Run, command: str) -> None:  # noqa: F811
    result = tltlc(command, LEVEL, "--spec", "brief.tltl", "--episodes", "1", "--out", "runs")
    assert result.status == 0, result.err
    (path,) = Path("runs").glob("*.episode.npz")
    assert path.name.startswith("cover_and_hide-v0+guard_alert+wide-0")
    assert read_episode(path).level.enemies[0].kind.sight_range == 12.5
    if command == "record":
        assert f" --level {LEVEL} " in result.out


def test_evaluate_accepts_overlays(tltlc: Run) -> None:  # noqa: F811
    write_policy(Path("policy.safetensors"), untrained())
    result = tltlc(
        "evaluate", "policy.safetensors", "--level", LEVEL, "--episodes", "1", "--out", "runs", "--json", "-"
    )
    assert result.status == 0, result.err
    report = json.loads(result.out)
    assert (report["level"], report["variant"]) == ("cover_and_hide", "v0+guard_alert+wide")
    assert len(list(Path("runs").glob("cover_and_hide-v0+guard_alert+wide-0-0-*.episode.npz"))) == 2


def test_a_level_with_overlays_uses_the_shipped_policy_of_the_level(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("evaluate", "cover_and_hide:v0+guard_alert", "--episodes", "1", "--json", "-")
    report = json.loads(result.out)
    assert (report["variant"], report["policy"]["level"]) == ("v0+guard_alert", "cover_and_hide")


def test_train_accepts_overlays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    options = TrainOptions("brief.tltl", LEVEL, None, None, None, None, None, None, {})
    with click.Context(click.Command("train")):
        run = new_run(options, None)
    assert run.folder == Path("training/cover_and_hide-v0+guard_alert+wide-brief-0")
    write_run(run)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    again = read_run(tmp_path / run.folder)
    assert load_level(again.level, again.variant).enemies[0].kind.sight_range == 12.5
