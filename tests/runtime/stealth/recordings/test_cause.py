"""Why episodes ended: who dealt the damage, which atoms broke and what remained, from recordings alone."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.recordings.cause import _damage_rates, cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.world.player import DECISION
from tltlc.core.record import replace


def play_carelessly(level: str, seed: int, spec: Path | None = None) -> Episode:
    env = RecordEpisode(make_env(level, spec=spec), "careless expert")
    play_episode(env, Expert(env, careful=False), seed)
    episode = env.episode
    env.close()
    return episode


def repeat_action(level: str, action: list[int], steps: int, seed: int, spec: str | None = None) -> Episode:
    """Repeat an action for ``steps`` steps, or to the end of the episode."""
    env = RecordEpisode(make_env(level, spec=spec), "hand")
    env.reset(seed=seed)
    for _ in range(steps):
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            break
    episode = env.episode
    env.close()
    return episode


def test_a_guard_that_kills_is_named() -> None:
    result = cause(play_carelessly("cover_and_hide", 1))
    assert (result.kind, result.by, result.broke) == ("killed", ("guard",), ("alive",))
    x, y, _ = result.place
    assert result.text == f"killed by `guard` at {result.time:.2f} s at ({x:.1f}, {y:.1f})"


@pytest.mark.parametrize(("level", "seed"), [("cover_and_hide", 1), ("branching", 0), ("branching", 3)])
def test_the_recorded_damage_accounts_for_all_lost_health(level: str, seed: int) -> None:
    episode = play_carelessly(level, seed)
    for before, after in pairwise(episode.snapshots):
        if after.health > 0.0:
            damage = sum(_damage_rates(episode.level, before, after).values()) * DECISION
            assert damage == pytest.approx(before.health - after.health, abs=1e-9)


def test_a_laser_that_kills_is_named() -> None:
    """Walk to the laser of branching, north-east of the start, and stay there."""
    env = RecordEpisode(make_env("branching"), "hand")
    env.reset(seed=2)
    laser = next(barrier for barrier in env.get_wrapper_attr("level").barriers if barrier.kind == "laser")
    over, steps = False, 0
    while not over and steps < 200:
        x, y, _ = env.get_wrapper_attr("game").world.player.position
        goal = (laser.box.low[0] + 0.05, (laser.box.low[1] + laser.box.high[1]) / 2)
        action = [int(np.sign(round(there - here, 1))) % 3 for here, there in ((x, goal[0]), (y, goal[1]))]
        _, _, terminated, truncated, _ = env.step([*action, 0, 0, 0])
        over, steps = terminated or truncated, steps + 1
    result = cause(env.episode)
    env.close()
    assert (result.kind, result.by) == ("killed", ("laser",))
    assert result.text.startswith("burnt by the laser `laser` at ")


def test_the_atom_that_broke_is_named(tmp_path: Path) -> None:
    spec = tmp_path / "still.tltl"
    spec.write_text(
        "import stealth\nentity s1\nspec still { limit 90 steps\n keep !near(s1) }\n",
        encoding="utf-8",
    )
    episode = repeat_action("navigation", [1, 2, 0, 0, 0], 90, 1, str(spec))
    result = cause(episode)
    assert (result.kind, result.by, result.broke) == ("violated", ("near(s1)",), ("near(s1)",))
    assert result.text.endswith("): near(s1) holds")


def test_an_atom_that_reads_the_health_explains_a_death(tmp_path: Path) -> None:
    """The spec keeps a second atom, which is changed to break at the same step."""
    within = "signal position.x: length\npredicate within in [-1, 1] = clamp(1 - position.x / 100 m, -1, 1)\n"
    episode = play_carelessly("cover_and_hide", 1, write_spec(tmp_path, within, "keep within\n keep alive"))
    names = [atom.name for atom in episode.fspa.atoms]
    atoms = episode.atoms.copy()
    assert names.index("within") < names.index("alive") and atoms[-1, names.index("alive")] <= 0.0
    atoms[-1, names.index("within")] = -1.0
    assert cause(replace(episode, atoms=atoms)).broke == ("alive",)


def test_a_death_that_the_spec_allows_breaks_nothing() -> None:
    """The episode ended at its limit, without a transition into a trap."""
    result = cause(replace(play_carelessly("cover_and_hide", 1), end="limit"))
    assert (result.kind, result.by, result.broke) == ("killed", ("guard",), ())


def write_spec(folder: Path, declared: str, kept: str) -> Path:
    """Write a spec for the route through `cover_and_hide`, with conditions to keep."""
    path = folder / "way.tltl"
    path.write_text(
        f"import stealth\nentity s1, s2, exit\nexclusive near(s1), near(s2), near(exit)\n{declared}"
        f"spec way {{ limit 400 steps\n {kept}\n reach near(s1) then near(s2) then near(exit) }}\n",
        encoding="utf-8",
    )
    return path


def test_what_remains_is_reported(tmp_path: Path) -> None:
    spec = tmp_path / "short.tltl"
    spec.write_text("import stealth\nentity exit\nspec short { limit 4 steps\n reach near(exit) }\n", encoding="utf-8")
    episode = repeat_action("cover_and_hide", [0, 0, 0, 0, 0], 9, 1, str(spec))
    assert cause(episode).text == "limit after 4 steps, remaining: Reach near(exit)"
    stopped = repeat_action("cover_and_hide", [0, 0, 0, 0, 0], 2, 1, str(spec))
    assert cause(stopped).text == "stopped after 0.30 s, remaining: Reach near(exit)"


def test_a_goal_without_a_route_for_the_expert_is_reported(tmp_path: Path) -> None:
    """In branching, the middle of the level lies behind the gate `right`, which is shut until a switch is pressed."""
    spec = tmp_path / "beyond.tltl"
    spec.write_text(
        "import stealth\nentity e_right\nspec beyond { limit 3 steps\n reach near(e_right) }\n", encoding="utf-8"
    )
    result = cause(play_carelessly("branching", 1, spec))
    assert (result.kind, result.by) == ("no way", ("e_right",))
    assert result.text == "the expert finds no way to `e_right`; limit after 3 steps, remaining: Reach near(e_right)"


def test_success_is_reported_as_the_cause() -> None:
    result = cause(play_carelessly("branching", 1))
    assert (result.kind, result.by) == ("success", ()) and result.text.startswith("success after ")
