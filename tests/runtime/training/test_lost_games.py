"""Searches and trainings whose game, in another process, is lost now and then."""

from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
import torch

from tests.runtime.training.runs import checkpoint_of
from tests.runtime.training.test_search_any_game import CORNERS, run_of, write_counter
from tests.runtime.wire.processes import no_game_is_left
from tests.waiting import HANG_S
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.policies.spaces.layouts import space_layouts
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration.action_encoding import ActionEncoding
from tltl_runtime.training.exploration.cells import position_grid
from tltl_runtime.training.exploration.replayed_starts import OTHER_SEED, EpisodesInProgress, EpisodeStart
from tltl_runtime.training.exploration.returning_env import ReturningEnv
from tltl_runtime.training.exploration.reverse_curriculum import ReverseCurriculum
from tltl_runtime.training.exploration.search import SuccessfulEpisode
from tltl_runtime.training.exploration.search_plan import SearchPlan
from tltl_runtime.training.exploration.self_imitation import SelfImitation
from tltl_runtime.training.ppo.environment import TrainingEnv
from tltl_runtime.training.run.spaces import training_spaces
from tltl_runtime.training.run.train import train
from tltl_runtime.vector import WorkerVectorEnv, make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.surviving_env import FAULTS, LOST, surviving
from tltlc.api import TltlError
from tltlc.core.record import replace

MORTAL = Path(__file__).parents[1] / "wire" / "games" / "mortal.py"
LEFT, STAY, RIGHT = range(3)


@pytest.fixture(autouse=True)
def _no_process_is_left() -> Iterator[None]:
    with no_game_is_left():
        yield


def mortal(tmp_path: Path, fault: str, *numbers: int | str) -> str:
    """Write the game file of a counter that dies, and return its scene; the episodes are counted beside it."""
    folder = tmp_path / "game"
    folder.mkdir()
    words = [sys.executable, str(MORTAL), fault, str(tmp_path / "episodes"), *map(str, numbers)]
    return write_counter(folder, f"process = {json.dumps(words)}\nstart_s = {HANG_S}\nstep_s = {HANG_S}")


def returning(make: Callable[[], TltlEnv]) -> gymnasium.Env[Any, Any]:
    grid = position_grid(CORNERS, [])
    return surviving(partial(ReturningEnv, make, game=GAME, grid=grid, snapshots=True))


@contextmanager
def vector_env(level: str, num_envs: int = 1) -> Iterator[WorkerVectorEnv]:
    env = make_vec(level, "v0", num_envs, 1, wrapper=returning, info={**TLTL_INFO, "cell": np.int64}, timeout=HANG_S)
    try:
        yield env
    finally:
        env.close()


def test_a_start_that_is_lost_each_time_is_replaced_by_another(tmp_path: Path) -> None:
    lost, good = EpisodeStart(666, [[LEFT]] * 3), EpisodeStart(5, [[STAY]])
    starts = iter([lost, good, lost, lost, good, good, good])

    def at(episodes: EpisodesInProgress, observation: Any) -> bool:
        """Whether the episode is where its seed and actions lead."""
        position = 1 + episodes.starts[0].seed % 4 + sum(action - 1 for (action,) in episodes.actions[0])
        is_there: bool = observation["observation"].tolist() == [[position]]
        return is_there

    with vector_env(mortal(tmp_path, "seed", 666)) as env:
        episodes = EpisodesInProgress(env, lambda: next(starts))
        assert at(episodes, episodes.observation)
        (other,) = episodes.starts
        assert (other.seed != 666, other.segment, episodes.actions) == (True, None, [[]])
        everywhere = np.array([True])
        assert [fault.code for fault in episodes.faults] == ["TLT0793"]
        # The next start is good, and is still used.
        observation = episodes.cut_off(everywhere)
        assert episodes.starts == [good] and at(episodes, observation)
        assert at(episodes, episodes.step(np.array([[STAY]]))[0])
        assert episodes.actions == [[[STAY], [STAY]]]
        observation = episodes.cut_off(everywhere)
        assert episodes.starts == [other] and at(episodes, observation)
        assert len(episodes.faults) == 2
        # An episode that ends is followed by one with a lost start, too.
        over = np.array([False])
        while not over.any():
            observation, _, terminated, truncated, _ = episodes.step(np.array([[RIGHT]]))
            over = terminated | truncated
        assert episodes.starts == [other] and episodes.actions[0]
        episodes.start_next(over)
        assert episodes.starts == [other] and episodes.actions == [[]] and at(episodes, observation)
        assert len(episodes.faults) == 3


