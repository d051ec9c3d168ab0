"""Game files whose scenes stand for levels: every command does the same with ``--game`` as with ``--level``."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("pybullet")

from tests.interfaces.cli.conftest import ROOT, Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games
from tests.runtime.regression.handmade import ROOM
from tests.runtime.training.imitating import SOON, recorded_episode, write_recordings
from tltl_runtime.game.registry import STEALTH, game_named
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltl_runtime.policies.file import read_policy
from tltl_runtime.regression.suite.dependencies import select
from tltl_runtime.regression.suite.suite import Case, read_suite
from tltl_runtime.training.run.initial_policy import weights_hash
from tltlc.api import TltlError, replace
from tltlc.diagnostics.render import render

Run = Callable[..., Outcome]

FILE = "stealth.game.toml"
LEVEL, SCENE = "cover_and_hide:v1", f"{FILE}:cover_and_hide:v1"
RECORDING = "cover_and_hide-v1-3.episode.npz"
SETTINGS = """\
rollout = { envs = 4, steps = 16, workers = 1 }
exploration = { ways = 0 }
ppo = { epochs = 1, minibatches = 1 }
network = { hidden = [8] }
stop = { episodes = 2, confirmation = 2, steps = 128 }
imitation = { demonstrations = 2, cloning = 0.5 }
"""


@pytest.fixture(name="folder", autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which contains the game file of the stealth game and a short spec."""
    shutil.copy(ROOT / "examples" / FILE, tmp_path)
    (tmp_path / "soon.tltl").write_text(SOON)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def with_own_level(folder: Path) -> None:
    """Write the level ``room.toml`` and a game file ``own.game.toml`` with the scenes ``room`` and ``navigation``."""
    (folder / "room.toml").write_text(ROOM)
    text = '[game]\nlevels = "stealth"\n[[scene]]\nname = "room"\n[[scene]]\nname = "navigation"\n'
    (folder / "own.game.toml").write_text(text)


def errors_of(folder: Path, text: str) -> str:
    (folder / "wrong.game.toml").write_text(text)
    with pytest.raises(TltlError) as error:
        read_game_file(folder / "wrong.game.toml")
    return render(error.value.diagnostics)


# --- the levels that scenes stand for ----------------------------------------------------------------


@pytest.mark.parametrize(
    ("argument", "level"),
    [
        (FILE, "navigation"),
        (f"{FILE}:branching", "branching"),
        (SCENE, LEVEL),
        (f"{FILE}:branching:v0+guard_alert", "branching:v0+guard_alert"),
        ("own.game.toml:room:v0+mine/wider.toml", "room.toml:v0+mine/wider.toml"),
        ("own.game.toml:navigation", "navigation"),
        (f"{FILE}:room", f"{FILE}:room"),
        ("corridor.game.toml:short:v1", "corridor.game.toml:short:v1"),
        ("broken.game.toml:navigation", "broken.game.toml:navigation"),
        ("missing.game.toml", "missing.game.toml"),
        ("navigation:v1", "navigation:v1"),
        ("room.toml", "room.toml"),
    ],
)
def test_a_scene_stands_for_the_level_of_its_name(folder: Path, argument: str, level: str) -> None:
    games.write(folder)
    with_own_level(folder)
    (folder / "broken.game.toml").write_text('[game]\nlevels = "stealth"\nclock = "10 Hz"\n')
    assert level_of_scene(argument) == level


def test_the_scenes_of_the_example_are_the_levels_of_the_package() -> None:
    scenes = [scene.name for scene in read_game_file(Path(FILE)).scenes]
    assert sorted(scenes) == sorted(game_named(STEALTH).level_files.names())


def test_what_levels_say_themselves_is_no_key_of_the_game_file(folder: Path) -> None:
    text = '[game]\nlevels = "stealth"\nclock = "10 Hz"\n[[scene]]\nname = "navigation"\nvariants = {}\n'
    message = errors_of(folder, text)
    for key in ("clock", "variants"):
        assert f"error[TLT0802]: `{key}` is not for scenes that are levels" in message
    assert message.count("error[") == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('levels = "stealth"', "`[game]` has `levels`, but there is no scene"),
        ('levels = "stealth"\n[[scene]]\nname = "navigatoin"', "there is no level `navigatoin`"),
        ('levels = "chess"\n[[scene]]\nname = "a"', 'wrong value for `levels`: "chess"'),
        (
            'levels = "stealth"\npython = "a:b"\n[[scene]]\nname = "branching"',
            "`[game]` has both `levels` and `python`",
        ),
    ],
)
def test_a_wrong_game_of_levels_is_an_error(folder: Path, text: str, message: str) -> None:
    errors = errors_of(folder, f"[game]\n{text}\n")
    assert message in errors and errors.count("error[") == 1


