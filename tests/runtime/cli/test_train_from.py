"""``tltlc train --from``: the initial policy, the level it is trained on, and errors."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.signals import interrupted  # noqa: F401
from tests.runtime.cli.small_training import SMALL, SOON
from tests.runtime.evaluation.untrained import untrained
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.stealth.levels.file import level_path
from tltl_runtime.training.run.initial_policy import weights_hash

TltlcFunction = Callable[..., Outcome]

SENSES = "import spatial\nentity s1\nspec other { level cover_and_hide\n limit 8 steps\n reach near(s1) }\n"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder with small settings, two specs and a policy for one of them.

    ``small.toml`` has no network, as that of the policy is used; ``drawn.toml`` is for trainings without a policy.
    """
    (tmp_path / "small.toml").write_text(SMALL.replace("[network]\nhidden = [8]\n", ""))
    (tmp_path / "drawn.toml").write_text(SMALL)
    (tmp_path / "soon.tltl").write_text(SOON)
    (tmp_path / "other.tltl").write_text(SENSES)
    write_policy(tmp_path / "old.safetensors", untrained(str(tmp_path / "soon.tltl")))
    monkeypatch.chdir(tmp_path)
    return tmp_path


TRAIN_FROM = ("train", "--from", "old.safetensors", "--config", "small.toml")


def test_the_spec_the_sensors_and_the_network_come_from_the_policy(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc(*TRAIN_FROM, "--level", "cover_and_hide:v1")
    assert result.status == 0, result.err
    folder = Path("training/cover_and_hide-v1-soon-0-tuned")
    assert result.err.splitlines()[:3] == [
        f"training soon on cover_and_hide:v1, seed 0, in {folder}",
        "it ends when the spec is met, at the latest after 128 steps",
        "it begins with the weights of old.safetensors; "
        "its critic is new: only the critic learns in the first 5 iterations",
    ]
    old, new = read_policy("old.safetensors"), read_policy(folder / "policy.safetensors")
    assert (new.card.sensors, new.card.network, new.card.fspa) == (old.card.sensors, old.card.network, old.card.fspa)
    # The spec was met at once, while only the critic was learning.
    assert weights_hash(new) == weights_hash(old)
    run = json.loads((folder / "run.json").read_text())
    assert run["initial"]["path"] == str(here / "old.safetensors")
    assert json.loads((folder / "record.json").read_text())["initial"]["weights"] == weights_hash(old)
    assert "it began with the weights of another policy, for cover_and_hide v0" in " ".join(
        tltlc("inspect", folder).out.split()
    )


def test_the_default_level_is_the_level_of_the_policy(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    assert (
        tltlc("train", "soon.tltl", "--level", "cover_and_hide:v1", "--config", "drawn.toml", "--out", "it").status == 0
    )
    again = tltlc("train", "--from", "it", "--config", "small.toml", "--out", "again")
    assert again.status == 0, again.err
    assert "training soon on cover_and_hide:v1, seed 0, in again" in again.err


@pytest.mark.usefixtures("here")
def test_a_shipped_policy_is_named_by_its_level(tltlc: TltlcFunction, interrupted: TltlcFunction) -> None:  # noqa: F811
    result = tltlc("train", "--from", "cover_and_hide", "--print-config")
    assert result.status == 0
    started = interrupted("--from", "cover_and_hide:v2", "--config", "small.toml", "--out", "it")
    assert "training cover_and_hide on cover_and_hide:v2, seed 0, in it" in started.err
    assert json.loads(Path("it/run.json").read_text())["initial"]["path"] == str(shipped_policy("cover_and_hide"))


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        (["other.tltl"], 1, "TLT0843"),
        (["--level", "navigation"], 1, "TLT0843"),
        (["--method", "imitation"], 2, "--from works only with the method `automaton`"),
        (["--no-map"], 1, "error[TLT0941]: `old.safetensors` has the sensors of `--map"),
        (["--config", "wide.toml"], 1, "error[TLT0941]: the network of `old.safetensors` is not the one that"),
        (["--from", "gone.safetensors"], 3, "cannot read `gone.safetensors`"),
        (["--from", "small.toml"], 1, "TLT0840"),
    ],
)
def test_unfit_policies_and_options_are_rejected(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    message: str,
) -> None:
    Path("wide.toml").write_text("[network]\nhidden = [7]\n")
    result = tltlc(*TRAIN_FROM, *arguments)
    assert (result.status, result.out) == (status, ""), result.err
    assert message in result.err
    assert not Path("training").exists()


