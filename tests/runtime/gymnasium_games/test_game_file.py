from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.gymnasium_games import games
from tltl_runtime.gymnasium_games.game_argument import parse_game, scene_of, variant_of
from tltl_runtime.gymnasium_games.game_file import FunctionName, read_game_file
from tltlc.api import TltlError
from tltlc.diagnostics.render import render


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def errors_of(folder: Path, text: str) -> str:
    path = games.write(folder, corridor__game__toml=text)
    with pytest.raises(TltlError) as error:
        read_game_file(path)
    return render(error.value.diagnostics)


def test_a_game_file_is_read(folder: Path) -> None:
    game = read_game_file(games.write(folder))
    assert (game.name, game.gymnasium, game.python) == ("corridor", None, FunctionName("corridor", "make"))
    assert game.clock_s == 0.1
    assert game.observation == ("cell", "has_key")
    assert [scene.name for scene in game.scenes] == ["short", "long"]
    assert game.scenes[0].variants["v0"].options == {"length": 4}
    assert game.scenes[0].variants["v1"].options == {"length": 8}
    spec = game.scenes[0].variants["v1"].spec
    assert spec is not None
    assert (spec.file.name, spec.name) == ("corridor.tltl", "fetch")
    assert game.scenes[1].variants["v0"].spec is None


def test_a_game_without_scenes_has_one_that_is_named_after_the_file(folder: Path) -> None:
    game = read_game_file(games.cartpole(folder))
    assert [scene.name for scene in game.scenes] == ["cartpole"]
    assert game.clock_s == 0.02


@pytest.mark.parametrize(
    ("text", "seconds"), [("20 Hz", 0.05), ("0.25 s", 0.25), ("50 ms", 0.05), ("1 min", 60.0), ("4Hz", 0.25)]
)
def test_a_clock_is_a_frequency_or_a_period(folder: Path, text: str, seconds: float) -> None:
    path = games.write(folder, corridor__game__toml=f'[game]\ngymnasium = "A-v0"\nclock = "{text}"\n')
    assert read_game_file(path).clock_s == pytest.approx(seconds)


@pytest.mark.parametrize("text", ["10", "0 Hz", "-1 s", "3 m", "10 Hz signal a: bool", "1e-12 s", "10 Hz // fast"])
def test_another_clock_is_an_error(folder: Path, text: str) -> None:
    message = errors_of(folder, f'[game]\ngymnasium = "A-v0"\nclock = "{text}"\n')
    assert f'error[TLT0803]: wrong value for `clock`: "{text}"' in message
    assert "corridor.game.toml:3:1" in message


def test_all_errors_are_reported_at_once(folder: Path) -> None:
    message = errors_of(
        folder,
        """\
scene_name = "x"
[game]
gymnasium = "A-v0"
python = "corridor:make"
signal = "corridor:signals"
import = ["not a module"]
process = ["godot"]
name = "short"

[[scene]]
name = "a b"
option = {}
clock = "10 Hz"
files = ["missing.tmx"]
spec = "corridor.txt"

[[scene]]
name = "twice"
options = { day = 1979-05-27 }
variants = { v0 = {}, v1 = { opts = {} } }

[[scene]]
name = "twice"
""",
    )
    for expected in (
        "the game file has no key `scene_name`",
        "`[game]` has both `gymnasium` and `python`",
        "`[game]` has no key `signal`",
        "did you mean `signals`?",
        "wrong value for `import`",
        "it is a key of `[[scene]]`",
        'wrong value for `name`: "a b"',
        "did you mean `options`?",
        "it is a key of `[game]`",
        "there is no file `missing.tmx`",
        'wrong value for `spec`: "corridor.txt"',
        "wrong value for `day`: a date or a time",
        "a variant cannot be called `v0`",
        "has no key `opts`",
        "two scenes are called `twice`",
    ):
        assert expected in message
    assert message.count("error[") == message.count("\n  corridor.game.toml:")


def test_a_misspelt_key_is_labelled_where_it_stands(folder: Path) -> None:
    message = errors_of(
        folder,
        """\
[game]
gymnasium = "A-v0"
optoins = { size = 4 }

[[scene]]
name = "x"
signls = "a:b"
variants = { v1 = { optins = { size = 3 } } }
""",
    )
    for place, help_ in (
        ("3:1", "did you mean `options`, a key of `[[scene]]`?"),
        ("7:1", "did you mean `signals`, a key of `[game]`?"),
        ("8:21", "did you mean `options`?"),
    ):
        assert f"corridor.game.toml:{place}\n" in message and help_ in message


