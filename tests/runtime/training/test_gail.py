"""Trainings by imitation: first behavioural cloning, then the rewards of a discriminator."""

from __future__ import annotations

import math
import shutil
from pathlib import Path
from typing import Any

import pytest
import torch

from tests.runtime.training.imitating import ALONG, SOON, imitating, recorded_episode, write_recordings
from tests.runtime.training.runs import checkpoint_of
from tests.runtime.training.test_settings import compare
from tltl_runtime.policies.file import read_policy
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.record import write_record
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import DEMONSTRATIONS, POLICY, TrainingRun, read_run
from tltl_runtime.training.files.settings import rsl_config
from tltl_runtime.training.imitation.gail import Gail
from tltl_runtime.training.ppo.distributed import process_group
from tltl_runtime.training.run.preparation import load_imitation_data, make_environments, prepare_environment
from tltl_runtime.training.run.spaces import TrainingSpaces
from tltl_runtime.training.run.train import train
from tltl_runtime.training.run.training_clock import TrainingClock
from tltl_runtime.training.runner import Runner
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

pytestmark = pytest.mark.slow

CLONING = {"value", "cloning", "discriminator", "discriminator_theirs", "discriminator_agents"}
GAIL = {"value", "surrogate", "entropy", "discriminator", "discriminator_theirs", "discriminator_agents"}


@pytest.fixture(name="mine", scope="module")
def _mine(folder: Path) -> Path:
    return write_recordings(folder / "mine", recorded_episode(1), recorded_episode(2))


@pytest.fixture(name="imitated", scope="module")
def _imitated(folder: Path, mine: Path) -> tuple[TrainingRun, list[TrainingReport]]:
    """A training of three iterations."""
    run = imitating(folder / "imitated", mine)
    return run, list(train(run))


def numbers(reports: list[TrainingReport]) -> list[Any]:
    return [(report.iteration.number, report.iteration.losses, report.steps, report.window) for report in reports]


def equal(one: Any, other: Any) -> bool:
    if isinstance(one, torch.Tensor):
        return torch.equal(one, other)
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(equal(one[key], other[key]) for key in one)
    return bool(one == other)


def algorithm_of(run: TrainingRun) -> Gail:
    """The algorithm of a training before its first step."""
    processes = process_group()
    vector_env = make_environments(run, spaces := TrainingSpaces(None, searches=False))
    torch.manual_seed(0)
    data, clock = load_imitation_data(run, processes, spaces, print), TrainingClock(0.0)
    env, _ = prepare_environment(run, processes, "cpu", spaces, vector_env, None, print, data, None, clock)
    algorithm = Runner(env, rsl_config(run.settings, env.shapes, env.branches)).alg
    vector_env.close()
    assert isinstance(algorithm, Gail)
    return algorithm


def test_cloning_comes_first(imitated: tuple[TrainingRun, list[TrainingReport]]) -> None:
    run, reports = imitated
    assert [set(report.iteration.losses) for report in reports] == [CLONING, GAIL, GAIL]
    assert [report.steps for report in reports] == [64, 128, 192]
    assert [line["losses"].keys() for line in read_metrics(run.folder / METRICS)] == [CLONING, GAIL, GAIL]
    assert reports[-1].searched is None
    assert reports[-1].replayed == 0
    about = reports[-1].imitated
    assert about is not None
    assert (about.episodes, about.decisions, about.players, about.left_out) == (2, 16, ("me",), ())


def test_the_record_and_the_policy_describe_the_imitation(imitated: tuple[TrainingRun, list[TrainingReport]]) -> None:
    run, reports = imitated
    record = write_record(run, reports[-1])
    assert record["imitated"] == {"episodes": 2, "decisions": 16, "players": ["me"], "left_out": [], "cloned": 64}
    assert (record["settings"]["method"], record["search"]) == ("imitation", None)
    policy = read_policy(run.folder / POLICY)
    assert policy.card.training == record
    assert policy.card.network == run.settings.network


@pytest.mark.slow
def test_equal_trainings_and_equal_checkpoints_give_equal_numbers(
    folder: Path, mine: Path, imitated: tuple[TrainingRun, list[TrainingReport]]
) -> None:
    run, reports = imitated
    again = replace(run, folder=folder / "again")
    assert numbers(list(train(again))) == numbers(reports)
    assert equal(checkpoint_of(run).algorithm, checkpoint_of(again).algorithm)
    shutil.copytree(run.folder, folder / "copy")
    longer = [imitating(folder / name, mine, stop__steps=320) for name in ("again", "copy")]
    resumed = [list(train(longer_run, resume=True)) for longer_run in longer]
    assert [report.iteration.number for report in resumed[0]] == [4, 5]
    assert numbers(resumed[0]) == numbers(resumed[1])
    assert equal(checkpoint_of(longer[0]).algorithm, checkpoint_of(longer[1]).algorithm)


