"""Trainings that imitate: cloning first, then the rewards of a discriminator."""

from __future__ import annotations

import math
import shutil
from pathlib import Path
from typing import Any

import pytest
import torch

from tests.runtime.training.imitating import ALONG, SOON, imitating, kept, played
from tests.runtime.training.runs import checkpoint_of
from tests.runtime.training.test_settings import compare
from tltl_runtime.policies.file import read_policy
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.imitation.gail import Gail
from tltl_runtime.training.ppo.distributed import peers
from tltl_runtime.training.run.metrics import METRICS, read_metrics
from tltl_runtime.training.run.record import write_record
from tltl_runtime.training.run.report import Report
from tltl_runtime.training.run.run import DEMONSTRATIONS, POLICY, Run, read_run
from tltl_runtime.training.run.settings import rsl_config
from tltl_runtime.training.run.setup import demonstrated, environments, prepared
from tltl_runtime.training.run.train import train
from tltl_runtime.training.runner import Runner
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

CLONING = {"value", "cloning", "discriminator", "discriminator_theirs", "discriminator_agents"}
GAIL = {"value", "surrogate", "entropy", "discriminator", "discriminator_theirs", "discriminator_agents"}


@pytest.fixture(name="mine", scope="module")
def _mine(folder: Path) -> Path:
    return kept(folder / "mine", played(1), played(2))


@pytest.fixture(name="imitated", scope="module")
def _imitated(folder: Path, mine: Path) -> tuple[Run, list[Report]]:
    """A training of three iterations."""
    run = imitating(folder / "imitated", mine)
    return run, list(train(run))


def numbers(reports: list[Report]) -> list[Any]:
    return [(each.iteration.number, each.iteration.losses, each.steps, each.window) for each in reports]


def equal(one: Any, other: Any) -> bool:
    if isinstance(one, torch.Tensor):
        return torch.equal(one, other)
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(equal(one[key], other[key]) for key in one)
    return bool(one == other)


def algorithm_of(run: Run) -> Gail:
    """What learns in a training, before its first step."""
    own = peers()
    played = environments(run)
    torch.manual_seed(0)
    env, _ = prepared(run, own, "cpu", played, None, print, demonstrated(run, own, print), None)
    made = Runner(env, rsl_config(run.settings, env.shapes, env.branches)).alg
    played.close()
    assert isinstance(made, Gail)
    return made


def test_cloning_comes_first(imitated: tuple[Run, list[Report]]) -> None:
    run, reports = imitated
    assert [set(each.iteration.losses) for each in reports] == [CLONING, GAIL, GAIL]
    assert [each.steps for each in reports] == [64, 128, 192]
    assert [line["losses"].keys() for line in read_metrics(run.folder / METRICS)] == [CLONING, GAIL, GAIL]
    assert reports[-1].searched is None
    assert reports[-1].replayed == 0
    about = reports[-1].imitated
    assert about is not None
    assert (about.episodes, about.decisions, about.players, about.left_out) == (2, 16, ("me",), ())


def test_its_record_and_its_policy_tell_how_it_was_made(imitated: tuple[Run, list[Report]]) -> None:
    run, reports = imitated
    made = write_record(run, reports[-1])
    assert made["imitated"] == {"episodes": 2, "decisions": 16, "players": ["me"], "left_out": [], "cloned": 64}
    assert (made["settings"]["method"], made["search"]) == ("imitation", None)
    policy = read_policy(run.folder / POLICY)
    assert policy.card.training == made
    assert policy.card.network == run.settings.network


def test_equal_trainings_give_equal_numbers_and_so_do_equal_checkpoints(
    folder: Path, mine: Path, imitated: tuple[Run, list[Report]]
) -> None:
    run, reports = imitated
    again = replace(run, folder=folder / "again")
    assert numbers(list(train(again))) == numbers(reports)
    assert equal(checkpoint_of(run).algorithm, checkpoint_of(again).algorithm)
    shutil.copytree(run.folder, folder / "copy")
    longer = [imitating(folder / name, mine, stop__steps=320) for name in ("again", "copy")]
    resumed = [list(train(each, resume=True)) for each in longer]
    assert [each.iteration.number for each in resumed[0]] == [4, 5]
    assert numbers(resumed[0]) == numbers(resumed[1])
    assert equal(checkpoint_of(longer[0]).algorithm, checkpoint_of(longer[1]).algorithm)


