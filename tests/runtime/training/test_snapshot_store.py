"""The snapshots that a search keeps, and those that a game in another process may let go."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.spec.wrapper import TltlEnv
from tltl_runtime.training.exploration import snapshots
from tltl_runtime.training.exploration.returning_env import ReturningEnv
from tltl_runtime.training.exploration.snapshots import SavedMoment, SnapshotStore
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame
from tltlc.api import replace

COUNTER = WireGame(
    "counter", ROOT / "tests/runtime/wire/games", (sys.executable, "counter.py"), start_s=HANG_S, step_s=HANG_S
)


def make(spec: Path) -> TltlEnv:
    return TltlEnv(WireEnv(COUNTER, scene="long"), spec)


@pytest.fixture(name="env")
def _env(tmp_path: Path) -> Iterator[ReturningEnv]:
    (tmp_path / "count.tltl").write_text("signal at_goal: bool\nspec count = F at_goal\n", encoding="utf-8")
    env = ReturningEnv(partial(make, tmp_path / "count.tltl"), game=GAME, grid=None, snapshots=True)
    yield env
    env.close()


def arrive(env: ReturningEnv, seed: int) -> bytes:
    """Go two steps from a seed, and return the snapshot that was saved there."""
    env.next_start = seed, np.array([[2], [2]])
    env.reset()
    assert env._store is not None
    return next(reversed(env._store._moments.values())).data


def test_a_search_releases_the_snapshots_that_it_forgets(env: ReturningEnv, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(snapshots, "_MOST_MOMENTS", 1)
    monkeypatch.setattr(snapshots, "_MOST_TAKEN", 1)
    first, second = arrive(env, 0), arrive(env, 1)
    env.step(1)
    env.get_wrapper_attr("tltl_restore")(second)
    assert env.get_wrapper_attr("tltl_signals")()["position"] == 4
    with pytest.raises(WireError, match="there is no snapshot 1"):
        env.get_wrapper_attr("tltl_restore")(first)


def test_a_snapshot_is_released_once_no_moment_has_it(env: ReturningEnv) -> None:
    arrive(env, 0)
    assert env._store is not None
    (moment,) = env._store._moments.values()
    released: list[bytes] = []
    store = SnapshotStore(released.append)

    def named(data: bytes) -> SavedMoment:
        return replace(moment, data=data)

    store.add(1, b"a", named(b"one"))
    store.add(1, b"ab", named(b"one"))
    store.add(1, b"a", named(b"two"))
    assert released == []
    store.add(1, b"ab", named(b"two"))
    assert released == [b"one"]
    store.add(1, b"ab", named(b"two"))
    assert released == [b"one"]
    store.clear()
    assert released == [b"one", b"two"]


def test_a_game_that_releases_no_snapshots_is_asked_for_a_bounded_number(
    env: ReturningEnv, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(snapshots, "_MOST_TAKEN", 1)
    arrive(env, 0)
    assert env._store is not None and not env._store.is_used_up
    (moment,) = env._store._moments.values()
    store = SnapshotStore()
    store.add(1, b"", moment)
    assert store.is_used_up
