"""``tltlc train --method imitation``: from demonstrations to evaluation."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.test_train import SMALL
from tests.runtime.training.imitating import SOON, recorded_episode, write_recordings
from tests.waiting import until
from tltl_runtime.training.run.checkpoint import read_checkpoint
from tltl_runtime.training.run.metrics import METRICS, read_metrics
from tltl_runtime.training.run.settings import read_settings

TltlcFunction = Callable[..., Outcome]

IMITATION = SMALL + "\n[imitation]\ndemonstrations = 2\ncloning = 0.5\n"
ENDLESS = IMITATION.replace("steps = 128", "steps = 1_000_000").replace("episodes = 2", "episodes = 100_000")
"""Settings with which a training does not end by itself."""
VAIN = "import spatial\nentity exit\nspec vain { level cover_and_hide\n limit 8 steps\n reach near(exit) }\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which contains only small settings and two specs."""
    (tmp_path / "small.toml").write_text(IMITATION)
    (tmp_path / "soon.tltl").write_text(SOON)
    (tmp_path / "vain.tltl").write_text(VAIN)
    monkeypatch.chdir(tmp_path)
    return tmp_path


TRAIN_IMITATION = ("train", "soon.tltl", "--method", "imitation", "--config", "small.toml")


def test_a_training_records_the_expert_and_can_be_evaluated(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc(*TRAIN_IMITATION)
    folder = here / "training" / "cover_and_hide-v0-soon-0-imitation"
    assert result.status == 0, result.err
    lines = result.err.splitlines()
    assert lines[0].endswith(f"on cover_and_hide v0 by imitation, seed 0, in {folder.relative_to(here)}")
    assert lines[1] == "recording the expert: 1 of 2 demonstrations, the episode of seed 0 is kept"
    assert lines[2] == "recording the expert: 2 of 2 demonstrations, the episode of seed 1 is kept"
    assert lines[3] == "imitating 2 demonstrations of 16 decisions, by expert"
    record = json.loads((folder / "record.json").read_text())
    expected = {"episodes": 2, "decisions": 16, "players": ["expert"], "left_out": [], "cloned": 64}
    assert record["imitated"] == expected
    assert tltlc("evaluate", folder, "--episodes", "2").status == 0
    assert "spec was met" in tltlc("inspect", folder).out


def test_named_demonstrations_are_imitated_and_needed_on_resume(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    write_recordings(here / "mine", recorded_episode(1), recorded_episode(2), recorded_episode(3, steps=5))
    (here / "small.toml").write_text(ENDLESS)
    result = tltlc(*TRAIN_IMITATION, "--demonstrations", "mine", "--out", "run", "--steps", "64")
    assert "; 1 recording left out: cover_and_hide-v0-3.episode.npz: it does not meet `soon`" in result.err
    assert not (here / "run" / "demonstrations").exists()
    (here / "mine").rename(here / "moved")
    missing = tltlc("train", "--resume", "run", "--steps", "192")
    assert (missing.status, missing.out) == (1, "")
    assert (
        "error[TLT0922]: the demonstrations are others than those that the training in `run` began with" in missing.err
    )
    resumed = tltlc("train", "--resume", "run", "--steps", "192", "--demonstrations", "moved")
    assert "TLT" not in resumed.err
    assert [line["steps"] for line in read_metrics(here / "run" / METRICS)] == [64, 128, 192]


def test_a_killed_training_resumes_from_its_checkpoint(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    write_recordings(here / "mine", recorded_episode(1))
    (here / "small.toml").write_text(f"checkpoint_s = 0.0\n{ENDLESS}")
    command = [sys.executable, "-m", "tltlc", *TRAIN_IMITATION, "--demonstrations", "mine", "--out", "run"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as training:
        until(lambda: training.poll() is None and len(read_metrics(here / "run" / METRICS)) >= 3, "3 iterations", 0.1)
        training.send_signal(signal.SIGKILL)
    checkpoint = read_checkpoint(here / "run" / "checkpoint.pt")
    assert checkpoint is not None
    steps = str(checkpoint.steps + 128)
    resumed = tltlc("train", "--resume", "run", "--steps", steps)
    assert f"ended by the limit of steps after {steps} steps" in resumed.out, resumed.err
    numbers = [line["iteration"] for line in read_metrics(here / "run" / METRICS)]
    assert numbers == list(range(1, len(numbers) + 1))


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["soon.tltl", "--demonstrations", "mine"], 2, "--demonstrations are for --method imitation"),
        ([*TRAIN_IMITATION[1:], "--demonstrations", "nowhere"], 1, "TLT0921"),
        (["soon.tltl", "--method", "magic"], 2, "--method"),
    ],
)
def test_invalid_options_are_rejected(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    said: str,
) -> None:
    result = tltlc("train", *arguments)
    assert (result.status, result.out) == (status, "")
    assert said in result.err
    assert not (here / "training").exists()


def test_a_spec_that_the_expert_does_not_meet_is_rejected(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc("train", "vain.tltl", "--method", "imitation", "--config", "small.toml", "--out", "run")
    assert result.status == 1
    assert "recording the expert: 0 of 2 demonstrations, the episode of seed 0 fails, and is not kept" in result.err
    assert "error[TLT0920]" in result.err


def test_the_method_is_stored_in_the_settings(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    printed = tltlc("train", "--method", "imitation", "--print-config").out
    (here / "printed.toml").write_text(printed)
    settings = read_settings(here / "printed.toml")
    assert settings.imitates and not settings.searches
    write_recordings(here / "mine", recorded_episode(1))
    named = ("--demonstrations", "mine", "--steps", "64", "--out", "run")
    tltlc("train", "soon.tltl", "--config", "small.toml", "--method", "imitation", *named)
    other = tltlc("train", "--resume", "run", "--method", "automaton", "--steps", "128")
    assert "error[TLT0870]: the training in `run` is by the method `imitation`, not by `automaton`" in other.err
