"""A player who watches an enemy predicts its actions, as far as they are determined."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager

import numpy as np
import pytest

from tltl_runtime.stealth.expert.enemy_prediction import Watch
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.simulation import Simulation

STAY = (0, 0, 0, 0, 0)


@contextmanager
def watched(name: str, variant: str, decisions: int) -> Iterator[tuple[Simulation, Watch]]:
    """Yield a game that was watched for ``decisions`` steps by a player who stands still, out of sight."""
    with closing(Simulation(load_level(name, variant))) as game:
        game.reset(11)
        watch = Watch(game.level)
        watch.see(game.snapshot())
        for _ in range(decisions):
            game.step(STAY)
            watch.see(game.snapshot())
        yield game, watch


@pytest.mark.parametrize("name", ["cover_and_hide", "branching"])
@pytest.mark.parametrize("decisions", [0, 37])
def test_patrols_are_predicted_exactly(name: str, decisions: int) -> None:
    with watched(name, "v0", decisions) as (game, watch):
        outlooks = watch.outlook(60)
        for step in range(60):
            game.step(STAY)
            if "patrol" not in game.snapshot().modes:
                break
            for outlook, (x, y, _), yaw in zip(outlooks, game.enemies.positions, game.enemies.yaws, strict=True):
                assert outlook.shares.tolist() == [1.0]
                assert outlook.poses[0, step] == pytest.approx((x, y, yaw, 0.0), abs=1e-9)


def test_a_model_predicts_which_gap_is_visited_next() -> None:
    with watched("cover_and_hide", "v2", 20) as (game, watch):
        surprises = 0
        for _ in range(250):
            game.step(STAY)
            surprises += watch.see(game.snapshot())
        # There are three choices each time, and twelve models. It is rare that no model is right.
        assert surprises <= 3
        outlook = watch.outlook(80)[0]
        assert len(outlook.poses) > 1
        first = np.ptp(outlook.poses[:, 0, :2], axis=0).max()
        last = np.ptp(outlook.poses[:, -1, :2], axis=0).max()
        assert first < 0.3 < last


def test_a_late_watcher_learns_where_the_enemy_goes() -> None:
    with closing(Simulation(load_level("cover_and_hide"))) as game:
        game.reset(11)
        for _ in range(50):
            game.step(STAY)
        watch = Watch(game.level)
        assert watch.see(game.snapshot())
        for _ in range(25):
            game.step(STAY)
            watch.see(game.snapshot())
        outlook = watch.outlook(20)[0]
        for _ in range(20):
            game.step(STAY)
        x, y, _ = game.enemies.positions[0]
        errors = np.hypot(outlook.poses[:, -1, 0] - x, outlook.poses[:, -1, 1] - y)
        assert (errors * outlook.shares).sum() < 0.3