def test_a_program_is_told_to_name_the_level() -> None:
    with pytest.raises(TltlError, match="stands for a level of the game `stealth`"):
        GAME.load_level(f"{FILE}:navigation")


# --- commands ----------------------------------------------------------------------------------------


def test_demonstrations_are_equal(tltlc: Run, folder: Path) -> None:  # noqa: F811
    """The scripted expert has the automaton of the spec, and equal seeds give equal files."""
    for place, out in ((LEVEL, "level"), (SCENE, "game")):
        result = tltlc("demonstrate", place, "--spec", "soon.tltl", "--seed", "3", "-o", out)
        assert result.status == 0, result.err
    written = {path.name: path.read_bytes() for path in (folder / "level").iterdir()}
    assert RECORDING in written
    assert {path.name: path.read_bytes() for path in (folder / "game").iterdir()} == written


def test_recorded_demonstrations_are_equal(tltlc: Run, folder: Path) -> None:  # noqa: F811
    for place, out in ((LEVEL, "level"), (SCENE, "game")):
        result = tltlc("record", place, "--spec", "soon.tltl", "--episodes", "1", "-o", out)
        assert result.out.endswith(f"--level cover_and_hide:v1 --method imitation --demonstrations {out}\n")
    level, game = ([path.read_bytes() for path in (folder / out).iterdir()] for out in ("level", "game"))
    assert level == game


@pytest.mark.parametrize("game", [FILE, f"{FILE}:cover_and_hide", SCENE])
def test_a_recording_of_a_level_is_played_again_as_its_scene(tltlc: Run, folder: Path, game: str) -> None:  # noqa: F811
    write_recordings(folder, recorded_episode(3, variant="v1"))
    result = tltlc("replay", RECORDING, "--check", "--game", game)
    assert (result.status, result.err) == (0, "")
    assert "played again it is the same episode" in result.out


@pytest.mark.parametrize("game", [f"{FILE}:cover_and_hide:v2", f"{FILE}:branching:v1"])
def test_a_recording_of_another_level_is_refused(tltlc: Run, folder: Path, game: str) -> None:  # noqa: F811
    write_recordings(folder, recorded_episode(3, variant="v1"))
    result = tltlc("replay", RECORDING, "--game", game)
    assert result.status == 2
    other = game.removeprefix(f"{FILE}:")
    assert f"error[TLT0800]: the recording is of `cover_and_hide:v1`, not of `{other}`" in result.err


def test_a_recording_of_another_game_is_refused(tltlc: Run, folder: Path) -> None:  # noqa: F811
    path = games.write(folder)
    env = GAME.recorder(GAME.make_env(f"{path}:short"))
    env.reset(seed=1)
    env.step(0)
    (folder / "corridor.episode.npz").write_bytes(GAME.episode_bytes(env.episode))
    env.close()
    result = tltlc("replay", "corridor.episode.npz", "--game", f"{FILE}:navigation")
    assert result.status == 2
    assert "the recording is of the game `corridor`, not of the level `navigation`" in result.err


def test_evaluations_are_equal(tltlc: Run) -> None:  # noqa: F811
    """The policy that comes with a level plays its scene, whichever place names it."""
    scene, options = f"{FILE}:navigation", ("--episodes", "1", "--workers", "1", "--json", "-")
    expected = tltlc("evaluate", "--level", "navigation", *options)
    assert '"pass_rate"' in expected.out
    for arguments in (("--game", scene), ("navigation", "--game", scene), (scene,)):
        result = tltlc("evaluate", *arguments, *options)
        assert (result.status, result.out) == (0, expected.out), result.err


def test_a_check_of_the_game_is_a_check_of_its_levels(tltlc: Run, folder: Path) -> None:  # noqa: F811
    with_own_level(folder)
    by_level = tltlc("check", "soon.tltl", "--level", "room.toml", "--level", "navigation")
    by_game = tltlc("check", "soon.tltl", "--game", "own.game.toml")
    assert (by_game.status, by_game.err) == (by_level.status, by_level.err)
    assert "room: the agent senses" in by_game.err and "navigation: the agent senses" in by_game.err
    assert tltlc("check", "soon.tltl", "--level", "own.game.toml:room").err in by_game.err


def test_a_scene_names_the_policy_and_the_files_of_its_level(tltlc: Run, folder: Path) -> None:  # noqa: F811
    by_game, by_level = (tltlc("inspect", name).out.splitlines() for name in (f"{FILE}:navigation", "navigation"))
    assert by_game[1:] == by_level[1:] != []
    for place, out in (("navigation", "level"), (f"{FILE}:navigation", "game")):
        assert tltlc("new", out, "--level", place).status == 0
    names = sorted(path.name for path in (folder / "game").rglob("*"))
    assert names == sorted(path.name for path in (folder / "level").rglob("*"))


