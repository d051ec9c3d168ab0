"""Naming the policy of a training by the folder of the training."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.training.reports import a_report, an_episode
from tests.runtime.training.runs import run_in
from tltl_runtime.cli.support.policy_path import policy_path
from tltl_runtime.training.files.metrics import METRICS, metrics_line
from tltl_runtime.training.files.run_file import POLICY, write_run
from tltlc.diagnostics.diagnostic import TltlError


@pytest.fixture(name="here")
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder `training` with two trainings; its parent is the current folder."""
    monkeypatch.chdir(tmp_path)
    for name in ("one", "two words"):
        write_run(run_in(Path("training") / name))
    return Path("training")


def test_a_file_or_its_folder_names_a_policy(here: Path) -> None:
    file = here / "one" / POLICY
    file.touch()
    assert policy_path(here / "one") == policy_path(file) == file
    assert policy_path(Path("gone")) == Path("gone")


@pytest.mark.parametrize("command", ["evaluate", "inspect"])
def test_a_training_without_a_policy_is_reported(tltlc, here: Path, command: str) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc(command, "training/two words")
    assert (result.status, result.out) == (1, "")
    assert result.err == (
        "error[TLT0872]: the training in `training/two words` has no policy yet: its first iteration is not finished\n"
        "  help: `tltlc train --resume 'training/two words'` continues it until it has one; "
        "if it is running, it will have one soon\n"
    )
    fspa = run_in(here).fspa
    lines = [metrics_line(a_report(number, finished=(an_episode(True),) * number), fspa) for number in (1, 2)]
    # The last line is valid JSON, but has no measurements.
    text = "".join(json.dumps(line) + "\n" for line in [*lines, {"iteration": 3}])
    (here / "two words" / METRICS).write_text(text)
    assert "has no policy yet: after 8,192 steps, 3 episodes ended\n" in tltlc(command, "training/two words").err


def test_a_folder_of_trainings_lists_the_trainings(tltlc, here: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert tltlc("evaluate", "training").err == (
        "error[TLT0872]: `training` contains trainings, but is not a training itself\n"
        "  help: name one of them: `training/one`, `training/two words`\n"
    )
    for number in range(9):
        write_run(run_in(here / f"more-{number}"))
    with pytest.raises(TltlError) as caught:
        policy_path(here)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.help is not None and diagnostic.help.endswith("`training/more-7` and 3 more")


def test_a_folder_without_policies_and_trainings_is_reported(tltlc, here: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    Path("empty").mkdir()
    assert "there is neither a training nor a policy in `empty`" in tltlc("inspect", "empty").err


@pytest.mark.parametrize("words", [("evaluate",), ("inspect",), ("train", "--from"), ("train",)], ids=" ".join)
def test_a_similar_level_is_suggested(tltlc, here: Path, words: tuple[str, ...]) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result = tltlc(*words, "cover_and_hid:v1")
    assert result.err.startswith("error[TLT0001]: there is neither a file nor a level `cover_and_hid")
    assert "did you mean the level `cover_and_hide`?" in result.err
    assert result.status == 3


@pytest.mark.parametrize("path", ["training/navigation", "navigation.safetensors"])
def test_a_missing_path_is_not_taken_for_a_misspelt_level(tltlc, here: Path, path: str) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert tltlc("evaluate", path).err.startswith(f"error[TLT0001]: cannot read `{path}`: ")


def test_two_levels_are_rejected(tltlc, here: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result = tltlc("train", "cover_and_hide", "--level", "navigation")
    assert "`cover_and_hide` is a level, and so is `navigation`" in result.err
    assert result.status == 2


def test_a_level_file_is_not_a_policy(tltlc, here: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    Path("vault.toml").write_text("", encoding="utf-8")
    result = tltlc("evaluate", "vault.toml")
    assert result.err.startswith("error[TLT0840]: `vault.toml` is a TOML file, e.g. a level, not a policy")
