"""The search for demonstrations in games that do not name their cells."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.wrappers import TimeLimit

from tests.runtime.gymnasium_games import maze
from tests.runtime.training.runs import SMALL, checkpoint_of
from tests.waiting import until
from tltl_runtime.cli.support.training_text import dropped_line, no_search_line, plan_line
from tltl_runtime.game.geometry import Box
from tltl_runtime.game.level import default_spec
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.sensors import NO_SENSORS
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.spec.task import load_task
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration import snapshots
from tltl_runtime.training.exploration.cells import NO_CELL, cell_of, position_grid, signal_grid
from tltl_runtime.training.exploration.replayed_starts import OTHER_SEED, UNREPEATED
from tltl_runtime.training.exploration.returning_env import ReturningEnv
from tltl_runtime.training.exploration.search import (
    SearchProgress,
    SearchSettings,
    SuccessfulEpisode,
    TrajectorySearch,
    _CellArchive,
)
from tltl_runtime.training.exploration.search_plan import SearchPlan, search_plan
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import TrainingRun
from tltl_runtime.training.files.settings import read_settings
from tltl_runtime.training.run.train import train
from tltl_runtime.vector import make_vec
from tltl_runtime.vector.env import TLTL_INFO
from tltlc.api import Signal
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

STEPS = 2560
"""The steps in which learning alone does not meet the spec once, and a search with a training does."""
CORNERS = Box((0.0, 0.0, 0.0), (8.0, 3.0, 1.0))


@pytest.fixture(name="game", scope="module")
def _game(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return maze.write(tmp_path_factory.mktemp("maze"))


def plan_of(game: Path, scene: str, variant: str = "v0") -> SearchPlan:
    env = GAME.make_env(f"{game}:{scene}", variant)
    try:
        return search_plan(env, GAME, has_cells=False)
    finally:
        env.close()


def run_of(folder: Path, level: str, variant: str = "v0", **changes: Any) -> TrainingRun:
    """Return a training of a few steps; ``changes`` override settings, as in ``runs.run_in``."""
    settings = read_settings()
    defaults = {**SMALL, "exploration.ways": 3, "exploration.steps": 20_000, "stop.steps": 256}
    for name, value in {**defaults, **{name.replace("__", "."): value for name, value in changes.items()}}.items():
        table, _, key = name.rpartition(".")
        changed = {table: replace(getattr(settings, table), **{key: value})} if table else {key: value}
        settings = replace(settings, **changed)
    spec = load_task(default_spec(GAME.load_level(level, variant))).fspa
    return TrainingRun(folder, spec, {}, level, Variant(variant), NO_SENSORS, settings, 3)


def trained(run: TrainingRun, **options: Any) -> tuple[list[TrainingReport], list[SearchPlan]]:
    plans: list[SearchPlan] = []
    return list(train(run, on_plan=plans.append, **options)), plans


# --- cells ------------------------------------------------------------------------------------------


def test_positions_in_one_square_are_one_cell() -> None:
    grid = position_grid(CORNERS, [])
    assert grid.side == 0.25
    at, near, far, above = ((1.0, 2.0, 0.0), (1.2, 2.1, 0.0), (1.3, 2.0, 0.0), (1.0, 2.0, 0.5))
    assert cell_of(grid, at, {}) == cell_of(grid, near, {})
    assert len({cell_of(grid, place, {}) for place in (at, far, above)}) == 3
    assert all(0 <= cell_of(grid, place, {}) < 2**63 for place in (at, far, above, (-1e6, 1e6, 1e-300)))
    assert cell_of(grid, None, {}) == NO_CELL


def test_without_an_outline_the_grid_follows_from_what_was_seen() -> None:
    assert position_grid(None, [(0.0, 0.0, 0.0), (4.0, 1.0, 0.0)]).side == 0.25
    assert position_grid(None, [(3.0, 3.0, 0.0)] * 5).side == 1.0
    assert position_grid(None, []).side == 1.0


def test_signals_have_bins_of_their_ranges_or_of_what_was_seen() -> None:
    signals = (
        Signal("near", "length", 0.0, 64.0),
        Signal("speed", "speed", 0.0, None),
        Signal("open", "bool", None, None),
    )
    grid = signal_grid(signals, [{"near": 3.0, "speed": speed, "open": False} for speed in (0.0, 32.0)])
    assert grid.bools == ("open",)
    assert [(part.name, part.low, part.width) for part in grid.bins] == [("near", 0.0, 1.0), ("speed", 0.0, 0.5)]
    sample = {"near": 3.2, "speed": 1.0, "open": False, "unused": 5}
    same, *others = (
        cell_of(grid, None, {**sample, **change})
        for change in ({"near": 3.9, "unused": 6}, {"near": 4.0}, {"speed": 1.5}, {"open": True}, {"speed": np.inf})
    )
    assert same == cell_of(grid, None, sample)
    assert len({same, *others}) == 5


def test_a_spec_of_bools_is_searched_by_the_other_signals_of_the_game() -> None:
    signals = [Signal("open", "bool", None, None)]
    play = [{"open": False, "x": x, "key": np.False_, "name": "a", "gone": None} for x in (0, 4)]
    grid = signal_grid(signals, play)
    assert (grid.bools, [part.name for part in grid.bins]) == (("open", "key"), ["x"])
    sample = {"open": False, "x": 1, "key": False}
    changes: list[dict[str, Any]] = [{}, {"x": 2}, {"key": True}, {"open": True}]
    assert len({cell_of(grid, None, {**sample, **change}) for change in changes}) == 4
    assert cell_of(grid, None, {"open": False}) == cell_of(grid, None, {"open": False, "x": None})


# --- the plan ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "line"),
    [
        (
            "maze",
            "searches by replaying actions: the game gives no snapshots; "
            "places are values of signals, because the game gives no positions",
        ),
        (
            "outlined",
            "searches by replaying actions: the game gives no snapshots; "
            "places are squares of 0.25 in which the player stands",
        ),
        ("saving", "searches by restoring the game's snapshots; places are squares of "),
    ],
)
def test_the_plan_is_said(game: Path, scene: str, line: str) -> None:
    plan = plan_of(game, scene)
    assert plan.obstacle is None
    assert (plan_line(plan) or "").startswith(line)


@pytest.mark.parametrize(
    ("scene", "variant", "reason"),
    [
        ("maze", "drifting", "equal seeds and actions give different plays: `place` is "),
        ("saving", "drifting", "equal seeds and actions give different plays: `place` is "),
        ("lying", "v0", "`tltl_restore` does not give back what `tltl_snapshot` saved: `place` was "),
        ("failing", "v0", "`tltl_restore` raises OSError: the disk is full"),
    ],
)
def test_what_stands_in_the_way_of_a_search_is_said(game: Path, scene: str, variant: str, reason: str) -> None:
    plan = plan_of(game, scene, variant)
    assert (plan_line(plan) or "").startswith(f"trains from the start alone, without a search: {reason}")
    assert no_search_line(plan).startswith(f"it began without a search for demonstrations, because {reason}")


def test_a_game_that_promises_replays_and_names_its_cells_is_not_played() -> None:
    from tests.runtime.training.tiny_game import GAME as LINE
    from tests.runtime.training.tiny_game import WITH_CELLS

    env = LINE.make_env("line", WITH_CELLS)
    assert search_plan(env, LINE, has_cells=True) == SearchPlan("own")
    assert plan_line(SearchPlan("own")) is None


# --- the search -------------------------------------------------------------------------------------


def searched(
    game: Path, scene: str, workers: int = 1, **changes: int
) -> tuple[list[SuccessfulEpisode], SearchProgress]:
    level = f"{game}:{scene}"
    plan = plan_of(game, scene)
    assert plan.grid is not None
    wrapper = partial(ReturningEnv, game=GAME, grid=plan.grid, snapshots=plan.snapshots)
    info = {**TLTL_INFO, "cell": np.int64}
    env = make_vec(level, "v0", 4, workers, wrapper=wrapper, info=info)
    try:
        settings = replace(SearchSettings(ways=3, steps=20_000, parts=4, imitation=0), **changes)
        search = TrajectorySearch(env, settings, np.random.SeedSequence(7))
        (*_, last) = search.run()
        return search.demonstrations, last
    finally:
        env.close()


@pytest.mark.parametrize("scene", ["maze", "placed", "saving"])
def test_demonstrations_meet_the_spec_when_they_are_replayed(game: Path, scene: str) -> None:
    demonstrations, last = searched(game, scene)
    assert len(demonstrations) >= 3, last
    env = GAME.make_env(f"{game}:{scene}")
    for demonstration in demonstrations:
        env.reset(seed=demonstration.seed)
        infos = [env.step(action)[4] for (action,) in demonstration.actions]
        assert [info["success"] for info in infos] == [False] * (len(infos) - 1) + [True]
    env.close()


def test_snapshots_and_workers_do_not_change_what_is_found(game: Path) -> None:
    replayed, _ = searched(game, "outlined")
    # The squares of this game come from what was seen, so give it the same ones.
    grid = plan_of(game, "outlined").grid
    assert grid is not None
    info = {**TLTL_INFO, "cell": np.int64}
    for workers in (1, 2):
        wrapper = partial(ReturningEnv, game=GAME, grid=grid, snapshots=True)
        env = make_vec(f"{game}:saving", "v0", 4, workers, wrapper=wrapper, info=info)
        settings = SearchSettings(ways=3, steps=20_000, parts=4, imitation=0)
        search = TrajectorySearch(env, settings, np.random.SeedSequence(7))
        list(search.run())
        env.close()
        assert search.demonstrations == replayed


@pytest.fixture(name="returning")
def _returning(game: Path) -> Iterator[ReturningEnv]:
    grid = position_grid(CORNERS, [])
    env = ReturningEnv(partial(GAME.make_env, f"{game}:saving"), game=GAME, grid=grid, snapshots=True)
    yield env
    env.close()


def saving_class(env: ReturningEnv) -> Any:
    return type(env.unwrapped)


def test_a_restored_episode_goes_on_like_a_replayed_one(game: Path, returning: ReturningEnv) -> None:
    random = np.random.default_rng(5)
    actions = random.integers(0, 4, (60, 1))
    plain = ReturningEnv(
        partial(GAME.make_env, f"{game}:placed"), game=GAME, grid=position_grid(CORNERS, []), snapshots=False
    )
    before = saving_class(returning).restored
    for length in (40, 40, 35, 33, 50, 0, 16):
        for env in (returning, plain):
            env.next_start = 4, actions[:length]
        first, second = returning.reset(), plain.reset()
        for action in (None, *actions[length : length + 8, 0]):
            steps = (first, second) if action is None else (returning.step(action), plain.step(action))
            (one, *rest), (other, *others) = steps
            assert {key: value.tolist() for key, value in one.items()} == {
                key: value.tolist() for key, value in other.items()
            }
            assert rest == others
    plain.close()
    assert saving_class(returning).restored - before >= 5


def test_a_restored_episode_keeps_the_limit_of_gymnasium(returning: ReturningEnv) -> None:
    (limit,) = snapshots._limits(returning)
    assert isinstance(limit, TimeLimit)
    actions = np.zeros((40, 1), np.int64)
    for _ in range(2):
        returning.next_start = 4, actions
        returning.reset()
        assert limit._elapsed_steps == 40


def test_a_snapshot_that_fails_later_is_replaced_by_a_replay(
    returning: ReturningEnv, monkeypatch: pytest.MonkeyPatch
) -> None:
    returning.next_start = 4, np.ones((40, 1), np.int64)
    expected, _ = returning.reset()
    monkeypatch.setattr(saving_class(returning), "tltl_restore", lambda env, data: None)
    returning.step(0)
    returning.step(3)
    with pytest.warns(UserWarning, match="TLT0784: the game did not return to a snapshot"):
        again, _ = returning.reset()
    assert {key: value.tolist() for key, value in again.items()} == {
        key: value.tolist() for key, value in expected.items()
    }


def test_an_episode_that_ends_on_the_way_is_replaced_by_another(returning: ReturningEnv) -> None:
    returning.next_start = 4, np.zeros((160, 1), np.int64)
    _, info = returning.reset()
    assert info[UNREPEATED] and info[OTHER_SEED] != 4
    _, again = returning.reset()
    assert again == {key: value for key, value in info.items() if key != UNREPEATED}
    returning.next_start = 4, np.zeros((3, 1), np.int64)
    assert not {UNREPEATED, OTHER_SEED} & returning.reset()[1].keys()


FORGETFUL = """

