"""Why episodes ended: who took the health, what broke, what remained, found in recordings alone."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.expert.expert import Expert, play_episode
from tltl_runtime.stealth.recording import RecordEpisode
from tltl_runtime.stealth.recordings.cause import _blows, cause
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.world.player import DECISION
from tltlc.core.record import replace


def careless(level: str, seed: int, spec: Path | None = None) -> Episode:
    env = RecordEpisode(make_env(level, spec=spec), "careless expert")
    play_episode(env, Expert(env, careful=False), seed)
    episode = env.episode
    env.close()
    return episode


def walked(level: str, action: list[int], steps: int, seed: int, spec: str | None = None) -> Episode:
    """One action again and again, to the end or for so many steps."""
    env = RecordEpisode(make_env(level, spec=spec), "hand")
    env.reset(seed=seed)
    for _ in range(steps):
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            break
    episode = env.episode
    env.close()
    return episode


def test_a_guard_kills() -> None:
    why = cause(careless("cover_and_hide", 1))
    assert (why.kind, why.by, why.broke) == ("killed", ("guard",), ("alive",))
    x, y, _ = why.place
    assert why.text == f"killed by `guard` at {why.time:.2f} s at ({x:.1f}, {y:.1f})"


@pytest.mark.parametrize(("level", "seed"), [("cover_and_hide", 1), ("branching", 0), ("branching", 3)])
def test_what_is_seen_accounts_for_all_the_health(level: str, seed: int) -> None:
    episode = careless(level, seed)
    for before, after in pairwise(episode.snapshots):
        if after.health > 0.0:
            taken = sum(_blows(episode.level, before, after).values()) * DECISION
            assert taken == pytest.approx(before.health - after.health, abs=1e-9)


def test_a_laser_burns() -> None:
    """The player is led to the laser of branching, which is north-east of where it starts, and stays."""
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
    why = cause(env.episode)
    env.close()
    assert (why.kind, why.by) == ("killed", ("laser",))
    assert why.text.startswith("burnt by the laser `laser` at ")


def test_what_broke_is_named(tmp_path: Path) -> None:
    spec = tmp_path / "still.tltl"
    spec.write_text(
        "import stealth\nentity s1\nspec still { limit 90 steps\n keep !near(s1) }\n",
        encoding="utf-8",
    )
    episode = walked("navigation", [1, 2, 0, 0, 0], 90, 1, str(spec))
    why = cause(episode)
    assert (why.kind, why.by, why.broke) == ("violated", ("near(s1)",), ("near(s1)",))
    assert why.text.endswith("): near(s1) holds")


def test_of_what_broke_at_a_death_what_reads_the_health_is_named(tmp_path: Path) -> None:
    """The spec has another atom that is kept, which is made to break at the same moment."""
    within = "signal position.x: length\npredicate within in [-1, 1] = clamp(1 - position.x / 100 m, -1, 1)\n"
    episode = careless("cover_and_hide", 1, way(tmp_path, within, "keep within\n keep alive"))
    names = [atom.name for atom in episode.fspa.atoms]
    atoms = episode.atoms.copy()
    assert names.index("within") < names.index("alive") and atoms[-1, names.index("alive")] <= 0.0
    atoms[-1, names.index("within")] = -1.0
    assert cause(replace(episode, atoms=atoms)).broke == ("alive",)


def test_a_death_that_the_spec_allows_breaks_nothing() -> None:
    """Time was up then, and no transition into a trap was taken."""
    why = cause(replace(careless("cover_and_hide", 1), end="limit"))
    assert (why.kind, why.by, why.broke) == ("killed", ("guard",), ())


def way(folder: Path, declared: str, kept: str) -> Path:
    """A spec of the way through `cover_and_hide`, with what is to be kept."""
    path = folder / "way.tltl"
    path.write_text(
        f"import stealth\nentity s1, s2, exit\nexclusive near(s1), near(s2), near(exit)\n{declared}"
        f"spec way {{ limit 400 steps\n {kept}\n reach near(s1) then near(s2) then near(exit) }}\n",
        encoding="utf-8",
    )
    return path


def test_what_remained_is_told(tmp_path: Path) -> None:
    spec = tmp_path / "short.tltl"
    spec.write_text("import stealth\nentity exit\nspec short { limit 4 steps\n reach near(exit) }\n", encoding="utf-8")
    episode = walked("cover_and_hide", [0, 0, 0, 0, 0], 9, 1, str(spec))
    assert cause(episode).text == "limit after 4 steps, remaining: Reach near(exit)"
    stopped = walked("cover_and_hide", [0, 0, 0, 0, 0], 2, 1, str(spec))
    assert cause(stopped).text == "stopped after 0.30 s, remaining: Reach near(exit)"


def test_the_expert_tells_what_it_finds_no_way_to(tmp_path: Path) -> None:
    """`right` is a gate of branching that the middle of the level lies behind, and shut until a switch is pressed."""
    spec = tmp_path / "beyond.tltl"
    spec.write_text(
        "import stealth\nentity e_right\nspec beyond { limit 3 steps\n reach near(e_right) }\n", encoding="utf-8"
    )
    why = cause(careless("branching", 1, spec))
    assert (why.kind, why.by) == ("no way", ("e_right",))
    assert why.text == "finds no way to `e_right`; limit after 3 steps, remaining: Reach near(e_right)"


def test_success_is_its_own_cause() -> None:
    why = cause(careless("branching", 1))
    assert (why.kind, why.by) == ("success", ()) and why.text.startswith("success after ")