def test_the_levels_are_listed_with_their_specs(tltlc: Run, folder: Path) -> None:  # noqa: F811
    with_own_level(folder)
    lines = tltlc("list", "games").out.splitlines()
    assert f"{FILE}\tcover_and_hide\tv2\tcover_and_hide.tltl:cover_and_hide" in lines
    assert [line for line in lines if line.startswith("own.game.toml\troom")] == ["own.game.toml\troom\tv0\t"]


@pytest.mark.slow
def test_agents_that_imitate_are_equal(tltlc: Run, folder: Path) -> None:  # noqa: F811
    """A policy that was trained with ``--level`` plays with ``--game``, and its training goes on with it."""
    (folder / "small.toml").write_text(SETTINGS)
    options = ("--method", "imitation", "--config", "small.toml", "--out")
    for option, place, out in (("--level", LEVEL, "level"), ("--game", SCENE, "game")):
        result = tltlc("train", "soon.tltl", option, place, *options, out)
        assert result.status == 0, result.err
    level, game = (read_policy(folder / out / "policy.safetensors") for out in ("level", "game"))
    assert (level.card.level, level.card.level_hash) == (game.card.level, game.card.level_hash)
    assert weights_hash(level) == weights_hash(game)
    evaluated = tltlc("evaluate", "level", "--game", SCENE, "--episodes", "2", "--workers", "1")
    assert evaluated.status == 0, evaluated.err
    assert tltlc("train", "--resume", "level", "--game", SCENE).status == 0


def test_the_game_of_a_project_may_have_levels(tltlc: Run, folder: Path) -> None:  # noqa: F811
    (folder / "tltl.toml").write_text(f'game = "{FILE}"\n')
    (folder / "small.toml").write_text(SETTINGS)
    result = tltlc("train", "soon.tltl", "--config", "small.toml", "--steps", "64", "--out", "run")
    assert "training soon on cover_and_hide:v0" in result.err


# --- suites ------------------------------------------------------------------------------------------


def cases_of(folder: Path, text: str) -> tuple[Case, ...]:
    (folder / "suite.toml").write_text(text)
    return read_suite(folder / "suite.toml").played_cases


def test_a_case_of_a_scene_is_the_case_of_its_level(folder: Path) -> None:
    """So it has the baseline, the map, the overlays and the sensors of the level."""
    with_own_level(folder)
    policy = 'policy = "navigation"\n'
    for scene, level, rest in (
        (f'game = "{FILE}"\nscene = "navigation"', 'level = "navigation"', 'variant = "v1"\noverlay = "guard_alert"\n'),
        (f'game = "{FILE}"', 'level = "navigation"', ""),
        ('game = "own.game.toml"\nscene = "room"', 'level = "room.toml"', policy),
    ):
        (by_game,), (by_level,) = (cases_of(folder, f"[[case]]\n{place}\n{rest}") for place in (scene, level))
        assert by_game.game_file is not None
        assert replace(by_game, game_file=None) == by_level


def test_a_case_depends_on_its_game_file_and_on_the_files_of_its_level(folder: Path) -> None:
    text = f'[[case]]\ngame = "{FILE}"\nscene = "navigation"\n[[case]]\nlevel = "branching"\n'
    cases_of(folder, text)
    suite = read_suite(folder / "suite.toml")
    for changed in (FILE, "navigation.toml", "navigation.tltl"):
        assert [case.name for case in select(suite, [changed]).cases] == ["navigation:v0"]


@pytest.mark.slow
def test_the_baseline_of_levels_is_that_of_scenes(tltlc: Run, folder: Path) -> None:  # noqa: F811
    """A run with scenes knows the episodes of a run with levels, and gives the same verdicts."""
    rest = 'variant = "v1"\nepisodes = 25\n'
    (folder / "suite.toml").write_text(f'[[case]]\nlevel = "navigation"\n{rest}')
    assert tltlc("baseline", "suite.toml", "--workers", "1").status == 0
    run = ("regress", "suite.toml", "--workers", "1", "--out", "out", "--json")
    by_level = tltlc(*run, "level.json")
    (folder / "suite.toml").write_text(f'[[case]]\ngame = "{FILE}"\nscene = "navigation"\n{rest}')
    by_game = tltlc(*run, "game.json")
    assert by_game.status == by_level.status
    assert "(as before)" in by_game.out
    level, game = (json.loads((folder / report).read_text())["cases"] for report in ("level.json", "game.json"))
    assert game == level
