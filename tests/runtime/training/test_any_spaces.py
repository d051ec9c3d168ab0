"""Training, playing and resuming in a game with nested observations and actions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import torch
from gymnasium import spaces

from tests.runtime.policies.spaces.space_policies import policy_of_spaces
from tests.runtime.training.runs import checkpoint_of
from tests.runtime.training.tiny_game import (
    ENDLESS,
    GAME,
    HIDDEN_TEXT,
    WITH_CELLS,
    LineEnv,
    line_run,
    only_game,
    write_demonstrations,
)
from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.evaluation.player import PolicyPlayer, Setup
from tltl_runtime.game.level_name import Variant
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.policies.spaces.encoder_plan import NORMALIZER
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import POLICY, TrainingRun
from tltl_runtime.training.run.initial_policy import initial_policy_of
from tltl_runtime.training.run.train import train
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render


@pytest.fixture(autouse=True, scope="module")
def _game() -> Iterator[None]:
    with only_game():
        yield


@pytest.fixture(name="learned", scope="module")
def _learned(tmp_path_factory: pytest.TempPathFactory) -> tuple[TrainingRun, list[TrainingReport]]:
    run = line_run(
        tmp_path_factory.mktemp("line") / "run",
        network__hidden=(64,),
        rollout__envs=16,
        rollout__steps=64,
        ppo__learning_rate=3e-3,
        ppo__epochs=6,
        stop__steps=30 * 16 * 64,
        stop__confirmation=40,
    )
    return run, list(train(run))


def test_an_agent_learns_with_nested_observations_and_actions(
    learned: tuple[TrainingRun, list[TrainingReport]],
) -> None:
    run, reports = learned
    rates = [report.window.pass_rate for report in reports]
    assert rates[0] < 0.5
    assert reports[-1].stop == "met"
    policy = read_policy(run.folder / POLICY)
    episodes = list(evaluate(policy, "line", "v0", episodes=50, seed=5, sampled=False))
    assert sum(episode.success for episode in episodes) >= 45


def test_the_policy_of_the_training_stores_its_layouts_and_scales(
    learned: tuple[TrainingRun, list[TrainingReport]],
) -> None:
    policy = read_policy(learned[0].folder / POLICY)
    assert policy.card.spaces is not None
    keys = [part.key for part in policy.card.spaces.observation]
    assert keys == ["automaton", "body/0", "body/1", "light", "progress", "target"]
    mean, deviation = (policy.weights()[f"{NORMALIZER}{name}"] for name in ("mean", "deviation"))
    # Only the target, the last of the numbers, has no bounds: it is 5000 on average.
    assert (mean[-1], deviation[-1]) == (pytest.approx(5000, abs=100), pytest.approx(520, abs=100))
    assert mean[:-1].tolist() == [0.5, 0.5, 0.0, 0.5, 0.5]


def test_equal_trainings_give_equal_weights_and_one_that_resumes_continues_them(tmp_path: Path) -> None:
    whole, broken = (line_run(tmp_path / name) for name in ("whole", "broken"))
    losses = [report.iteration.losses for report in train(whole)]
    reports = train(broken)
    again = [next(reports).iteration.losses]
    reports.close()
    again += [report.iteration.losses for report in train(broken, resume=True)]
    # Episodes begin with other seeds after the training is resumed, so only the first iteration is the same.
    assert len(again) == len(losses) == 3
    assert again[0] == losses[0]
    repeated = line_run(tmp_path / "repeated")
    assert [report.iteration.losses for report in train(repeated)] == losses
    weights, same = (checkpoint_of(run).algorithm["actor_state_dict"] for run in (whole, repeated))
    assert all(torch.equal(weights[name], same[name]) for name in weights)


def test_a_search_and_a_curriculum_store_actions_with_numbers(tmp_path: Path) -> None:
    changes = {"exploration__steps": 2000, "exploration__imitation": 2}
    run = line_run(tmp_path / "run", WITH_CELLS, **changes)
    (*_, report) = train(run)
    assert report.searched is not None
    assert len(report.searched.lengths) >= run.settings.exploration.ways
    assert report.iteration.losses["imitation"] > 0
    state = checkpoint_of(run).processes[0]
    assert state["way_actions"].dtype == torch.float64
    # The actions lead to success again: the numbers are stored before squashing.
    actions = ActionEncoding(LineEnv().action_space)
    seed, length = int(state["way_seeds"][0]), int(state["way_lengths"][0])
    env = GAME.make_env("line", WITH_CELLS, run.fspa)
    env.reset(seed=seed)
    for flat in actions.flat(state["way_actions"][:length].tolist()):
        *_, info = env.step(actions.value(flat))
    assert info["success"]
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, steps=256)))
    assert [report.iteration.number for report in train(longer, resume=True)] == [4]


def test_a_training_begins_with_the_weights_of_a_policy(
    learned: tuple[TrainingRun, list[TrainingReport]], tmp_path: Path
) -> None:
    path = learned[0].folder / POLICY
    run = line_run(tmp_path / "run", network__hidden=(64,), stop__steps=64)
    (report,) = train(replace(run, initial=initial_policy_of(path, read_policy(path))))
    assert report.window.pass_rate > 0.8


@pytest.mark.slow
def test_an_agent_imitates_demonstrations(tmp_path: Path) -> None:
    folder = write_demonstrations(tmp_path / "demonstrations", 40)
    run = line_run(
        tmp_path / "run",
        method="imitation",
        network__hidden=(64,),
        rollout__envs=16,
        rollout__steps=64,
        ppo__learning_rate=3e-3,
        ppo__epochs=20,
        imitation__cloning=0.7,
        stop__steps=10 * 16 * 64,
    )
    reports = list(train(replace(run, demonstrations=str(folder))))
    assert reports[-1].imitated is not None
    assert reports[-1].imitated.episodes == 40
    cloning = [report.iteration.losses["cloning"] for report in reports if "cloning" in report.iteration.losses]
    assert len(cloning) == 7
    assert cloning[-1] < cloning[0] - 1
    assert reports[6].window.pass_rate > 2 * reports[0].window.pass_rate
    assert math.isfinite(reports[-1].iteration.losses["discriminator"])


# --- refusals ---------------------------------------------------------------------------------------


def refusal(run: TrainingRun) -> str:
    with pytest.raises(TltlError) as caught:
        list(train(run))
    return render(caught.value.diagnostics)


def test_an_observation_that_no_policy_can_have_is_refused_before_anything_starts(tmp_path: Path) -> None:
    assert refusal(line_run(tmp_path / "run", HIDDEN_TEXT)) == (
        "error[TLT0844]: `mission` of the observation is a Text space, which no network can read\n"
        '  help: leave it out: write `observation = ["body", "light", "target"]` in the game file\n'
    )
    assert not (tmp_path / "run").exists()


def test_a_network_that_is_too_large_is_refused(tmp_path: Path) -> None:
    assert "error[TLT0862]: `network` gives a policy of" in refusal(
        line_run(tmp_path / "run", network__hidden=(16_000, 16_000))
    )


def test_a_policy_of_another_game_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.safetensors"
    other = policy_of_spaces(spaces.Box(-1, 1, (3,), np.float32), LineEnv().action_space)
    write_policy(path, other)
    run = line_run(tmp_path / "run")
    title = f"the policy was trained for `{other.card.level}` of another game"
    assert f"error[TLT0843]: {title}: another observation `observation`, " in refusal(
        replace(run, initial=initial_policy_of(path, other))
    )
    with pytest.raises(TltlError, match=r"TLT0843.*another game"):
        PolicyPlayer(Setup(other, "line", Variant("v0"), run.fspa, 0))


def test_an_observation_that_is_infinite_ends_the_training(tmp_path: Path) -> None:
    assert "the part `target` of the observation has infinite values" in refusal(line_run(tmp_path / "run", ENDLESS))


def test_an_action_that_is_not_finite_ends_the_training(tmp_path: Path) -> None:
    run = line_run(tmp_path / "run", classes__runner=f"{__name__}:Diverged")
    assert "error[TLT0866]: the training has diverged: an action is not a finite number" in refusal(run)


class Diverged(Runner):
    """A runner whose network has a weight that is not a number."""

    def iterations(self) -> Iterator[Iteration]:
        self.alg.actor.mlp[-1].bias.data.fill_(math.nan)
        yield from super().iterations()
