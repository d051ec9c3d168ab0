from __future__ import annotations

import pickle
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from gymnasium import spaces

from tests.runtime.gymnasium_games import games
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.scene_env import make_base_env, make_scene_env
from tltl_runtime.spec.wrapper import TltlEnv
from tltlc.api import TltlError
from tltlc.diagnostics.render import render

PLACE = re.compile(r"\n  corridor\.(game\.toml|py):\d+:\d+\n")
"""The line of a message that says where the label is."""


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def error_of(path: Path, scene: str = "short") -> str:
    with pytest.raises(TltlError) as error:
        make_base_env(read_game_file(path), scene)
    return render(error.value.diagnostics)


def play(env: TltlEnv, actions: list[int], seed: int) -> list[float]:
    env.reset(seed=seed)
    rewards = []
    for action in actions:
        _, reward, terminated, truncated, _ = env.step(action)
        rewards.append(reward)
        if terminated or truncated:
            break
    return rewards


def test_a_scene_is_an_environment_with_its_spec(folder: Path) -> None:
    env = make_scene_env(games.write(folder), "short")
    assert env.task.fspa.name == "fetch"
    assert isinstance(env.observation_space, spaces.Dict)
    assert set(env.observation_space.spaces) == {"cell", "has_key", "automaton", "progress"}
    assert env.get_wrapper_attr("tltl_clock_s") == 0.1
    observation, _ = env.reset(seed=1)
    assert env.observation_space.contains(observation)
    rewards = play(env, [2] * 4 + [1] * 4, seed=1)
    assert sum(rewards) > 0.9


def test_a_variant_has_its_own_options(folder: Path) -> None:
    path = games.write(folder)
    assert make_scene_env(path, "short").unwrapped.length == 4  # type: ignore[attr-defined]
    assert make_scene_env(path, "short", "v1").unwrapped.length == 8  # type: ignore[attr-defined]
    assert make_scene_env(path, "long", spec="corridor.tltl").unwrapped.length == 30  # type: ignore[attr-defined]


def test_a_registered_environment_takes_its_signals_from_a_function(folder: Path) -> None:
    spec = "signal angle: number in [-1, 1]\nspec up = G angle < 0.1\n"
    env = make_scene_env(games.cartpole(folder), "cartpole", spec=spec)
    env.reset(seed=3)
    _, _, _, _, info = env.step(1)
    assert len(info["atoms"]) == 1
    assert set(env.sample) == {"position", "angle"}


def test_the_function_that_makes_an_environment_can_be_pickled(folder: Path) -> None:
    make = pickle.loads(pickle.dumps(partial(make_scene_env, games.write(folder), "short", "v1")))
    assert play(make(), [2, 2, 1, 1, 0], 7) == play(
        make_scene_env(folder / "corridor.game.toml", "short", "v1"), [2, 2, 1, 1, 0], 7
    )


def test_worker_processes_make_scenes(folder: Path) -> None:
    from tltl_runtime.vector import WorkerVectorEnv

    games.write(folder)
    game = games.GAME.replace('"cell", "has_key"', '"cell"')
    make = partial(make_scene_env, games.write(folder, corridor__game__toml=game), "short")
    envs = WorkerVectorEnv([make] * 2, workers=2)
    try:
        observations, _ = envs.reset(seed=[5, 6])
        own = [make().reset(seed=seed)[0]["cell"] for seed in (5, 6)]
        np.testing.assert_array_equal(observations["cell"], own)
    finally:
        envs.close()


def test_a_render_mode_reaches_the_game(folder: Path) -> None:
    env = make_scene_env(games.write(folder), "short", render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    assert isinstance(picture, np.ndarray)
    assert picture.shape == (8, 32, 3)


def test_two_games_may_have_modules_of_the_same_name(folder: Path) -> None:
    first = games.write(folder / "first")
    second = games.write(folder / "second", corridor__py=games.GRID.replace("length=5", "length=6"))
    for path in (first, second):
        path.write_text(games.GAME.replace("options = { length = 30 }", ""), encoding="utf-8")
    envs = [make_base_env(read_game_file(path), "long") for path in (first, second, first)]
    assert [env.unwrapped.length for env in envs] == [5, 6, 5]  # type: ignore[attr-defined]


def test_a_scene_without_a_spec_is_an_error(folder: Path) -> None:
    with pytest.raises(TltlError, match="the scene `long` does not name a spec"):
        make_scene_env(games.write(folder), "long")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('"corridor:make"', '"corridor:mak"', ["has no function `mak`", "did you mean `make`?"]),
        ('"corridor:make"', '"corider:make"', ["TLT0730", "`corider` is not installed", "did you mean `corridor`?"]),
        ('"corridor:make"', '"nosuch:make"', ["TLT0730", "`pip install nosuch`"]),
        ('"corridor:make"', '"json:loads"', ["`json:loads` raises TypeError", "unexpected keyword argument"]),
        ('"corridor:make"', '"corridor:signals"', ["takes no option `length`", "leave it out"]),
        ("{ length = 4 }", "{ lenth = 4 }", ["takes no option `lenth`", "did you mean `length`?"]),
        ("{ length = 4 }", '{ length = "x" }', ["TLT0780", "raises TypeError", "corridor.py:"]),
        ('observation = ["cell"', 'observation = ["cel"', ["has no key `cel`", "did you mean `cell`?"]),
        ('signals = "corridor:signals"\n', "", ["the environment does not say its signals"]),
        ('python = "corridor:make"', 'gymnasium = "CartPol-v1"', ["registered as `CartPol-v1`", "`CartPole-v1`?"]),
        ('python = "corridor:make"', 'gymnasium = "Mystery-v9"', ['`import = ["MODULE"]`']),
        ('python = "corridor:make"', 'gymnasium = "CartPole-v1"', ["`CartPole-v1` takes no option `length`"]),
    ],
)
def test_a_wrong_entry_is_an_error_with_its_place(folder: Path, old: str, new: str, expected: list[str]) -> None:
    assert old in games.GAME
    message = error_of(games.write(folder, corridor__game__toml=games.GAME.replace(old, new)))
    for text in expected:
        assert text in message
    assert PLACE.search(message)
    assert "help: " in message


