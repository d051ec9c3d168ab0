"""Random steps in every variant. ``benchmarks/safety.py`` takes a million of them."""

from __future__ import annotations

import pytest

from benchmarks import safety
from benchmarks.variants import variants_of_all
from tltl_runtime.stealth.env import GameEnv
from tltl_runtime.stealth.world.physics import WorldError
from tltlc.core.record import replace

STEPS = 2_300


@pytest.mark.parametrize("level, variant", variants_of_all())
def test_the_player_passes_no_wall_and_stays_in_bounds(level: str, variant: str) -> None:
    record = safety.play_random_steps(level, variant, STEPS)
    assert (record["steps"], record["episodes"], record["checks"]) == (STEPS, 6, 11)
    assert 0.0 < record["deepest_m"] < safety.DEEPEST


def test_a_missing_wall_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The world is built without the walls of its level."""
    env = GameEnv("navigation")
    complete = env.level
    without_walls = replace(complete, solids=tuple(solid for solid in complete.solids if solid.kind != "wall"))
    env.close()
    monkeypatch.setattr("tltl_runtime.stealth.env.load_level", lambda *_: without_walls)
    begin = safety._begin_episode

    def begin_with_complete_level(env: GameEnv, _: object, rng: object, *, anywhere: bool) -> None:
        begin(env, complete, rng, anywhere=anywhere)  # type: ignore[arg-type]

    monkeypatch.setattr(safety, "_begin_episode", begin_with_complete_level)
    with pytest.raises(WorldError, match="a ray does not hit its side"):
        safety.play_random_steps("navigation", "v0", 10)


def test_a_player_inside_a_box_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(safety, "DEEPEST", -1.0)
    with pytest.raises(safety.Violation, match=r"navigation v0, seed \d+, step 0: the player at .* m inside a box"):
        safety.play_random_steps("navigation", "v0", 10)