def episodes_begun(tmp_path: Path) -> int:
    """Return how many resets all processes of the game have been asked for."""
    return (tmp_path / "episodes").stat().st_size


def saved_start(env: gymnasium.Env[Any, Any]) -> dict[str, Any]:
    """Begin an episode after twenty steps of seed 2; return its info."""
    env.set_wrapper_attr("next_start", (2, np.full((20, 1), STAY)))
    observation, info = env.reset()
    assert observation["observation"] == 3 or OTHER_SEED in info
    return info


def test_a_game_that_was_started_again_saves_snapshots_again(tmp_path: Path) -> None:
    env = returning(partial(GAME.make_env, mortal(tmp_path, "exit", 2)))
    saved_start(env)
    env.set_wrapper_attr("next_start", (3, np.zeros((0, 1), np.int64)))
    env.reset()
    assert env.step(STAY)[4][LOST]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(3):
            saved_start(env)
    # One before the loss, the lost one, and one after it: two resets have returned to snapshots.
    assert episodes_begun(tmp_path) == 3
    env.close()


def test_a_game_that_is_lost_at_a_snapshot_loses_one_start(tmp_path: Path) -> None:
    env = returning(partial(GAME.make_env, mortal(tmp_path, "restore")))
    assert FAULTS not in saved_start(env)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        info = saved_start(env)
        assert info[OTHER_SEED] != 2 and [fault.code for fault in info[FAULTS]] == ["TLT0791"]
        for _ in range(3):
            assert FAULTS not in saved_start(env)
    assert episodes_begun(tmp_path) == 3
    env.close()


class TwoStarts(ReverseCurriculum):
    """A curriculum of one demonstration. Starts at the level's start and in its segment take turns."""

    def __init__(self) -> None:
        super().__init__(1, np.random.default_rng(0), ActionEncoding(gymnasium.spaces.Discrete(3)))
        self.add(SuccessfulEpisode(2, [[STAY], [RIGHT]], end=1))
        self.start_rate = 0.5
        self._starts = cycle([EpisodeStart(2), EpisodeStart(2, segment=(1, 0), max_decisions=2)])

    def draw(self) -> EpisodeStart:
        return next(self._starts)


def test_a_lost_episode_teaches_the_curriculum_nothing(tmp_path: Path) -> None:
    curriculum = TwoStarts()
    with vector_env(mortal(tmp_path, "exit", 1, 2), 2) as vector:
        layouts = space_layouts(vector.single_observation_space, vector.single_action_space)
        env = TrainingEnv(vector, 0, curriculum=curriculum, limit_steps=40, layouts=layouts)
        before = curriculum.state()
        _, rewards, dones, extras = env.step(torch.tensor([[STAY]] * 2))
        assert dones.all() and extras["time_outs"].all() and not extras["successes"].any()
        assert rewards.tolist() == [0.0, 0.0]
        np.testing.assert_equal(curriculum.state(), before)
        assert not curriculum.failures and env.pop_finished() == ()
        lost = env.pop_lost()
        assert lost is not None and lost.count == 2
        # The second environment has the limit of its start, which teaches.
        for _ in range(2):
            *_, dones, _ = env.step(torch.tensor([[STAY]] * 2))
        assert dones.tolist() == [False, True]
        assert curriculum.rates[1].tolist() == [pytest.approx(0.45)]


@pytest.mark.parametrize(("fault", "numbers"), [("reset", (1, 2)), ("snapshot", ()), ("restore", ())])
def test_a_game_that_is_lost_while_it_is_measured_is_measured_again(
    tmp_path: Path, fault: str, numbers: tuple[int, ...]
) -> None:
    spaces = training_spaces(run_of(tmp_path / "run", mortal(tmp_path, fault, *numbers)))
    assert spaces.plan is not None
    assert (spaces.plan.obstacle, spaces.plan.snapshots, spaces.searches) == (None, True, True)


def test_a_game_that_is_lost_at_each_reset_is_not_trained(tmp_path: Path) -> None:
    run = run_of(tmp_path / "run", mortal(tmp_path, "reset", "all"))
    with pytest.raises(WireError, match="reports: no such map"):
        next(train(run))
    assert not run.folder.exists()
    assert episodes_begun(tmp_path) == 3


def imitation_of(level: str) -> SelfImitation:
    """Return the self-imitation of one demonstration, seven steps to the goal from seed 2."""
    curriculum = ReverseCurriculum(1, np.random.default_rng(0), ActionEncoding(gymnasium.spaces.Discrete(3)))
    curriculum.add(SuccessfulEpisode(2, [[RIGHT]] * 7, end=1))
    return SelfImitation(partial(GAME.make_env, level), curriculum)


