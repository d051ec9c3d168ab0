"""The example of Godot: its scenes, the monitor inside the game, its snapshots, and its trained agents."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from random import Random
from typing import Any

import pytest
from matplotlib.path import Path as MapPath

from tests.interfaces.cli.conftest import ROOT, Outcome, tltlc  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime import read_tape
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.scene_env import make_scene_env
from tltl_runtime.spec.task import load_task
from tltl_runtime.wire.clients import tltl_client
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.wire_game import WireGame

Run = Callable[..., Outcome]
FOLDER = ROOT / "examples" / "godot_game"
GAME_FILE = FOLDER / "keep.game.toml"
PROJECT = FOLDER / "project"
CLIENT = Path(tltl_client.__file__).with_name("tltl_client_godot3.gd")
SPECS = {"courtyard": "fetch", "pier": "ride"}
SCENES = [(scene.name, variant) for scene in read_game_file(GAME_FILE).scenes for variant in scene.variants]

needs_engine = pytest.mark.skipif(shutil.which("godot3-server") is None, reason="needs the program godot3-server")


def game(*words: str) -> WireGame:
    """Return the game, started with more words on its command line."""
    wire = read_game_file(GAME_FILE).wire
    assert wire is not None
    return WireGame("keep", FOLDER, process=(*wire.process, *words))


def actions(seed: int) -> Iterator[list[int]]:
    """Yield random actions, each held for some steps."""
    random = Random(seed)
    while True:
        action = [random.randrange(3), random.randrange(3)]
        for _ in range(random.randrange(1, 12)):
            yield action


def test_the_game_has_a_copy_of_the_client() -> None:
    assert (PROJECT / CLIENT.name).read_bytes() == CLIENT.read_bytes()


@pytest.mark.parametrize("spec", SPECS.values())
def test_the_monitors_inside_the_game_are_those_of_the_specs(tltlc: Run, tmp_path: Path, spec: str) -> None:  # noqa: F811
    result = tltlc("compile", f"{FOLDER / 'keep.tltl'}:{spec}", "--target", "gdscript3", "-o", tmp_path)
    assert result.status == 0, result.err
    name = f"{spec}_monitor.gd"
    assert (PROJECT / name).read_text(encoding="utf-8") == (tmp_path / name).read_text(encoding="utf-8")


@needs_engine
@pytest.mark.parametrize(("scene", "variant"), SCENES)
def test_a_scene_can_be_played_and_says_where_things_are(scene: str, variant: str) -> None:
    env = make_scene_env(GAME_FILE, scene, variant)
    observation, _ = env.reset(seed=3)
    assert env.observation_space.contains(observation)
    positions = env.get_wrapper_attr("tltl_positions")()
    assert {"player", "ferry", "beacon"} <= positions.keys()
    assert ("guard_1" in positions) == (scene == "courtyard")
    env.close()


@needs_engine
@pytest.mark.parametrize(("scene", "variant"), SCENES)
def test_players_stay_out_of_the_walls_of_the_outline_and_fall_into_its_chasm(scene: str, variant: str) -> None:
    env = make_scene_env(GAME_FILE, scene, variant)
    moves, fallen = actions(2), 0
    for seed in range(30):
        env.reset(seed=seed)
        outline = env.get_wrapper_attr("scene_outline")()
        assert len(outline.boxes) == (6 if scene == "courtyard" else 3)
        areas = {area.name: MapPath(area.corners) for area in outline.polygons}
        ended, step = False, 0
        while not ended and step < 80:
            _, _, ended, _, _ = env.step(next(moves))
            step += 1
            x, y, z = env.get_wrapper_attr("tltl_positions")()["player"]
            for name, box in ((item.name, item.box) for item in outline.boxes):
                inside = box.low[0] < x < box.high[0] and box.low[1] < y < box.high[1]
                assert not inside, (name, x, y)
            if z < -0.1:
                fallen += 1
                assert areas["chasm"].contains_point((x, y)), (x, y)
                break
    assert fallen or scene == "courtyard", "nobody comes to the chasm without a key"
    env.close()


@needs_engine
@pytest.mark.parametrize("scene", SPECS)
def test_the_monitor_inside_says_the_same_as_the_one_outside_at_each_step(scene: str, tmp_path: Path) -> None:
    log = tmp_path / "log"
    env = WireEnv(game(f"log={log}"), scene=scene)
    monitor = load_task(f"{FOLDER / 'keep.tltl'}:{SPECS[scene]}", {}, None).monitor()
    expected: list[tuple[Any, ...]] = []
    moves = actions(5)
    for seed in range(12):
        env.reset(seed=seed)
        monitor.reset()
        expected.append(("begin", scene))
        ended = False
        for _ in range(60):
            if ended:
                break
            _, _, ended, _, _ = env.step(next(moves))
            step = monitor.step(env.tltl_signals())
            expected.append((step.state, step.progress, step.reward, step.robustness, step.verdict))
    env.close()
    lines = [line.split(",") for line in log.read_text(encoding="utf-8").splitlines()]
    inside: list[tuple[Any, ...]] = [
        ("begin", line[1]) if line[0] == "begin" else (int(line[0]), *map(float, line[1:4]), line[4]) for line in lines
    ]
    assert inside == expected
    assert len({line[4] for line in inside if line[0] != "begin"}) > 1


# With the seed 73 the guard sees the player in the first step of all, if his ray already hits the player.
@needs_engine
@pytest.mark.parametrize("seed", [11, 73])
def test_the_tape_of_a_person_is_the_play_of_an_agent_with_the_same_actions(tmp_path: Path, seed: int) -> None:
    shutil.copytree(PROJECT, tmp_path / "project")
    script = tmp_path / "project" / "keep.gd"
    source = script.read_text(encoding="utf-8")
    assert "var seed_ = randi()" in source
    source = source.replace("var seed_ = randi()", f"var seed_ = {seed}")
    person = """