def test_a_module_whose_name_only_begins_alike_is_not_suggested(folder: Path) -> None:
    code = games.GAME.replace('"corridor:make"', '"granary:make"')
    message = error_of(games.write(folder, corridor__game__toml=code, granary_maps__py=""))
    assert "`pip install granary`" in message
    assert "did you mean" not in message


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("return Corridor(length, render_mode)", "return [length]", "returns a list, not a gymnasium.Env"),
        ("return Corridor(length, render_mode)", "raise ValueError('no map')", "raises ValueError: no map"),
        ("def make(", "def make((", "raises SyntaxError"),
        ("import gymnasium\n", "import gymnasium, nosuch_module\n", "`corridor` needs it"),
    ],
)
def test_a_broken_module_is_an_error_with_its_place(folder: Path, old: str, new: str, expected: str) -> None:
    message = error_of(games.write(folder, corridor__py=games.GRID.replace(old, new)))
    assert expected in message
    assert PLACE.search(message)


def test_an_exception_in_play_is_an_error_with_its_place(folder: Path) -> None:
    broken = games.GRID.replace("def step(self, action):\n", "def step(self, action):\n        [][action]\n")
    assert broken != games.GRID
    env = make_scene_env(games.write(folder, corridor__py=broken), "short")
    env.reset(seed=0)
    with pytest.raises(TltlError) as error:
        env.step(0)
    message = render(error.value.diagnostics)
    assert "error[TLT0781]: step 1 of the episode raises IndexError: list index out of range" in message
    assert "[][action]" in message


@pytest.mark.parametrize("method", ["reset", "render", "close"])
def test_an_exception_of_another_method_is_an_error(folder: Path, method: str) -> None:
    broken = f"{games.GRID}\n\ndef fail(*_, **__):\n    raise OSError('gone')\n\n\nCorridor.{method} = fail\n"
    env = make_base_env(read_game_file(games.write(folder, corridor__py=broken)), "short")
    with pytest.raises(TltlError) as error:
        getattr(env, method)()
    assert f"the game's `{method}` raises OSError: gone" in render(error.value.diagnostics)


def test_a_game_cannot_change_the_options_of_the_next_one(folder: Path) -> None:
    greedy = games.GRID.replace("def make(scene, length=5, render_mode=None):", "def make(scene, length, sizes):")
    greedy = greedy.replace("return Corridor(length, render_mode)", "return Corridor(sizes.pop())")
    text = games.GAME.replace("{ length = 4 }", "{ length = 4, sizes = [6, 7] }")
    game = read_game_file(games.write(folder, corridor__py=greedy, corridor__game__toml=text))
    assert [make_base_env(game, "short").unwrapped.length for _ in range(2)] == [7, 7]  # type: ignore[attr-defined]


@pytest.mark.parametrize("clock", ["0", "'fast'", "float('nan')", "-1.0"])
def test_a_wrong_clock_of_the_game_is_an_error(folder: Path, clock: str) -> None:
    text = games.GRID.replace(
        "class Corridor(gymnasium.Env):", f"class Corridor(gymnasium.Env):\n    tltl_clock_s = {clock}"
    )
    assert "`tltl_clock_s` is" in error_of(games.write(folder, corridor__py=text))


@pytest.mark.parametrize("params", ["[1]", "{'a': 'b'}", "{'a': None}", "1 / 0"])
def test_wrong_params_of_the_game_are_an_error(folder: Path, params: str) -> None:
    text = games.GRID.replace(
        "    def render(self):", f"    def tltl_params(self):\n        return {params}\n\n    def render(self):"
    )
    assert "the game's `tltl_params` raises" in error_of(games.write(folder, corridor__py=text))


def test_an_observation_with_a_key_of_the_spec_is_an_error(folder: Path) -> None:
    text = games.GRID.replace('"cell": spaces', '"progress": spaces').replace('{"cell": np', '{"progress": np')
    game = games.GAME.replace('observation = ["cell", "has_key"]\n', "")
    message = error_of(games.write(folder, corridor__py=text, corridor__game__toml=game))
    assert "the observation has the key `progress`, which the spec adds to it" in message


@pytest.mark.parametrize(
    ("result", "expected"), [("[1.0]", "returns a list, not a mapping"), ("{'has_key': env.nosuch}", "AttributeError")]
)
def test_a_wrong_function_of_signals_is_an_error(folder: Path, result: str, expected: str) -> None:
    text = games.GRID.partition("def signals")[0] + f"def signals(env):\n    return {result}\n"
    env = make_scene_env(games.write(folder, corridor__py=text), "short")
    with pytest.raises(TltlError) as error:
        env.reset(seed=0)
    message = render(error.value.diagnostics)
    assert "error[TLT0781]: `corridor:signals`, called after the reset, r" in message
    assert expected in message


def test_a_module_with_the_name_of_another_is_an_error(folder: Path) -> None:
    text = games.GAME.replace('"corridor:make"', '"json:make"')
    message = error_of(games.write(folder, corridor__game__toml=text, json__py=games.GRID))
    assert "the game's module `json` has the name of another module" in message
