"""The whole game on the shipped levels: repeatability, switches and barriers, signals, and players that stay inside."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import tltlc
from tltl_runtime.stealth.level import Point, StealthLevel
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltl_runtime.stealth.simulation import Simulation
from tltl_runtime.stealth.snapshot import BRANCHES

ROOT = Path(__file__).parents[3]

ALL = [(name, variant) for name in level_names() for variant in variants(name)]


@pytest.fixture(params=ALL, ids=lambda pair: "-".join(pair))
def game(request: pytest.FixtureRequest) -> Iterator[Simulation]:
    game = Simulation(load_level(*request.param))
    yield game
    game.close()


def random_actions(seed: int, count: int) -> list[list[int]]:
    rng = np.random.default_rng(seed)
    return [[int(rng.integers(size)) for size in BRANCHES] for _ in range(count)]


def test_random_play_stays_within_all_bounds(game: Simulation) -> None:
    low, high = game.level.bounds.low, game.level.bounds.high
    for seed in range(2):
        game.reset(seed)
        for action in random_actions(seed, 150):
            game.step(action)
            signals = dict(game.signals())
            assert all(map(math.isfinite, signals.values()))
            assert all(low[i] <= game.world.player.position[i] <= high[i] for i in range(3))
            assert 0.0 <= game.health <= 1.0 and 0.0 <= signals["stamina"] <= 1.0


def test_a_seed_reproduces_an_episode(game: Simulation) -> None:
    runs = []
    for _ in range(2):
        game.reset(7)
        snapshots = []
        for action in random_actions(3, 60):
            game.step(action)
            snapshots.append(game.snapshot())
        runs.append(snapshots)
        game.reset(8)  # another episode in between must not matter
        for action in random_actions(4, 10):
            game.step(action)
    assert runs[0] == runs[1]


def game_at(level: StealthLevel, place: Point) -> Simulation:
    """Return a game whose player starts at a place."""
    from tltlc.core.record import replace

    return Simulation(replace(level, start=replace(level.start, position=place, spread=0.0)))


def test_a_switch_opens_its_barrier() -> None:
    level = load_level("cover_and_hide")
    s1 = level.switches[0]
    game = game_at(level, s1.position)
    opened = [index for index, barrier in enumerate(level.barriers) if barrier.opened_by == (s1.name,)]
    assert opened and not any(game.open)
    game.step([0, 0, 0, 0, 0])
    assert game.active[0] and all(game.open[index] for index in opened)
    assert game.signals()[f"active({s1.name})"] == 1.0
    assert game.signals()[f"open({level.barriers[opened[0]].name})"] == 1.0
    game.close()


def test_the_third_switch_unlocks_one_of_two_barriers() -> None:
    level = load_level("branching")
    unlock = level.unlocks[0]
    place = next(switch.position for switch in level.switches if switch.name == unlock.switch)
    game = game_at(level, place)
    unlocked = set()
    for seed in range(12):
        game.reset(seed)
        game.step([0, 0, 0, 0, 0])
        opened = [barrier.name for barrier, is_open in zip(level.barriers, game.open, strict=True) if is_open]
        assert len(opened) == 1
        unlocked.update(opened)
        assert [game.signals()["open_right"], game.signals()["open_left"]].count(1.0) == 1
    assert unlocked == set(unlock.barriers)
    game.close()


def test_a_laser_burns() -> None:
    level = load_level("branching")
    laser = next(barrier for barrier in level.barriers if barrier.kind == "laser")
    low, high = laser.box.low, laser.box.high
    game = game_at(level, ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0.0))
    game.step([0, 0, 0, 0, 0])
    assert game.health < 1.0
    game.close()


@pytest.mark.parametrize("name", level_names())
def test_each_level_supplies_the_signals_of_its_spec(name: str) -> None:
    level = load_level(name)
    assert level.spec is not None
    automata = tltlc.compile_file(ROOT / "examples" / level.spec.file)
    (fspa,) = (automaton for automaton in automata if automaton.name == level.spec.name)
    game = Simulation(level)
    assert {signal.name for signal in fspa.signals} <= set(game.signals())
    game.close()