def test_a_demonstration_is_replayed_again_if_the_game_is_lost(tmp_path: Path) -> None:
    self_imitation = imitation_of(mortal(tmp_path, "exit", 1, 2))
    for _ in range(2):
        batch = self_imitation.draw()
        assert batch is not None
        observations, actions = batch
        assert {*observations["observation"].flatten().tolist()} == {*range(3, 10)}
        assert len(actions) == len(observations["observation"])
    self_imitation.close()
    assert episodes_begun(tmp_path) == 3


def test_a_demonstration_in_which_the_game_is_always_lost_is_not_imitated(tmp_path: Path) -> None:
    self_imitation = imitation_of(mortal(tmp_path, "exit", "all"))
    with pytest.warns(UserWarning, match="TLT0791: the game .*: the demonstration of seed 2 is not imitated"):
        assert self_imitation.draw() is None
    assert self_imitation.draw() is None
    self_imitation.close()
    assert episodes_begun(tmp_path) == 3


def test_episodes_that_are_lost_in_the_search_are_reported(tmp_path: Path) -> None:
    run = run_of(tmp_path / "run", mortal(tmp_path, "exit", 1002, 1003), exploration__steps=400)

    def count_on(plan: SearchPlan) -> None:
        """Let the first episode of the search be number 1001."""
        assert plan.obstacle is None
        (tmp_path / "episodes").write_bytes(b"x" * 1000)

    training = train(run, on_plan=count_on)
    report = next(training)
    training.close()
    assert report.searched is not None and report.lost is not None
    assert report.lost.text.startswith("2 episodes were lost: the game `counter.game.toml` ended with exit status 3")


WITH_CELLS = """
import gymnasium
from pathlib import Path
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.wire_game import WireGame

class WithCells(gymnasium.Wrapper):
    def reset(self, **options):
        observation, info = self.env.reset(**options)
        return observation, {**info, "cell": int(observation[0])}

    def step(self, action):
        observation, reward, terminated, truncated, info = self.env.step(action)
        return observation, reward, terminated, truncated, {**info, "cell": int(observation[0])}

def make(scene):
    return WithCells(WireEnv(WireGame("counter", Path(), COMMAND, "", WAIT_S, WAIT_S), scene=scene))
"""
"""A module that starts the counter, and says in which cell its player is."""


def test_a_lost_game_with_its_own_cells_does_not_end_the_search(tmp_path: Path) -> None:
    command = (sys.executable, str(MORTAL), "exit", str(tmp_path / "episodes"), "1002", "1003")
    code = WITH_CELLS.replace("COMMAND", repr(command)).replace("WAIT_S", repr(HANG_S))
    (tmp_path / "game").mkdir()
    (tmp_path / "game" / "with_cells.py").write_text(code)
    level = write_counter(tmp_path / "game", 'python = "with_cells:make"')
    run = run_of(tmp_path / "run", level, exploration__steps=400)

    def count_on(plan: SearchPlan) -> None:
        assert (plan.cells, plan.obstacle) == ("own", None)
        (tmp_path / "episodes").write_bytes(b"x" * 1000)

    training = train(run, on_plan=count_on)
    report = next(training)
    training.close()
    assert report.searched is not None and report.searched.places > 1
    assert report.lost is not None and report.lost.count == 2


@pytest.mark.slow
def test_a_training_with_a_search_does_not_resume_without_one(tmp_path: Path) -> None:
    # The game is lost in all three measurements of the resumed training, and then no more.
    level = mortal(tmp_path, "exit", 1002, 1003, 1004)
    run = run_of(tmp_path / "run", level, exploration__steps=40, stop__steps=64)
    list(train(run))
    files = {path: path.read_bytes() for path in run.folder.iterdir()}
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, steps=128)))
    (tmp_path / "episodes").write_bytes(b"x" * 1000)
    with pytest.raises(TltlError) as caught:
        next(train(longer, resume=True))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0864"
    assert "its training began with a search, and now the game cannot be searched: the game" in diagnostic.title
    assert f"continue with `tltlc train --resume {run.folder}`" in (diagnostic.help or "")
    changed = [path.name for path, before in files.items() if path.read_bytes() != before]
    assert changed == ["run.json"] and len([*run.folder.iterdir()]) == len(files)
    (*_, report) = train(longer, resume=True)
    assert report.stop == "steps" and "way_seeds" in checkpoint_of(longer).processes[0]
