"""The arguments of vector environments: reset masks, actions, spaces, attributes, and scripts without a main guard."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.error import ResetNeeded
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from tests.waiting import HANG_S
from tltl_runtime.vector import WorkerError, WorkerVectorEnv, make_vec
from tltl_runtime.vector.actions import check_batch

COUNT = 3
CART = [partial(gymnasium.make, "CartPole-v1")] * COUNT
UNGUARDED = """
import gymnasium
from tltl_runtime.vector import WorkerVectorEnv

def make():
    return gymnasium.make("CartPole-v1")

WorkerVectorEnv([make] * 2, workers=1)
"""


@pytest.fixture(name="carts")
def _carts() -> Iterator[WorkerVectorEnv]:
    env = WorkerVectorEnv(CART, 2, autoreset="NextStep")
    yield env
    env.close()


def test_a_mask_selects_the_environments_to_reset(carts: WorkerVectorEnv) -> None:
    sync = SyncVectorEnv(CART, autoreset_mode=AutoresetMode.NEXT_STEP)
    mask = np.array([False, True, False])
    with pytest.raises(ResetNeeded, match="reset all environments first"):
        carts.reset(options={"reset_mask": mask})
    for env in (carts, sync):
        env.reset(seed=7)
        for _ in range(4):
            env.step(np.array([0, 1, 1]))
    ours, theirs = (env.reset(seed=3, options={"reset_mask": mask, "low": -0.01})[0] for env in (carts, sync))
    assert np.array_equal(ours, theirs) and np.abs(ours[1, 0]) <= 0.05 and np.abs(ours[0, 1]) > 0.5
    for _ in range(30):
        for our_part, their_part in zip(carts.step(np.ones(3, int))[:4], sync.step(np.ones(3, int))[:4], strict=True):
            assert np.array_equal(our_part, their_part)
    sync.close()


@pytest.mark.parametrize("mask", [[True], np.array([1, 0, 0]), np.zeros(3, dtype=bool), None])
def test_invalid_masks_are_rejected(carts: WorkerVectorEnv, mask: Any) -> None:
    carts.reset(seed=1)
    with pytest.raises(ValueError, match=r"options\['reset_mask'\] must be a bool array of the shape \(3,\) with"):
        carts.reset(options={"reset_mask": mask})


def test_all_actions_are_checked_before_a_step(carts: WorkerVectorEnv) -> None:
    before, _ = carts.reset(seed=1)
    with pytest.raises(ValueError, match=r"the action of env 2 is 2, which is not in Discrete\(2\)"):
        carts.step([0, 1, 2])
    with pytest.raises(ValueError, match=r"actions of Discrete\(2\) must be int64, not float64"):
        carts.step(np.zeros(3))
    assert np.array_equal(carts.call("state")[0].astype(np.float32), before[0])


MULTI = spaces.MultiDiscrete([3, 2])


@pytest.mark.parametrize(
    ("space", "batch", "text"),
    [
        (MULTI, [[0, 0], [3, 0]], r"env 1 is \[3, 0\], which is not in MultiDiscrete"),
        (MULTI, [[0, -1], [0, 0]], r"env 0 is \[0, -1\]"),
        (MULTI, [[0, 0]], r"shape \(2, 2\), not \(1, 2\)"),
        (spaces.Discrete(2, start=5), [5, 4], "env 1 is 4"),
        (spaces.MultiBinary(2), np.array([[0, 1], [2, 0]], dtype=np.int8), "env 1 is"),
        (spaces.Dict(move=MULTI), {"go": [[0, 0]] * 2}, "must have the keys move"),
        (spaces.Tuple((MULTI,)), ([[0, 0]] * 2, 1), "number of parts of a batch of actions must be 1, not 2"),
        (spaces.Dict(move=MULTI), {"move": [[0, 0], [0, 2]]}, r"env 1 is \[0, 2\]"),
    ],
)
def test_an_action_outside_its_space_is_named(space: spaces.Space[Any], batch: Any, text: str) -> None:
    with pytest.raises(ValueError, match=text):
        check_batch(space, batch, 2)


@pytest.mark.parametrize("space", [MULTI, spaces.Discrete(2, start=5), spaces.MultiBinary(2), spaces.Box(-1, 1, (2,))])
def test_actions_in_their_space_are_accepted(space: spaces.Space[Any]) -> None:
    check_batch(space, [space.sample(), space.sample()], 2)
    check_batch(spaces.Dict(one=space), {"one": np.array([space.sample(), space.sample()])}, 2)


def test_environments_with_different_spaces_are_rejected() -> None:
    with pytest.raises(WorkerError, match="the observation_space of env 1 differs from that of env 0"):
        WorkerVectorEnv([CART[0], partial(gymnasium.make, "MountainCar-v0")], 2)


def test_attributes_can_be_read_and_set(carts: WorkerVectorEnv) -> None:
    carts.set_attr("masspole", 0.2)
    assert carts.get_attr("masspole") == (0.2,) * 3
    carts.set_attr("masspole", [0.1, 0.2, 0.3])
    assert carts.get_attr("masspole") == (0.1, 0.2, 0.3)
    with pytest.raises(ValueError, match="the number of values must be 3, not 2"):
        carts.set_attr("masspole", [0.1, 0.2])


def test_arguments_of_the_wrong_type_are_rejected() -> None:
    with pytest.raises(TypeError, match="workers must be a whole number or 'ray', not '2'"):
        WorkerVectorEnv(CART, "2")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="expected functions that make environments"):
        WorkerVectorEnv([gymnasium.make("CartPole-v1")])  # type: ignore[list-item]
    with pytest.raises(ValueError, match="render_mode 'human' shows one environment"):
        make_vec("navigation", num_envs=2, render_mode="human")


@pytest.mark.parametrize("how", ["file", "stdin"])
def test_a_script_without_a_main_guard_gets_a_hint(how: str, tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED, encoding="utf-8")
    arguments = [str(script)] if how == "file" else []
    with script.open(encoding="utf-8") as file:
        done = subprocess.run([sys.executable, *arguments], stdin=file, capture_output=True, text=True, timeout=HANG_S)
    last = done.stderr.rpartition("WorkerError: ")[2]
    assert "worker 0 ended with exit status 1" in last
    assert 'the program under\n`if __name__ == "__main__":`, and put the program into a file' in last