def test_a_higher_limit_does_not_clone_again(folder: Path, mine: Path) -> None:
    run = imitating(folder / "longer", mine)
    list(train(run))
    algorithm_state = checkpoint_of(run).algorithm
    assert (algorithm_state["steps"], algorithm_state["cloning_steps"]) == (192, 57)
    longer = replace(run, settings=imitating(folder, mine, stop__steps=2 * 10**4).settings)
    reports = train(longer, resume=True)
    assert set(next(reports).iteration.losses) == GAIL
    reports.close()
    assert checkpoint_of(longer).algorithm["cloning_steps"] == 57


def test_cloning_takes_a_share_of_a_limit_in_minutes(folder: Path, mine: Path) -> None:
    limits = {"stop__steps": 10**9, "stop__minutes": 60.0}
    run = imitating(folder / "minutes", mine, imitation__cloning=1e-6, **limits)
    reports = train(run)
    first_reports = [next(reports) for _ in range(3)]
    reports.close()
    # The share of cloning is 3.6 ms, less than a rollout takes, and 1,000 steps, more than three rollouts have.
    assert [set(report.iteration.losses) for report in first_reports] == [CLONING, GAIL, GAIL]
    algorithm_state = checkpoint_of(run).algorithm
    assert (algorithm_state["cloning_steps"], algorithm_state["cloning_s"]) == (1000, pytest.approx(0.0036))
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, minutes=10**6)))
    reports = train(longer, resume=True)
    assert set(next(reports).iteration.losses) == GAIL
    reports.close()
    assert checkpoint_of(longer).algorithm["cloning_s"] == algorithm_state["cloning_s"]


def test_without_a_limit_in_minutes_time_does_not_end_cloning(tmp_path: Path, mine: Path) -> None:
    algorithm = algorithm_of(imitating(tmp_path / "endless", mine))
    algorithm.seconds = 1e12
    assert algorithm.is_cloning


def test_the_number_of_workers_does_not_change_a_training_by_imitation(
    folder: Path, imitated: tuple[TrainingRun, list[TrainingReport]], mine: Path
) -> None:
    two = imitating(folder / "two", mine, rollout__workers=2)
    assert numbers(list(train(two))) == numbers(imitated[1])
    assert equal(checkpoint_of(two).algorithm, checkpoint_of(imitated[0]).algorithm)


def test_the_settings_of_automaton_rewards_have_no_effect_on_imitation(
    folder: Path, imitated: tuple[TrainingRun, list[TrainingReport]], mine: Path
) -> None:
    changes = {"reward__mode": "edge", "reward__termination": "paper", "exploration__ways": 3}
    other = imitating(folder / "edge", mine, **changes)
    assert numbers(list(train(other))) == numbers(imitated[1])
    assert equal(checkpoint_of(other).algorithm, checkpoint_of(imitated[0]).algorithm)


def test_a_clone_repeats_the_demonstrated_action(folder: Path, mine: Path) -> None:
    run = imitating(folder / "clone", mine, imitation__cloning=1.0, stop__steps=64 * 30, ppo__learning_rate=3e-3)
    reports = list(train(run))
    losses = [report.iteration.losses["cloning"] for report in reports]
    assert losses[-1] < 0.05 * losses[0]
    policy = read_policy(run.folder / POLICY)
    env = make_env("cover_and_hide", "v0", SOON)
    observation, _ = env.reset(seed=1)
    env.close()
    assert tuple(policy.choose(observation)) == ALONG


def test_cloning_trains_actor_and_critic_separately(tmp_path: Path, mine: Path) -> None:
    algorithm = algorithm_of(imitating(tmp_path / "apart", mine))
    algorithm.train_mode()
    actor, critic = (
        [parameter.detach().clone() for parameter in model.parameters()]
        for model in (algorithm.actor, algorithm.critic)
    )
    _rollout(algorithm)
    algorithm._train_critic()
    assert all(
        torch.equal(parameter, before) for parameter, before in zip(algorithm.actor.parameters(), actor, strict=True)
    )
    assert not all(
        torch.equal(parameter, before) for parameter, before in zip(algorithm.critic.parameters(), critic, strict=True)
    )
    critic = [parameter.detach().clone() for parameter in algorithm.critic.parameters()]
    algorithm._clone_actor()
    assert not all(
        torch.equal(parameter, before) for parameter, before in zip(algorithm.actor.parameters(), actor, strict=True)
    )
    assert all(
        torch.equal(parameter, before) for parameter, before in zip(algorithm.critic.parameters(), critic, strict=True)
    )


