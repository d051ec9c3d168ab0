"""Predicted motion agrees with the physics to a few centimetres."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from tltl_runtime.stealth.expert.motion import Motion, Poses, concatenate, poses_of
from tltl_runtime.stealth.level import Box
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import World
from tltl_runtime.stealth.world.player import PlayerKind

DECISIONS = 400


@pytest.fixture(name="world")
def _world() -> Iterator[World]:
    world = World(load_level("navigation"))
    yield world
    world.close()


def _motion(world: World) -> Motion:
    return Motion(world.kind, [obstacle.box for obstacle in (*world.level.solids, *world.level.barriers)])


def test_the_prediction_of_random_play_agrees_with_the_physics(world: World) -> None:
    """Each prediction starts from the state in the physics. A few landings and stairs have larger errors."""
    motion, rng = _motion(world), np.random.default_rng(0)
    world.reset(None)
    before, actions, after = [], [], []
    for step in range(DECISIONS):
        if step % 4 == 0:
            action = rng.integers(0, [3, 3, 2, 2, 2])
        before.append(poses_of(world.player))
        world.step(action.tolist())
        actions.append(action)
        after.append(world.player.position)
    predicted, _ = motion.step(concatenate(before), np.array(actions))
    errors = np.abs(np.stack([predicted.x, predicted.y, predicted.z], axis=1) - np.array(after)).max(axis=1)
    assert np.quantile(errors, 0.5) < 0.005
    assert np.quantile(errors, 0.95) < 0.05


def test_bodies_do_not_affect_each_other(world: World) -> None:
    motion = _motion(world)
    alone = poses_of(world.player)
    far = Poses(*(np.array([value]) for value in (20.0, 9.0, 1.5, 0.0, False, True, 1.0)))
    action = np.array([[1, 0, 1, 0, 1]])
    predicted_alone, _ = motion.step(alone, action)
    predicted_together, _ = motion.step(concatenate([alone, far]), np.repeat(action, 2, axis=0))
    assert (predicted_alone.x[0], predicted_alone.y[0], predicted_alone.z[0]) == pytest.approx(
        (predicted_together.x[0], predicted_together.y[0], predicted_together.z[0]), abs=1e-9
    )


def test_a_walk_into_a_mover_touches_it_and_a_jump_over_it_does_not() -> None:
    floor, bar = Box((-9.0, -9.0, -1.0), (9.0, 9.0, 0.0)), Box((0.6, -1.0, 0.0), (0.8, 1.0, 0.2))
    motion = Motion(PlayerKind(), [floor])
    start = Poses(*(np.zeros(2), np.zeros(2), np.array([0.0, 0.4]), np.array([0.0, 5.0])), *_stances(2))
    _, touched = motion.step(start, np.array([[1, 0, 0, 0, 0], [1, 0, 0, 0, 0]]), [bar])
    assert touched.tolist() == [True, False]


def _stances(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The crouching, grounded and stamina columns of bodies, of which only the first is on the ground."""
    return np.zeros(count, dtype=np.bool_), np.arange(count) == 0, np.ones(count)