def test_a_file_without_a_game_is_an_error(folder: Path) -> None:
    assert "the game file lacks `game`" in errors_of(folder, '[[scene]]\nname = "a"\n')
    assert "`[game]` does not say how the environment is made" in errors_of(folder, "[game]\n")


@pytest.mark.parametrize("link", [False, True])
def test_files_must_be_in_the_folder_unless_the_user_allows_others(folder: Path, link: bool) -> None:
    (folder / "map.txt").write_text("x", encoding="utf-8")
    inside = folder / "game"
    inside.mkdir()
    if link:
        (inside / "map.txt").symlink_to(folder / "map.txt")
    name = "map.txt" if link else "../map.txt"
    text = f'[game]\ngymnasium = "A-v0"\n[[scene]]\nname = "a"\nfiles = ["{name}"]\n'
    message = errors_of(inside, text)
    assert f"`{name}` is outside the folder of the game file" in message
    game = read_game_file(inside / "corridor.game.toml", allow_outside=True)
    assert [file.name for file in game.scenes[0].variants["v0"].files] == ["map.txt"]


def test_a_loop_of_links_is_an_error(folder: Path) -> None:
    (folder / "loop").symlink_to(folder / "loop")
    text = '[game]\ngymnasium = "A-v0"\n[[scene]]\nname = "a"\nfiles = ["loop", "nul\\u0000"]\n'
    assert errors_of(folder, text).count("TLT0805") == 2


def test_a_game_has_a_limit_of_scenes(folder: Path) -> None:
    scenes = "".join(f'[[scene]]\nname = "s{number}"\n' for number in range(2_001))
    assert "error[TLT0006]" in errors_of(folder, f'[game]\ngymnasium = "A-v0"\n{scenes}')


@pytest.mark.parametrize(
    ("argument", "parts"),
    [
        ("a.game.toml", ("a.game.toml", None, None)),
        ("a.game.toml:short", ("a.game.toml", "short", None)),
        ("/x/a.game.toml:short:v1", ("/x/a.game.toml", "short", "v1")),
        ("C:\\x\\a.game.toml:short", ("C:\\x\\a.game.toml", "short", None)),
    ],
)
def test_an_argument_names_a_game_file_a_scene_and_a_variant(
    argument: str, parts: tuple[str, str | None, str | None]
) -> None:
    game = parse_game(argument)
    assert (str(game.path), game.scene, game.variant) == parts


def test_other_arguments_are_errors(folder: Path) -> None:
    games.write(folder)
    with pytest.raises(TltlError) as error:
        parse_game("corridor")
    assert "did you mean the file `corridor.game.toml`?" in render(error.value.diagnostics)
    game = read_game_file(folder / "corridor.game.toml")
    assert scene_of(game, None).name == "short"
    with pytest.raises(TltlError, match="no scene `shrt`"):
        scene_of(game, "shrt")
    with pytest.raises(TltlError, match="no variant `v2`"):
        variant_of(game, "short", "v2")


def test_a_game_in_another_process(folder: Path) -> None:
    text = '[game]\nprocess = ["godot", "--headless"]\nstart_s = 60\nstep_s = 0.5\n'
    wire = read_game_file(games.write(folder, corridor__game__toml=text)).wire
    assert wire is not None
    assert (wire.process, wire.connect, wire.start_s, wire.step_s) == (("godot", "--headless"), "", 60.0, 0.5)
    assert wire.folder.resolve() == folder.resolve()
    text = '[game]\nconnect = "127.0.0.1:5000"\nprotocol = "tltl"\n'
    other = read_game_file(games.write(folder, corridor__game__toml=text)).wire
    assert other is not None
    assert (other.process, other.connect) == ((), "127.0.0.1:5000")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('process = ["a"]\nconnect = "h:1"', "`[game]` has both `process` and `connect`"),
        ('gymnasium = "A-v0"\nprocess = ["a"]', "`[game]` has both `gymnasium` and `process`"),
        ('gymnasium = "A-v0"\nstep_s = 3', "`step_s` is for games in other processes"),
        ("process = []", "wrong value for `process`"),
        ('process = ["a"]\nprotocol = "smoke"', "wrong value for `protocol`"),
        ('process = ["a"]\nstep_s = 0', "wrong value for `step_s`"),
        ('connect = "somewhere"', "`somewhere` is not an address"),
        ("", "does not say how the environment is made"),
    ],
)
def test_wrong_games_in_other_processes_are_reported(folder: Path, text: str, message: str) -> None:
    assert message in errors_of(folder, f"[game]\n{text}\n")