def _rollout(algorithm: Gail, successes: tuple[int, ...] = (), ends: tuple[int, ...] = ()) -> None:
    """A rollout of 16 steps; episodes of the environments ``successes`` and ``ends`` end in the last step."""
    observations = algorithm.imitation_data.observations[:4]
    with torch.inference_mode():
        for step in range(16):
            algorithm.act(observations)
            last = step == 15
            dones = torch.tensor([last and row in (*successes, *ends) for row in range(4)])
            met = torch.tensor([last and row in successes for row in range(4)])
            extras = {"successes": met, "time_outs": dones & ~met}
            algorithm.process_env_step(observations, torch.full((4,), 7.0), dones, extras)
        algorithm.compute_returns(observations)


def test_the_reward_is_from_the_discriminator_and_the_end_of_the_episode(tmp_path: Path, mine: Path) -> None:
    algorithm = algorithm_of(imitating(tmp_path / "rewards", mine, imitation__strength=0.5, imitation__terminal=2.0))
    _rollout(algorithm, successes=(1,), ends=(3,))
    observations, actions = algorithm.storage.observations.flatten(0, 1), algorithm.storage.actions.flatten(0, 1)
    rewards = 0.5 * algorithm.discriminator.reward((observations, actions)).view(16, 4)
    ends = torch.zeros(16, 4)
    ends[15, 1], ends[15, 3] = 2.0, -2.0
    assert torch.allclose(algorithm.storage.rewards.squeeze(-1), rewards + ends, atol=1e-6)


@pytest.mark.parametrize(("share", "worth"), [(0.5, 0.693), (1 - 1 / math.e, 1.0), (0.7, 1.204)])
def test_the_return_of_an_endless_episode_depends_on_the_discriminator(
    tmp_path: Path, mine: Path, monkeypatch: pytest.MonkeyPatch, share: float, worth: float
) -> None:
    """With the default settings, if the discriminator gives each decision the probability ``share``."""
    algorithm = algorithm_of(imitating(tmp_path / "alive", mine))
    logit = math.log(share / (1 - share))
    monkeypatch.setattr(algorithm.discriminator, "forward", lambda decisions: torch.full((len(decisions[1]),), logit))
    _rollout(algorithm, successes=(1,))
    rewards = algorithm.storage.rewards.squeeze(-1)
    endless = rewards[0, 0].item() / (1 - algorithm.gamma)
    assert endless == pytest.approx(worth, abs=0.001)
    assert rewards[15, 1].item() == pytest.approx(1 + 0.01 * worth, abs=0.001)


def test_the_expert_records_demonstrations_first(folder: Path) -> None:
    run = imitating(folder / "expert", None, imitation__demonstrations=2, stop__steps=64)
    recorded: list[Any] = []
    (report,) = train(run, on_attempt=recorded.append)
    assert [(attempt.episode.player, attempt.kept) for attempt in recorded] == [("expert", 1), ("expert", 2)]
    assert len(list((run.folder / DEMONSTRATIONS).iterdir())) == 2
    assert report.imitated is not None
    assert report.imitated.players == ("expert",)
    longer = replace(run, settings=imitating(folder, None, imitation__demonstrations=2, stop__steps=128).settings)
    recorded.clear()
    assert [report.iteration.number for report in train(longer, resume=True, on_attempt=recorded.append)] == [2]
    assert not recorded


def test_an_interrupted_recording_resumes(folder: Path) -> None:
    run = imitating(folder / "broken", None, imitation__demonstrations=3, stop__steps=64)

    def interrupt(_: Any) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        list(train(run, on_attempt=interrupt))
    recorded: list[Any] = []
    list(train(run, resume=True, on_attempt=recorded.append))
    assert [attempt.kept for attempt in recorded] == [2, 3]


def test_other_demonstrations_are_rejected_on_resume(folder: Path, mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    shutil.copytree(mine, folder / "copied")
    run = imitating(Path("other"), Path("copied"))
    reports = train(run)
    next(reports)
    reports.close()
    write_recordings(folder / "copied", recorded_episode(3))
    with pytest.raises(TltlError) as caught:
        next(train(run, resume=True))
    compare("TLT0922", caught.value)
    # Equal demonstrations in another folder are accepted.
    assert list(train(replace(run, demonstrations=str(mine)), resume=True))[-1].stop == "steps"
    assert read_run(run.folder).demonstrations == str(mine)


def test_an_algorithm_that_cannot_imitate_is_rejected(tmp_path: Path, mine: Path) -> None:
    run = imitating(tmp_path / "none", mine, classes__algorithm="rsl_rl.algorithms:PPO")
    with pytest.raises(TltlError) as caught:
        next(train(run))
    assert "TLT0862" in str(caught.value)
    assert "not a subclass of Gail" in str(caught.value)


def test_the_imitation_data_have_the_demonstrated_actions(mine: Path, tmp_path: Path) -> None:
    assert set(map(tuple, algorithm_of(imitating(tmp_path / "a", mine)).imitation_data.actions.tolist())) == {
        tuple(map(float, ALONG))
    }