def test_a_higher_limit_does_not_clone_again(folder: Path, mine: Path) -> None:
    run = imitating(folder / "longer", mine)
    list(train(run))
    kept_ = checkpoint_of(run).algorithm
    assert (kept_["steps"], kept_["cloning_steps"]) == (192, 57)
    longer = replace(run, settings=imitating(folder, mine, stop__steps=2 * 10**4).settings)
    reports = train(longer, resume=True)
    assert set(next(reports).iteration.losses) == GAIL
    reports.close()
    assert checkpoint_of(longer).algorithm["cloning_steps"] == 57


def test_of_a_limit_of_minutes_it_clones_a_share_too(folder: Path, mine: Path) -> None:
    limits = {"stop__steps": 10**9, "stop__minutes": 60.0}
    run = imitating(folder / "minutes", mine, imitation__cloning=1e-6, **limits)
    reports = train(run)
    told = [next(reports) for _ in range(3)]
    reports.close()
    # 3.6 ms, in which no rollout is played, and 1,000 steps, which are more than the three of them.
    assert [set(each.iteration.losses) for each in told] == [CLONING, GAIL, GAIL]
    kept_ = checkpoint_of(run).algorithm
    assert (kept_["cloning_steps"], kept_["cloning_s"]) == (1000, pytest.approx(0.0036))
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, minutes=10**6)))
    reports = train(longer, resume=True)
    assert set(next(reports).iteration.losses) == GAIL
    reports.close()
    assert checkpoint_of(longer).algorithm["cloning_s"] == kept_["cloning_s"]


def test_without_a_limit_of_minutes_time_does_not_count(tmp_path: Path, mine: Path) -> None:
    made = algorithm_of(imitating(tmp_path / "endless", mine))
    made.seconds = 1e12
    assert made.clones


def test_workers_do_not_count(folder: Path, imitated: tuple[Run, list[Report]], mine: Path) -> None:
    two = imitating(folder / "two", mine, rollout__workers=2)
    assert numbers(list(train(two))) == numbers(imitated[1])
    assert equal(checkpoint_of(two).algorithm, checkpoint_of(imitated[0]).algorithm)


def test_the_rewards_of_the_automaton_do_not_count(
    folder: Path, imitated: tuple[Run, list[Report]], mine: Path
) -> None:
    changes = {"reward__mode": "edge", "reward__termination": "paper", "exploration__ways": 3}
    other = imitating(folder / "edge", mine, **changes)
    assert numbers(list(train(other))) == numbers(imitated[1])
    assert equal(checkpoint_of(other).algorithm, checkpoint_of(imitated[0]).algorithm)


def test_a_clone_does_as_it_was_shown(folder: Path, mine: Path) -> None:
    run = imitating(folder / "clone", mine, imitation__cloning=1.0, stop__steps=64 * 30, ppo__learning_rate=3e-3)
    reports = list(train(run))
    losses = [each.iteration.losses["cloning"] for each in reports]
    assert losses[-1] < 0.05 * losses[0]
    policy = read_policy(run.folder / POLICY)
    env = make_env("cover_and_hide", "v0", SOON)
    observation, _ = env.reset(seed=1)
    env.close()
    assert tuple(policy.choose(observation)) == ALONG


def test_the_critic_learns_while_the_actor_is_cloned_and_neither_moves_the_other(tmp_path: Path, mine: Path) -> None:
    made = algorithm_of(imitating(tmp_path / "apart", mine))
    made.train_mode()
    actor, critic = ([each.detach().clone() for each in model.parameters()] for model in (made.actor, made.critic))
    _rollout(made)
    made._value()
    assert all(torch.equal(each, before) for each, before in zip(made.actor.parameters(), actor, strict=True))
    assert not all(torch.equal(each, before) for each, before in zip(made.critic.parameters(), critic, strict=True))
    critic = [each.detach().clone() for each in made.critic.parameters()]
    made._clone()
    assert not all(torch.equal(each, before) for each, before in zip(made.actor.parameters(), actor, strict=True))
    assert all(torch.equal(each, before) for each, before in zip(made.critic.parameters(), critic, strict=True))


def _rollout(made: Gail, successes: tuple[int, ...] = (), ends: tuple[int, ...] = ()) -> None:
    """A rollout of 16 steps, which ends in its last one in those environments."""
    observations = made.demonstrated.observations[:4]
    with torch.inference_mode():
        for step in range(16):
            made.act(observations)
            last = step == 15
            dones = torch.tensor([last and row in (*successes, *ends) for row in range(4)])
            met = torch.tensor([last and row in successes for row in range(4)])
            extras = {"successes": met, "time_outs": dones & ~met}
            made.process_env_step(observations, torch.full((4,), 7.0), dones, extras)
        made.compute_returns(observations)


