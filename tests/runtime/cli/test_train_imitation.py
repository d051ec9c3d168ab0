"""``tltlc train --method imitation``: from its demonstrations to its evaluation."""

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
from tests.runtime.training.imitating import SOON, kept, played
from tests.waiting import until
from tltl_runtime.training.run.checkpoint import read_checkpoint
from tltl_runtime.training.run.metrics import METRICS, read_metrics
from tltl_runtime.training.run.settings import read_settings

TltlcFunction = Callable[..., Outcome]

IMITATION = SMALL + "\n[imitation]\ndemonstrations = 2\ncloning = 0.5\n"
ENDLESS = IMITATION.replace("steps = 128", "steps = 1_000_000").replace("episodes = 2", "episodes = 100_000")
"""Settings by which a training does not end by itself."""
VAIN = "import spatial\nentity exit\nspec vain { level cover_and_hide\n limit 8 steps\n reach near(exit) }\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder but for small settings and two specs, made the current one."""
    (tmp_path / "small.toml").write_text(IMITATION)
    (tmp_path / "soon.tltl").write_text(SOON)
    (tmp_path / "vain.tltl").write_text(VAIN)
    monkeypatch.chdir(tmp_path)
    return tmp_path


BEGUN = ("train", "soon.tltl", "--method", "imitation", "--config", "small.toml")


def test_from_the_experts_demonstrations_to_the_evaluation(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    found = tltlc(*BEGUN)
    folder = here / "training" / "cover_and_hide-v0-soon-0-imitation"
    assert found.status == 0, found.err
    said = found.err.splitlines()
    assert said[0].endswith(f"on cover_and_hide v0 by imitation, seed 0, in {folder.relative_to(here)}")
    assert said[1] == "recording the expert: 1 of 2 demonstrations, the episode of seed 0 is kept"
    assert said[2] == "recording the expert: 2 of 2 demonstrations, the episode of seed 1 is kept"
    assert said[3] == "imitating 2 demonstrations of 16 decisions, by expert"
    record = json.loads((folder / "record.json").read_text())
    told = {"episodes": 2, "decisions": 16, "players": ["expert"], "left_out": [], "cloned": 64}
    assert record["imitated"] == told
    assert tltlc("evaluate", folder, "--episodes", "2").status == 0
    assert "spec was met" in tltlc("inspect", folder).out


def test_named_demonstrations_and_going_on(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    kept(here / "mine", played(1), played(2), played(3, steps=5))
    (here / "small.toml").write_text(ENDLESS)
    found = tltlc(*BEGUN, "--demonstrations", "mine", "--out", "run", "--steps", "64")
    assert "; 1 recording left out: cover_and_hide-v0-3.episode.npz: it does not meet `soon`" in found.err
    assert not (here / "run" / "demonstrations").exists()
    (here / "mine").rename(here / "moved")
    gone = tltlc("train", "--resume", "run", "--steps", "192")
    assert (gone.status, gone.out) == (1, "")
    assert "error[TLT0922]: the demonstrations are others than those that the training in `run` began with" in gone.err
    on = tltlc("train", "--resume", "run", "--steps", "192", "--demonstrations", "moved")
    assert "TLT" not in on.err
    assert [line["steps"] for line in read_metrics(here / "run" / METRICS)] == [64, 128, 192]


def test_killed_it_goes_on_from_its_checkpoint(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    kept(here / "mine", played(1))
    (here / "small.toml").write_text(f"checkpoint_s = 0.0\n{ENDLESS}")
    begun = [sys.executable, "-m", "tltlc", *BEGUN, "--demonstrations", "mine", "--out", "run"]
    with subprocess.Popen(begun, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as training:
        until(lambda: training.poll() is None and len(read_metrics(here / "run" / METRICS)) >= 3, "3 iterations", 0.1)
        training.send_signal(signal.SIGKILL)
    checkpoint = read_checkpoint(here / "run" / "checkpoint.pt")
    assert checkpoint is not None
    steps = str(checkpoint.steps + 128)
    on = tltlc("train", "--resume", "run", "--steps", steps)
    assert f"ended by the limit of steps after {steps} steps" in on.out, on.err
    numbers = [line["iteration"] for line in read_metrics(here / "run" / METRICS)]
    assert numbers == list(range(1, len(numbers) + 1))


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["soon.tltl", "--demonstrations", "mine"], 2, "--demonstrations are for --method imitation"),
        ([*BEGUN[1:], "--demonstrations", "nowhere"], 1, "TLT0921"),
        (["soon.tltl", "--method", "magic"], 2, "--method"),
    ],
)
def test_what_nobody_can_imitate(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    said: str,
) -> None:
    found = tltlc("train", *arguments)
    assert (found.status, found.out) == (status, "")
    assert said in found.err
    assert not (here / "training").exists()


def test_a_spec_that_the_expert_does_not_meet(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    found = tltlc("train", "vain.tltl", "--method", "imitation", "--config", "small.toml", "--out", "run")
    assert found.status == 1
    assert "recording the expert: 0 of 2 demonstrations, the episode of seed 0 fails, and is not kept" in found.err
    assert "error[TLT0920]" in found.err


def test_the_method_is_a_setting(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    printed = tltlc("train", "--method", "imitation", "--print-config").out
    (here / "printed.toml").write_text(printed)
    settings = read_settings(here / "printed.toml")
    assert settings.imitates and not settings.searches
    kept(here / "mine", played(1))
    named = ("--demonstrations", "mine", "--steps", "64", "--out", "run")
    tltlc("train", "soon.tltl", "--config", "small.toml", "--method", "imitation", *named)
    other = tltlc("train", "--resume", "run", "--method", "automaton", "--steps", "128")
    assert "error[TLT0870]: the training in `run` is by the method `imitation`, not by `automaton`" in other.err
