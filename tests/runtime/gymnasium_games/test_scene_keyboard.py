"""A person plays scenes: keys and their actions, and the commands on a real X server with real keys."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT
from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games
from tests.runtime.gymnasium_games.test_lost_episodes import mortal
from tests.runtime.stealth.xvfb import MISSING, keys, screen
from tests.waiting import HANG_S, until
from tltl_runtime.game.recording_check import check
from tltl_runtime.gymnasium_games.game_check import check_scene
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.key_actions import KeyActions, key_actions
from tltl_runtime.gymnasium_games.key_names import COMMANDS, NAMES, named_key
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.gymnasium_games.scene_hash import scene_hash
from tltlc.api import TltlError

Run = Callable[..., Outcome]

needs_screen = pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
WITH_KEYS = games.GAME.replace("[game]", '[game]\nkeys = ["s", "right", "left"]')


def own_keys(mapping: str) -> str:
    """Return the corridor with a method ``get_keys_to_action`` that returns ``mapping``."""
    return f"{games.GRID}\n\nCorridor.get_keys_to_action = lambda self: {mapping}\n"


def actions_of(game: Path, scene: str = "short") -> KeyActions:
    place = f"{game}:{scene}"
    env = GAME.make_env(place, spec=f"{game.parent}/corridor.tltl:fetch", render_mode="rgb_array")
    try:
        return key_actions(GAME.recorder(env), GAME.load_level(place))
    finally:
        env.close()


def key_error(game: Path) -> str:
    with pytest.raises(TltlError) as caught:
        actions_of(game)
    (diagnostic,) = caught.value.diagnostics
    return f"{diagnostic.code}: {diagnostic.title} ({diagnostic.help})"


# --- keys and their actions


def test_digits_choose_actions_if_nothing_else_is_named(tmp_path: Path) -> None:
    actions = actions_of(games.write(tmp_path))
    assert actions.actions == {frozenset(["1"]): 0, frozenset(["2"]): 1, frozenset(["3"]): 2}
    assert actions.idle is None
    assert actions.lines == ("1: action 0   2: action 1   3: action 2",)


def test_the_keys_of_the_game_file_come_first(tmp_path: Path) -> None:
    actions = actions_of(games.write(tmp_path, corridor__game__toml=WITH_KEYS, corridor__py=own_keys("{'w': 1}")))
    assert actions.actions == {frozenset(["s"]): 0, frozenset(["right"]): 1, frozenset(["left"]): 2}
    assert actions.idle is None


def test_the_keys_of_an_environment_let_the_game_go_on(tmp_path: Path) -> None:
    mapping = "{(): 0, (ord('d'),): 1, 'a': 2, 'ad': 0, (276,): 2, 1073741904: 2}"
    actions = actions_of(games.write(tmp_path, corridor__py=own_keys(mapping)))
    assert actions.keys == {"a", "d", "left"}
    assert (actions.idle, actions.step_s) == (0, 0.1)
    assert [actions.of_held(held) for held in ((), ("d",), ("a", "x"), ("a", "d"), ("left", "a", "d"))] == [
        0,
        1,
        2,
        0,
        0,
    ]
    assert actions.lines == ("d: action 1   a: action 2   a+d: action 0   left: action 2",)


def test_actions_have_the_names_that_the_environment_gives(tmp_path: Path) -> None:
    meanings = "\n\nCorridor.get_action_meanings = lambda self: ['NOOP', 'RIGHT', 'LEFT']\n"
    assert actions_of(games.write(tmp_path, corridor__py=games.GRID + meanings)).lines == (
        "1: noop   2: right   3: left",
    )
    enumerated = "\n\nimport enum\nCorridor.actions = enum.IntEnum('Actions', 'wait east west', start=0)\n"
    assert actions_of(games.write(tmp_path / "other", corridor__py=games.GRID + enumerated)).lines == (
        "1: wait   2: east   3: west",
    )


def test_other_mappings_fall_back_to_digits(tmp_path: Path) -> None:
    assert actions_of(games.write(tmp_path, corridor__py=own_keys("{(): 1}"))).keys == {"1", "2", "3"}


@pytest.mark.parametrize(
    ("mapping", "message"),
    [
        ("{'d': 7}", "TLT0781: the game's `get_keys_to_action` names the action 7, which is not in Discrete(3)"),
        ("[1, 2]", "TLT0781: the game's `get_keys_to_action` raises AttributeError"),
        ("{'d': None}", "TLT0781: the game's `get_keys_to_action` raises TypeError"),
    ],
)
def test_wrong_keys_of_an_environment_are_reported(tmp_path: Path, mapping: str, message: str) -> None:
    assert message in key_error(games.write(tmp_path, corridor__py=own_keys(mapping)))


@pytest.mark.parametrize(
    ("space", "message"),
    [
        (
            "spaces.Box(-1, 1, (2,))",
            "TLT0731: the game of `short` has no actions that keys can choose: an action is Box(2,",
        ),
        ("spaces.MultiDiscrete([3, 2])", "an action is MultiDiscrete(3, 2), and keys need a Discrete space"),
        ("spaces.Discrete(12)", "TLT0731: the game of `short` has 12 actions, too many for the digits 1 to 9"),
    ],
)
def test_actions_that_keys_cannot_choose_are_reported(tmp_path: Path, space: str, message: str) -> None:
    game = games.write(tmp_path, corridor__py=games.GRID.replace("spaces.Discrete(3)", space))
    assert message in key_error(game)


def test_as_many_keys_as_actions_are_needed(tmp_path: Path) -> None:
    two = games.GAME.replace("[game]", '[game]\nkeys = ["left", "right"]')
    message = "TLT0803: `keys` has 2 keys, but an action of the scene `short` is Discrete(3) (name 3 keys, one for each"
    game = games.write(tmp_path, corridor__game__toml=two)
    assert message in key_error(game)
    (diagnostic,) = check_scene(read_game_file(game), "short", "v0").diagnostics
    assert (diagnostic.code, diagnostic.severity) == ("TLT0803", "error")


@pytest.mark.parametrize(
    ("listed", "message"),
    [
        ('["lft"]', "there is no key `lft`"),
        ('["r"]', "the key `r` cannot choose an action: it restarts the episode"),
        ('["a", "b", "a"]', "two actions have the key `a`"),
        ('"left"', "`keys`"),
    ],
)
def test_wrong_keys_of_a_game_file_are_reported(tmp_path: Path, listed: str, message: str) -> None:
    game = games.write(tmp_path, corridor__game__toml=games.GAME.replace("[game]", f"[game]\nkeys = {listed}"))
    with pytest.raises(TltlError) as caught:
        read_game_file(game)
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["TLT0803"]
    assert message in caught.value.diagnostics[0].title


def test_keys_change_no_episode(tmp_path: Path) -> None:
    before = scene_hash(read_game_file(games.write(tmp_path)), "short")
    assert scene_hash(read_game_file(games.write(tmp_path, corridor__game__toml=WITH_KEYS)), "short") == before


@pytest.mark.skipif("pygame" in MISSING, reason="pygame is not installed")
def test_all_names_of_keys_are_those_of_pygame() -> None:
    code = (
        "import pygame; pygame.display.init(); pygame.display.set_mode((9, 9))\n"
        "from tltl_runtime.gymnasium_games.key_names import COMMANDS, NAMES, named_key\n"
        "for name in (*NAMES, *COMMANDS):\n"
        "    number = pygame.key.key_code(name)\n"
        "    assert pygame.key.name(number) == name, name\n"
        "    assert named_key(number) in (name, number), name\n"
    )
    environment = {
        **os.environ,
        "SDL_VIDEODRIVER": "dummy",
        "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")]),
    }
    subprocess.run([sys.executable, "-c", code], env=environment, check=True, timeout=HANG_S, capture_output=True)
    assert not {*NAMES} & {*COMMANDS}
    assert [named_key(key) for key in ("W", 119, " ", 32, "left", 10**6)] == ["w", "w", "space", "space", "left", 10**6]


# --- the commands


@pytest.fixture(scope="module", name="display")
def _display() -> Iterator[dict[str, str]]:
    with screen() as environment:
        yield environment


class Player:
    """A running command whose window is open."""

    def __init__(self, display: dict[str, str], folder: Path, *arguments: str) -> None:
        self._display = display
        path = os.pathsep.join([str(ROOT), str(ROOT / "runtime")])
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tltlc", *arguments],
            env={**display, "PYTHONPATH": path},
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.until(self._is_visible, "shows its window")

    def until(self, event: Callable[[], bool], description: str) -> None:
        """Wait until ``event()`` is true; fail if the command ends before."""

        def happened() -> bool:
            assert self.process.poll() is None, self.process.communicate()
            return event()

        until(happened, f"a game that {description}", 0.05)

    def press(self, *names: str) -> None:
        keys(self._display, "key", "--delay", "60", *names)

    def until_pressed(self, event: Callable[[], bool], *names: str) -> None:
        """Press keys again and again until ``event()`` is true: the window does not hear the first ones."""

        def happened() -> bool:
            self.press(*names)
            return event()

        self.until(happened, f"takes the keys {', '.join(names)}")

    def hold(self, name: str) -> None:
        keys(self._display, "keydown", name)

    def release(self, name: str) -> None:
        keys(self._display, "keyup", name)

    def ended(self) -> str:
        out, err = self.process.communicate(timeout=HANG_S)
        assert self.process.returncode == 0, err
        return out

    def _is_visible(self) -> bool:
        search = ["xdotool", "search", "--onlyvisible", "--class", "."]
        return not subprocess.run(search, env=self._display, timeout=HANG_S, capture_output=True).returncode


@pytest.fixture(name="start")
def _start(display: dict[str, str], tmp_path: Path) -> Iterator[Callable[..., Player]]:
    players: list[Player] = []

    def start(*arguments: str) -> Player:
        players.append(Player(display, tmp_path, *arguments))
        return players[-1]

    yield start
    for player in players:
        player.process.kill()
        player.process.wait(HANG_S)


def played(path: Path, game: Path) -> SceneEpisode:
    """Read a recorded episode, and check that its judgement and its play can be reproduced."""
    episode = GAME.read_episode(path)
    assert episode.player == "keyboard"
    assert check(episode) == ()
    assert GAME.check_replay(GAME.located(episode, str(game), None)) == ()
    return episode


@needs_screen
def test_each_key_press_is_a_step(start: Callable[..., Player], tmp_path: Path) -> None:
    game = games.write(tmp_path, corridor__game__toml=WITH_KEYS)
    player = start("play", "corridor.game.toml:short", "--seed", "3", "-o", "runs")
    first = tmp_path / "runs" / "short-v0.episode.npz"

    player.until_pressed(first.exists, "Left", "Left", "Left", "s", "Right", "Right", "Right")
    player.press("r", "Right", "Left", "F5", "Escape")
    out = player.ended()
    assert "success after" in out and "stopped after 0.20 s" in out
    episode = played(first, game)
    assert episode.success and episode.seed == 3
    assert episode.actions[-4:, 0].tolist() == [0.0, 1.0, 1.0, 1.0]
    again = played(tmp_path / "runs" / "short-v0-2.episode.npz", game)
    assert (again.end, again.actions[:, 0].tolist()) == ("stopped", [1.0, 2.0])
    assert not list((tmp_path / "runs").glob("*.unfinished*"))


@pytest.mark.slow
@needs_screen
def test_a_game_with_keys_of_its_own_goes_on_at_its_clock(start: Callable[..., Player], tmp_path: Path) -> None:
    game = games.write(tmp_path, corridor__py=own_keys("{(): 0, 'd': 1, 'a': 2, 'r': 0, 'q': 0}"))
    player = start("play", "corridor.game.toml:short", "-o", "mine.episode.npz")
    player.hold("a")
    # An unfinished episode is written every five seconds.
    unfinished = tmp_path / "mine.unfinished.episode.npz"
    player.until(unfinished.exists, "keeps an unfinished episode")
    player.release("a")
    player.hold("d")
    player.until((tmp_path / "mine.episode.npz").exists, "records its episode")
    player.release("d")
    # After the end, R is no key of the game. In the next episode, Q is one again.
    player.press("r")
    player.until_pressed(unfinished.exists, "q")
    player.press("Escape")
    out = player.ended()
    assert "success after" in out
    assert "stopped after" in out
    episode = played(tmp_path / "mine.episode.npz", game)
    assert episode.success and len(episode.actions) > 10
    assert {0.0, 1.0, 2.0} >= {*episode.actions[:, 0].tolist()} >= {1.0, 2.0}
    assert not list(tmp_path.glob("*unfinished*"))


@needs_screen
def test_a_person_records_demonstrations_of_a_scene(start: Callable[..., Player], tmp_path: Path) -> None:
    game = games.write(tmp_path)
    player = start("record", "corridor.game.toml:short", "--by", "keyboard", "--episodes", "1", "-o", "mine")
    player.until_pressed(lambda: bool(list((tmp_path / "mine").glob("*.npz"))), "3", "3", "3", "2", "2", "2")
    player.press("Escape")
    out = player.ended()
    assert "1 of 1 demonstrations are in mine" in out
    (path,) = (tmp_path / "mine").glob("*.npz")
    assert played(path, game).success


@needs_screen
def test_a_person_goes_on_after_a_lost_game(start: Callable[..., Player], tmp_path: Path) -> None:
    # The first reset only tries the game: the first episode is the second one of the game.
    folder, runs = tmp_path / "game", tmp_path / "runs"
    folder.mkdir()
    mortal(folder, "exit", 2)
    player = start("play", "game/counter.game.toml:short", "--seed", "0", "-o", "runs")
    player.until_pressed((tmp_path / "episodes.fault").exists, "3")
    player.until_pressed(lambda: bool([*runs.glob("*.npz")]), "r", "3", "3", "3", "3", "3")
    player.press("Escape")
    out, err = player.process.communicate(timeout=HANG_S)
    assert player.process.returncode == 0, err
    assert "warning[TLT0791]: 1 episode was lost: the game `counter.game.toml` ended with exit status 3" in err
    assert "now: exit" in err and "success after" in out


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "spaces.Discrete(3)",
            "spaces.Box(-1, 1, (2,))",
            "error[TLT0731]: the game of `short` has no actions that keys",
        ),
        ('"render_modes": ["rgb_array"]', '"render_modes": []', "error[TLT0830]: cannot open a window here"),
        (
            "    def render(self):",
            "    def draw(self):",
            "error[TLT0781]: the game's `render` raises NotImplementedError",
        ),
        ("return picture\n", "return None\n", "error[TLT0731]: the game of `short` renders no pictures"),
        (
            "length=5, render_mode=None):\n    return",
            "length=5):\n    render_mode = None\n    return",
            "give `corridor:make` an argument `render_mode`",
        ),
        # No option can set an argument that has no keyword.
        (
            "def make(scene, length=5, render_mode=None):",
            "def make(scene, render_mode=None, /, length=5):",
            "give `corridor:make` an argument `render_mode`",
        ),
    ],
)
def test_games_that_nobody_can_play_are_reported(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    old: str,
    new: str,
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("SDL_VIDEODRIVER", "x11")
    assert old in games.GRID
    games.write(tmp_path, corridor__py=games.GRID.replace(old, new))
    result = tltlc("play", "corridor.game.toml:short")
    assert result.status == (2 if "TLT0731" in result.err else 1)
    assert message in result.err
    assert not list(tmp_path.glob("*.npz"))