def test_the_reward_is_the_discriminators_and_the_end_of_the_episode(tmp_path: Path, mine: Path) -> None:
    made = algorithm_of(imitating(tmp_path / "rewards", mine, imitation__strength=0.5, imitation__terminal=2.0))
    _rollout(made, successes=(1,), ends=(3,))
    observations, actions = made.storage.observations.flatten(0, 1), made.storage.actions.flatten(0, 1)
    given = 0.5 * made.discriminator.reward((observations, actions)).view(16, 4)
    ends = torch.zeros(16, 4)
    ends[15, 1], ends[15, 3] = 2.0, -2.0
    assert torch.allclose(made.storage.rewards.squeeze(-1), given + ends, atol=1e-6)


@pytest.mark.parametrize(("share", "worth"), [(0.5, 0.693), (1 - 1 / math.e, 1.0), (0.7, 1.204)])
def test_what_it_is_worth_to_live_on(
    tmp_path: Path, mine: Path, monkeypatch: pytest.MonkeyPatch, share: float, worth: float
) -> None:
    """By the default settings, where all decisions are taken for demonstrated ones with a probability ``share``."""
    made = algorithm_of(imitating(tmp_path / "alive", mine))
    logit = math.log(share / (1 - share))
    monkeypatch.setattr(made.discriminator, "forward", lambda decisions: torch.full((len(decisions[1]),), logit))
    _rollout(made, successes=(1,))
    rewards = made.storage.rewards.squeeze(-1)
    endless = rewards[0, 0].item() / (1 - made.gamma)
    assert endless == pytest.approx(worth, abs=0.001)
    assert rewards[15, 1].item() == pytest.approx(1 + 0.01 * worth, abs=0.001)


def test_the_experts_demonstrations_are_recorded_first(folder: Path) -> None:
    run = imitating(folder / "expert", None, imitation__demonstrations=2, stop__steps=64)
    told: list[Any] = []
    (report,) = train(run, recording=told.append)
    assert [(each.episode.player, each.kept) for each in told] == [("expert", 1), ("expert", 2)]
    assert len(list((run.folder / DEMONSTRATIONS).iterdir())) == 2
    assert report.imitated is not None
    assert report.imitated.players == ("expert",)
    longer = replace(run, settings=imitating(folder, None, imitation__demonstrations=2, stop__steps=128).settings)
    told.clear()
    assert [each.iteration.number for each in train(longer, resume=True, recording=told.append)] == [2]
    assert not told


def test_a_recording_that_was_broken_off_goes_on(folder: Path) -> None:
    run = imitating(folder / "broken", None, imitation__demonstrations=3, stop__steps=64)

    def broken_off(_: Any) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        list(train(run, recording=broken_off))
    told: list[Any] = []
    list(train(run, resume=True, recording=told.append))
    assert [each.kept for each in told] == [2, 3]


def test_other_demonstrations_are_another_training(folder: Path, mine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    shutil.copytree(mine, folder / "copied")
    run = imitating(Path("other"), Path("copied"))
    reports = train(run)
    next(reports)
    reports.close()
    kept(folder / "copied", played(3))
    with pytest.raises(TltlError) as caught:
        next(train(run, resume=True))
    compare("TLT0922", caught.value)
    # Those that lie elsewhere now are no others.
    assert list(train(replace(run, demonstrations=str(mine)), resume=True))[-1].stop == "steps"
    assert read_run(run.folder).demonstrations == str(mine)


def test_an_algorithm_that_cannot_imitate_is_refused(tmp_path: Path, mine: Path) -> None:
    run = imitating(tmp_path / "none", mine, classes__algorithm="rsl_rl.algorithms:PPO")
    with pytest.raises(TltlError) as caught:
        next(train(run))
    assert "TLT0862" in str(caught.value)
    assert "no subclass of Gail" in str(caught.value)


def test_what_is_shown_is_what_is_done(mine: Path, tmp_path: Path) -> None:
    assert set(map(tuple, algorithm_of(imitating(tmp_path / "a", mine)).demonstrated.actions.tolist())) == {
        tuple(map(float, ALONG))
    }