func _process(_delta) -> void:
	var frame = Engine.get_physics_frames()
	for key in ["ui_right", "ui_left", "ui_up", "ui_down"]:
		if (frame / 7 + key.length()) % 3 == 0:
			Input.action_press(key)
		else:
			Input.action_release(key)
	if frame > 150:
		get_tree().quit()
"""
    script.write_text(source + person, encoding="utf-8")
    words = ["godot3-server", "--path", "project", "--fixed-fps", "10", "--disable-render-loop"]
    variables = {name: value for name, value in os.environ.items() if name != "TLTL_PORT"}
    variables["XDG_DATA_HOME"] = str(tmp_path / "data")
    subprocess.run(words, cwd=tmp_path, env=variables, timeout=HANG_S, check=True)
    tapes = [read_tape(path) for path in sorted((tmp_path / "data").rglob("*.tape.jsonl"))]
    assert sum(len(tape.steps) for tape in tapes) > 100
    assert tapes[0].steps[0].signals["seen"] == (seed == 73)
    env = WireEnv(game(), scene="courtyard")
    for tape in tapes:
        assert (tape.header.game, tape.header.scene, tape.header.clock_hz) == ("keep", "courtyard", 10)
        env.reset(seed=tape.header.seed)
        for step in tape.steps:
            env.step(step.action)
            assert env.tltl_signals() == step.signals
    env.close()


@needs_engine
def test_a_snapshot_brings_back_the_whole_game() -> None:
    env = WireEnv(game(), scene="courtyard")
    env.reset(seed=4)
    moves = actions(1)
    for _ in range(25):
        env.step(next(moves))
    data = env.tltl_snapshot()
    later = [next(moves) for _ in range(30)]
    first = [_outcome(env, action) for action in later]
    env.reset(seed=9, options={"scene": "pier"})
    env.step([2, 2])
    env.tltl_restore(data)
    assert [_outcome(env, action) for action in later] == first
    env.close()


@needs_engine
@pytest.mark.parametrize(("seed", "kept_after"), [(1, 48), (18, 30), (20, 92), (22, 20), (38, 44)])
def test_equal_actions_give_equal_plays_whatever_was_played_before(seed: int, kept_after: int) -> None:
    """The engine may find bodies where they were before a reset; these plays met that, and touched walls."""
    env = WireEnv(game(), scene="courtyard")
    moves = list(islice(actions(seed), 300))
    first = _played(env, seed, moves)
    _played(env, 1000 + seed, list(islice(actions(1000 + seed), 50)))
    assert _played(env, seed, moves) == first
    _played(env, seed, moves[:kept_after])
    data = env.tltl_snapshot()
    later = [_outcome(env, action) for action in moves[kept_after:]]
    _played(env, 2000 + seed, list(islice(actions(2000 + seed), 40)))
    env.tltl_restore(data)
    assert [_outcome(env, action) for action in moves[kept_after:]] == later
    env.close()


def _played(env: WireEnv, seed: int, moves: list[list[int]]) -> list[tuple[Any, ...]]:
    """Play the moves from a reset, and return what each gives."""
    env.reset(seed=seed)
    return [_outcome(env, action) for action in moves]


def _outcome(env: WireEnv, action: list[int]) -> tuple[Any, ...]:
    """Return what a step gives, or nothing once the episode has ended."""
    try:
        observation, _, ended, _, _ = env.step(action)
    except Exception as error:
        return (type(error).__name__,)
    return observation.tolist(), ended, dict(env.tltl_signals()), dict(env.tltl_positions())


@pytest.mark.slow
@needs_engine
def test_the_trained_agent_reaches_the_beacon_unless_the_ferry_turns_round(
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(FOLDER)
    result = tltlc("regress", "suite.toml", "--out", tmp_path, "--workers", "1")
    assert result.status == 1, result.err
    lines = [line.split() for line in result.out.splitlines() if line.startswith("courtyard")]
    verdicts = {words[0]: words[1] for words in lines}
    assert (verdicts["courtyard:v0"], verdicts["courtyard:short_ferry"]) == ("pass", "fail")