@pytest.mark.usefixtures("here")
def test_on_resume_the_policy_may_have_moved_but_not_changed(
    tltlc: TltlcFunction,  # noqa: F811
    interrupted: TltlcFunction,  # noqa: F811
) -> None:
    Path("small.toml").write_text(Path("small.toml").read_text().replace("episodes = 2", "episodes = 100_000"))
    interrupted(*TRAIN_FROM[1:], "--out", "it")
    shutil.move("old.safetensors", "moved.safetensors")
    write_policy("another.safetensors", untrained("soon.tltl", seed=1))
    other_policy = tltlc("train", "--resume", "it", "--from", "another.safetensors", "--steps", "128")
    assert (
        "error[TLT0870]: the training in `it` begins with another policy than `another.safetensors`" in other_policy.err
    )
    missing = tltlc("train", "--resume", "it", "--steps", "128")
    assert (missing.status, missing.out) == (1, "")
    assert "error[TLT0940]" in missing.err
    resumed = tltlc("train", "--resume", "it", "--from", "moved.safetensors", "--steps", "128")
    assert "error" not in resumed.err and "128 steps" in resumed.out, resumed.err
    interrupted("soon.tltl", "--config", "drawn.toml", "--out", "plain")
    rejected = tltlc("train", "--resume", "plain", "--from", "moved.safetensors", "--steps", "128")
    assert "begins with random weights, not with the policy `moved.safetensors`" in rejected.err


@pytest.mark.usefixtures("here")
def test_the_level_of_the_policy_may_be_missing_if_another_is_named(
    tltlc: TltlcFunction,  # noqa: F811
    interrupted: TltlcFunction,  # noqa: F811
) -> None:
    """The level of the spec need not exist either; a resumed training needs only the file of the policy."""
    shutil.copy(level_path("cover_and_hide"), "plan.toml")
    shutil.copytree(level_path("cover_and_hide").parent / "assets", "assets")
    Path("own.tltl").write_text(SOON.replace("level cover_and_hide", "level plan"))
    assert tltlc("train", "own.tltl", "--config", "drawn.toml", "--out", "first").status == 0
    from_file = ("--from", "first/policy.safetensors")
    assert "error[TLT0800]: there is no level `plan`" in tltlc("train", *from_file).err
    Path("small.toml").write_text(Path("small.toml").read_text().replace("episodes = 2", "episodes = 100_000"))
    started = interrupted("own.tltl", *from_file, "--config", "small.toml", "--out", "second")
    assert "it begins with the weights of first/policy.safetensors" in started.err
    for old, new in (("plan.toml", "moved.toml"), ("first", "elsewhere")):
        shutil.move(old, new)
    resumed = tltlc("train", "--resume", "second", "--level", "moved.toml", "--from", "elsewhere", "--steps", "128")
    assert "error" not in resumed.err and "128 steps" in resumed.out, resumed.err


def test_settings_that_agree_with_the_network_are_accepted(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    network = read_policy("old.safetensors").card.network
    assert network.hidden != (512, 512)
    Path("same.toml").write_text(f'[network]\nactivation = "{network.activation}"\n')
    result = tltlc("train", "--from", "old.safetensors", "--config", "same.toml", "--print-config")
    assert result.status == 0, result.err
    assert f"hidden = {list(network.hidden)}" in result.out


def test_the_initial_policy_is_not_announced_again_on_resume(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    Path("small.toml").write_text(Path("small.toml").read_text().replace("episodes = 2", "episodes = 100_000"))
    assert "it begins with the weights of" in tltlc(*TRAIN_FROM, "--out", "it", "--steps", "64").err
    assert "it begins with the weights of" not in tltlc("train", "--resume", "it", "--steps", "128").err