class Forgetful(Outlined):
    \"\"\"Of LATE seeds, one has episodes that end soon, except for the first one.\"\"\"

    begun = {}

    def reset(self, *, seed=None, options=None):
        answer = super().reset(seed=seed)
        self.steps, self.seed = 0, seed
        self.begun[seed] = self.begun.get(seed, 0) + 1
        return answer

    def step(self, action):
        self.steps += 1
        observation, reward, opened, _, info = super().step(action)
        is_wrong = self.begun[self.seed] > 1 and self.seed % LATE == 0
        return observation, reward, opened, is_wrong and self.steps > 2, info


KINDS["outlined"] = Forgetful
"""


def forgetful(tmp_path: Path, late: int) -> Path:
    """Write the maze whose episodes do not repeat themselves if their seeds are multiples of ``late``."""
    game = maze.write(tmp_path)
    code = tmp_path / "maze.py"
    code.write_text(code.read_text() + FORGETFUL.replace("LATE", str(late)))
    return game


def forgetful_search(game: Path) -> TrajectorySearch:
    wrapper = partial(ReturningEnv, game=GAME, grid=position_grid(CORNERS, []))
    env = make_vec(f"{game}:outlined", "v0", 1, 1, wrapper=wrapper, info={**TLTL_INFO, "cell": np.int64})
    return TrajectorySearch(env, SearchSettings(ways=3, steps=20_000, parts=4, imitation=0), np.random.SeedSequence(7))


def test_places_to_which_a_game_does_not_lead_again_are_left_out(tmp_path: Path) -> None:
    search = forgetful_search(forgetful(tmp_path, 3))
    (*_, last) = search.run()
    search._env.close()
    assert len(last.lengths) >= 3 and last.complete
    assert 0 < last.dropped < 100
    assert (dropped_line(last) or "").startswith(f"the search left out {last.dropped} place")


def test_a_place_is_left_out_once_and_not_if_other_actions_lead_there() -> None:
    archive = _CellArchive(np.random.default_rng(7))
    archive.add(0, 1, 5, [[0], [1]])
    start = archive.draw()
    assert [archive.drop(start), archive.drop(start), bool(archive)] == [True, False, False]
    archive.add(0, 1, 5, [[0], [1]])
    start = archive.draw()
    archive.add(0, 1, 5, [[2]])
    assert [archive.drop(start), bool(archive)] == [False, True]


def test_a_search_ends_if_the_game_does_not_lead_to_most_places_again(tmp_path: Path) -> None:
    search = forgetful_search(forgetful(tmp_path, 1))
    with pytest.raises(TltlError, match="TLT0783: the game does not repeat its episodes") as caught:
        list(search.run())
    search._env.close()
    # A training that is resumed keeps its `ways`.
    assert "begin a new training" in (caught.value.diagnostics[0].help or "")


def test_the_moments_of_an_environment_are_bounded(returning: ReturningEnv, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(snapshots, "_MOST_MOMENTS", 3)
    assert returning._store is not None
    for length in range(1, 9):
        returning.next_start = 4, np.zeros((length, 1), np.int64)
        returning.reset()
    assert len(returning._store._moments) == 3
    assert returning._store._bytes == sum(len(moment.data) for moment in returning._store._moments.values())
    monkeypatch.setattr(snapshots, "_MOST_BYTES", 1)
    returning.next_start = 4, np.ones((9, 1), np.int64)
    returning.reset()
    assert (len(returning._store._moments), returning._store._bytes) == (0, 0)


# --- trainings --------------------------------------------------------------------------------------


def test_learning_alone_does_not_meet_the_spec(game: Path, tmp_path: Path) -> None:
    reports, plans = trained(run_of(tmp_path / "alone", f"{game}:maze", exploration__ways=0, stop__steps=STEPS))
    assert not plans
    assert reports[-1].window.count > 0
    assert reports[-1].window.successes == 0


@pytest.mark.parametrize("scene", ["maze", pytest.param("saving", marks=pytest.mark.slow)])
def test_a_training_finds_what_learning_alone_does_not(game: Path, tmp_path: Path, scene: str) -> None:
    run = run_of(tmp_path / "search", f"{game}:{scene}", exploration__ways=1)
    (*_, report), (plan,) = trained(run)
    assert report.searched is not None
    assert report.searched.lengths
    assert report.searched.steps + report.steps <= STEPS
    assert report.plan == plan
    assert report.iteration.losses["imitation"] > 0
    assert int(checkpoint_of(run).processes[0]["way_seeds"].numel()) >= 1
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, steps=320)))
    (resumed,), _ = trained(longer, resume=True)
    assert resumed.searched == report.searched


@pytest.mark.parametrize(("scene", "variant"), [("maze", "drifting"), ("lying", "v0")])
def test_a_game_that_cannot_be_searched_is_trained_from_its_start(
    game: Path, tmp_path: Path, scene: str, variant: str
) -> None:
    reports, (plan,) = trained(run_of(tmp_path / "run", f"{game}:{scene}", variant))
    assert plan.obstacle is not None
    assert (reports[-1].searched, reports[-1].replayed, reports[-1].stop) == (None, 0, "steps")


@pytest.mark.slow
def test_a_training_of_an_earlier_version_goes_on_without_a_search(game: Path, tmp_path: Path) -> None:
    from tltl_runtime.training.files.checkpoint import write_checkpoint
    from tltl_runtime.training.files.run_file import CHECKPOINT

    run = run_of(tmp_path / "run", f"{game}:maze")
    trained(run)
    checkpoint = checkpoint_of(run)
    processes = tuple({"cpu": process["cpu"]} for process in checkpoint.processes)
    write_checkpoint(run.folder / CHECKPOINT, replace(checkpoint, processes=processes, searched=None))
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, steps=320)))
    (report,), (plan,) = trained(longer, resume=True)
    assert report.searched is None
    assert "without a search: it was begun so" in (plan_line(plan) or "")


COUNTER = Path(__file__).parents[1] / "wire" / "games" / "counter.py"


def write_counter(folder: Path, start: str) -> str:
    """Write the game file of the counter, which is started or found by ``start``, and return its scene."""
    scene = '[[scene]]\nname = "long"\nspec = "counter.tltl:there_and_back"\n'
    (folder / "counter.game.toml").write_text(f"[game]\n{start}\n{scene}")
    (folder / "counter.tltl").write_text(
        "clock 10 Hz\nsignal position in [0, 10] signal at_goal: bool\n"
        "spec there_and_back { reach position < 1 then at_goal  limit 40 steps }"
    )
    return f"{folder / 'counter.game.toml'}:long"


@pytest.mark.slow
def test_a_game_in_another_process_is_searched(tmp_path: Path) -> None:
    level = write_counter(tmp_path, f"process = {json.dumps([sys.executable, str(COUNTER)])}")
    run = run_of(tmp_path / "run", level, rollout__envs=2, stop__steps=64)
    (*_, report), (plan,) = trained(run)
    assert (plan.cells, plan.snapshots, plan.obstacle) == ("positions", True, None)
    assert report.searched is not None
    assert len(report.searched.lengths) >= 3


def test_a_game_that_runs_already_is_not_searched(tmp_path: Path) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    level = write_counter(tmp_path, f'connect = "127.0.0.1:{port}"')

    def connected() -> TltlEnv | None:
        try:
            return GAME.make_env(level)
        except TltlError as error:
            assert "no game listens" in str(error)
            return None

    with subprocess.Popen([sys.executable, str(COUNTER), "--listen", str(port)]) as process:
        try:
            env = until(connected, "the game to listen")
            assert env is not None
            plan = search_plan(env, GAME, has_cells=False)
            env.close()
        finally:
            process.kill()
    assert (plan_line(plan) or "").endswith("the game is running already, and plays for one environment at a time")
