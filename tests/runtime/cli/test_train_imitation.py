"""``tltlc train --method imitation``: from demonstrations to evaluation."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.signals import interrupted  # noqa: F401
from tests.runtime.cli.small_training import SMALL
from tests.runtime.training.imitating import SOON, recorded_episode, write_recordings
from tests.waiting import until
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.settings import read_settings
from tltl_runtime.training.runner import Iteration, Runner

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
    assert lines[0].endswith(f"on cover_and_hide:v0 by imitation, seed 0, in {folder.relative_to(here)}")
    assert lines[1] == "it ends when the spec is met, at the latest after 128 steps"
    lines = [line for line in lines if line.startswith(("recording", "imitating"))]
    assert lines[0] == "recording the expert: 1 of 2 demonstrations, the episode of seed 0 is kept"
    assert lines[1] == "recording the expert: 2 of 2 demonstrations, the episode of seed 1 is kept"
    assert lines[2] == "imitating 2 demonstrations of 16 decisions, by expert"
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
    assert "error[TLT0922]: the demonstrations are not those that the training in `run` began with" in missing.err
    resumed = tltlc("train", "--resume", "run", "--steps", "192", "--demonstrations", "moved")
    assert "TLT" not in resumed.err
    assert [line["steps"] for line in read_metrics(here / "run" / METRICS)] == [64, 128, 192]


def test_a_killed_training_resumes_from_its_checkpoint(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    iterations = Runner.iterations

    def with_a_copy(runner: Runner) -> Iterator[Iteration]:
        for iteration in iterations(runner):
            if iteration.number == 3:
                # The files that a training leaves if it is killed now.
                shutil.copytree(here / "run", here / "killed")
            yield iteration

    command = _endless(here)
    with monkeypatch.context() as patch:
        patch.setattr(Runner, "iterations", with_a_copy)
        assert tltlc(*command, "--steps", "192").status == 1
    shutil.rmtree(here / "run")
    (here / "killed").rename(here / "run")
    assert len(read_metrics(here / "run" / METRICS)) == 2
    _check_resumed(tltlc, here / "run")


@pytest.mark.slow
def test_a_training_whose_process_was_killed_resumes(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    command = [sys.executable, "-m", "tltlc", *_endless(here)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as training:
        until(lambda: training.poll() is None and len(read_metrics(here / "run" / METRICS)) >= 3, "3 iterations", 0.1)
        training.send_signal(signal.SIGKILL)
    _check_resumed(tltlc, here / "run")


def _endless(folder: Path) -> tuple[str, ...]:
    """Write settings without an end and with a checkpoint after each iteration; return the command."""
    write_recordings(folder / "mine", recorded_episode(1))
    (folder / "small.toml").write_text(f"checkpoint_s = 0.0\n{ENDLESS}")
    return *TRAIN_IMITATION, "--demonstrations", "mine", "--out", "run"


def _check_resumed(tltlc: TltlcFunction, run: Path) -> None:  # noqa: F811
    """Resume a training for two iterations after its checkpoint."""
    checkpoint = read_checkpoint(run / "checkpoint.pt")
    assert checkpoint is not None
    steps = str(checkpoint.steps + 128)
    resumed = tltlc("train", "--resume", "run", "--steps", steps)
    assert f"ended by the limit of steps after {steps} steps" in resumed.out, resumed.err
    numbers = [line["iteration"] for line in read_metrics(run / METRICS)]
    assert numbers == list(range(1, len(numbers) + 1))


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["soon.tltl", "--demonstrations", "mine"], 2, "--demonstrations works only with --method imitation"),
        ([*TRAIN_IMITATION[1:], "--demonstrations", "nowhere"], 1, "TLT0921"),
        (["soon.tltl", "--method", "magic"], 2, "--method"),
    ],
)
def test_invalid_options_are_rejected(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    message: str,
) -> None:
    result = tltlc("train", *arguments)
    assert (result.status, result.out) == (status, "")
    assert message in result.err
    assert not (here / "training").exists()


def test_a_spec_that_the_expert_does_not_meet_is_rejected(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc("train", "vain.tltl", "--method", "imitation", "--config", "small.toml", "--out", "run")
    assert result.status == 1
    assert "recording the expert: 0 of 2 demonstrations, the episode of seed 0 fails and is not kept" in result.err
    assert "error[TLT0920]" in result.err


def test_the_method_is_stored_in_the_settings(
    tltlc: TltlcFunction,  # noqa: F811
    interrupted: TltlcFunction,  # noqa: F811
    here: Path,
) -> None:
    printed = tltlc("train", "--method", "imitation", "--print-config").out
    (here / "printed.toml").write_text(printed)
    settings = read_settings(here / "printed.toml")
    assert settings.imitates and not settings.searches
    write_recordings(here / "mine", recorded_episode(1))
    interrupted(*TRAIN_IMITATION[1:], "--demonstrations", "mine", "--out", "run")
    other = tltlc("train", "--resume", "run", "--method", "automaton", "--steps", "128")
    assert "error[TLT0870]: the training in `run` uses the method `imitation`, not `automaton`" in other.err
