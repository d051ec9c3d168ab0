"""Scenes of games in other processes: the counter of the protocol's conversation, played by the commands."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_env import make_base_env
from tltl_runtime.gymnasium_games.scene_hash import file_hashes, possible_files, scene_hash
from tltl_runtime.wire.errors import WireError
from tltlc.api import TltlError

Run = Callable[..., Outcome]
SPEC = """\
clock 10 Hz
signal position in [0, 10]
signal at_goal: bool
spec count { reach at_goal limit 40 steps }
"""


def write(folder: Path, *words: str) -> Path:
    """Write a game file whose game is the command ``words``, with its spec; return its path."""
    path = folder / "counter.game.toml"
    variants = "variants = { trap = {} }"
    scene = f'[[scene]]\nname = "short"\nspec = "counter.tltl:count"\n{variants}\n'
    path.write_text(f"[game]\nprocess = {json.dumps(words)}\n\n{scene}")
    (folder / "counter.tltl").write_text(SPEC)
    return path


@pytest.fixture(name="game")
def _game(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return write(tmp_path, sys.executable, str(Path(__file__).parents[1] / "wire" / "games" / "counter.py"))


@pytest.mark.usefixtures("game")
def test_a_game_is_checked(tltlc: Run, game: Path) -> None:  # noqa: F811
    game.write_text(game.read_text().replace('"short"', '"long"'))
    result = tltlc("check", "--game", "counter.game.toml:long:trap")
    assert result.status == 0, result.err
    assert "long:trap has the signals that `count` uses" in result.err
    assert "capabilities: params, clock, positions, outline, cause, snapshot, render\n  speed" in result.err
    assert "equal seeds and actions give equal plays: yes" in result.err
    assert "a restored snapshot is what was saved: yes" in result.err


def test_a_check_says_what_a_missing_outline_costs(tltlc: Run, game: Path) -> None:  # noqa: F811
    counter = Path(__file__).parents[1] / "wire" / "games" / "counter.py"
    changed = f"import sys; sys.path.insert(0, {str(counter.parent)!r}); import counter\n"
    changed += "del counter.Counter.outline\ncounter.tltl_client.play(counter.Counter())\n"
    write(game.parent, sys.executable, "-c", changed)
    result = tltlc("check", "--game", "counter.game.toml:short:v0", "--format", "json")
    hint = "maps show positions alone, and sentences name no regions"
    assert json.loads(result.out)["scenes"][0]["missing"] == {"outline": hint}
    assert f"snapshot, render\n    no outline: {hint}\n" in tltlc("check", "--game", "counter.game.toml:short:v0").err


@pytest.mark.parametrize(
    ("outline", "message"),
    [
        (
            '{"boxes": {"wall": [[[0, 0], [8, 1]], [[8, 0], 9]]}}',
            "error[TLT0792]: the game `counter.game.toml` sent `outline.boxes.wall[1][1]` as 9, but it must be a"
            " list of two or three numbers",
        ),
        (
            '{"image": {"path": "map.png", "extent": [0, 0, 9, 6]}}',
            "error[TLT0781]: the outline that the game sends has an image `map.png` that cannot be read",
        ),
    ],
)
def test_a_wrong_outline_is_named(tltlc: Run, game: Path, outline: str, message: str) -> None:  # noqa: F811
    counter = Path(__file__).parents[1] / "wire" / "games" / "counter.py"
    changed = f"import sys; sys.path.insert(0, {str(counter.parent)!r}); import counter\n"
    changed += f"counter.Counter.outline = lambda self: {outline}\ncounter.tltl_client.play(counter.Counter())\n"
    write(game.parent, sys.executable, "-c", changed)
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 1 and message in result.err, result.err


@pytest.mark.skipif(os.name == "nt", reason="the program is a script for a shell")
def test_a_program_beside_the_game_file_is_started(tltlc: Run, game: Path) -> None:  # noqa: F811
    counter = Path(__file__).parents[1] / "wire" / "games" / "counter.py"
    program = game.with_name("counter")
    program.write_text(f"#!/bin/sh\nexec {shlex.quote(sys.executable)} {shlex.quote(str(counter))}\n")
    program.chmod(0o755)
    write(game.parent, "./counter")
    result = tltlc("check", "--game", "counter.game.toml:short:v0")
    assert result.status == 0, result.err


@pytest.mark.usefixtures("game")
def test_an_episode_is_recorded_with_places_and_played_again() -> None:
    env = GAME.recorder(GAME.make_env("counter.game.toml:short"), "tester")
    env.reset(seed=2)
    for _ in range(2):
        env.step(2)
    env.close()
    episode = env.episode
    assert (episode.success, episode.end, episode.signals[-1].tolist()) == (True, "success", [1.0])
    assert episode.positions is not None
    located = GAME.located(GAME.episode_from_bytes(GAME.episode_bytes(episode), "it"), "counter.game.toml", None)
    assert GAME.check_replay(located) == ()


@pytest.mark.parametrize(
    ("name", "help_"),
    [
        ("shrot", "did you mean `short`? (it declares `short`, `long`)"),
        ("cellar", "it declares `short`, `long`"),
    ],
)
def test_a_scene_that_the_game_lacks_is_an_error_of_the_game_file(game: Path, name: str, help_: str) -> None:
    game.write_text(game.read_text().replace('"short"', f'"{name}"'))
    with pytest.raises(TltlError, match=f"TLT0803: the game has no scene `{name}`") as caught:
        make_base_env(read_game_file(game), name)
    (diagnostic,) = caught.value.diagnostics
    (label,) = diagnostic.labels
    assert label.source.text[label.span.start : label.span.end] == f'"{name}"'
    assert diagnostic.help == help_


def test_a_game_without_screenshots_says_how_to_add_pictures(tmp_path: Path) -> None:
    game = write(tmp_path, sys.executable, str(Path(__file__).parents[1] / "wire" / "games" / "faulty.py"), "none")
    game.write_text(game.read_text().replace('"short"', '"main"'))
    with pytest.raises(TltlError, match="TLT0731: the game of `main` sends no pictures") as caught:
        make_base_env(read_game_file(game), "main", render_mode="rgb_array")
    (diagnostic,) = caught.value.diagnostics
    (label,) = diagnostic.labels
    assert label.source.text[label.span.start :].startswith("process")
    assert "declare the capability `screenshot` in its `hello`" in (diagnostic.help or "")


def test_options_are_for_environments_in_this_process(game: Path) -> None:
    game.write_text(game.read_text().replace("variants = {", "options = { size = 3 }\nvariants = {"))
    with pytest.raises(TltlError, match="TLT0780: a game in another process takes no option `size`"):
        make_base_env(read_game_file(game), "short")


def test_a_game_that_ends_at_once_is_reported(tmp_path: Path) -> None:
    path = write(tmp_path, sys.executable, "-c", "import sys; sys.exit('no map')")
    with pytest.raises(WireError, match="TLT0790") as error:
        make_base_env(read_game_file(path), "short")
    assert "no map" in (error.value.diagnostics[0].help or "")


def test_the_hash_notices_the_code_and_the_variant(tmp_path: Path) -> None:
    (tmp_path / "tower.py").write_text("import floors\n")
    (tmp_path / "floors.py").write_text("COUNT = 3\n")
    game = read_game_file(write(tmp_path, "python3", "tower.py"))
    before = scene_hash(game, "short")
    assert before != scene_hash(game, "short", "trap")
    assert [name for name, _ in file_hashes(game, "short")] == ["counter.game.toml", "floors.py", "tower.py"]
    (tmp_path / "floors.py").write_text("COUNT = 4\n")
    assert scene_hash(game, "short") != before


@pytest.mark.parametrize("module", ["tower", "tower.play"])
def test_the_hash_notices_the_code_of_a_module_that_is_run(tmp_path: Path, module: str) -> None:
    (tmp_path / "tower" / "play").mkdir(parents=True)
    files = [tmp_path / f"{module.replace('.', '/')}/__main__.py", tmp_path / "floors.py"]
    files[0].write_text("import floors\n")
    files[1].write_text("COUNT = 3\n")
    game = read_game_file(write(tmp_path, "python3", "-m", module, "-m", "/dev"))
    names = ["counter.game.toml", *sorted(file.relative_to(tmp_path).as_posix() for file in files)]
    assert [name for name, _ in file_hashes(game, "short")] == names
    assert {*files, tmp_path / "tower.py"} <= set(possible_files(game))
    before = scene_hash(game, "short")
    files[1].write_text("COUNT = 4\n")
    assert scene_hash(game, "short") != before


def test_the_hash_notices_a_module_in_one_file(tmp_path: Path) -> None:
    (tmp_path / "tower.py").write_text("COUNT = 3\n")
    game = read_game_file(write(tmp_path, "python3", "-m", "tower"))
    before = scene_hash(game, "short")
    (tmp_path / "tower.py").write_text("COUNT = 4\n")
    assert scene_hash(game, "short") != before


def test_a_scene_may_have_the_name_of_its_file(game: Path) -> None:
    text = game.read_text().replace('name = "short"', 'name = "long"')
    other = game.with_name("long.game.toml")
    other.write_text(text)
    env = GAME.make_env(f"{other}:long")
    env.reset(seed=0)
    for _ in range(6):
        env.step(2)
    assert not env.sample["at_goal"]
    env.close()
