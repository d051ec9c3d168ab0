"""``tltlc new --game``: each starter is a game that its own README can check, train and test."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from random import Random
from runpy import run_path
from typing import Any

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.regression.page import chromium
from tests.runtime.wire.test_web_game import served
from tests.waiting import HANG_S
from tltl_runtime import read_tape
from tltl_runtime.cli.support import game_starter
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.scene_env import make_base_env
from tltlc.interfaces.cli.commands import new

Run = Callable[..., Outcome]
CLIENTS = Path(game_starter.__file__).parents[2] / "wire" / "clients"
FEW = "[rollout]\nenvs = 2\nsteps = 16\nworkers = 1\n[network]\nhidden = [8]\n[exploration]\nways = 0\n"
IN_PROCESSES = {
    "web": ["node", "node.js"],
    "love": ["lua5.4", "headless.lua"],
    "godot": ["godot3-server", "--path", ".", "--fixed-fps", "10", "--disable-render-loop"],
    "unity": ["mono", "hall.exe"],
    "unreal": ["./hall"],
}
"""The games in other processes, and the command of each that can run here: LÖVE needs a screen."""
UNITY = """
namespace UnityEngine
{
    public class MonoBehaviour { }
    public enum KeyCode { UpArrow, DownArrow, LeftArrow, RightArrow }
    public struct Rect { public Rect(float x, float y, float width, float height) { } }
    public static class GUI { public static void Label(Rect place, string text) { } }
    public static class Input
    {
        public static KeyCode? pressed;
        public static bool GetKeyDown(KeyCode key) { return key == pressed; }
    }
    public static class Random { public static int Range(int least, int bound) { return least; } }
    public static class QualitySettings { public static int vSyncCount; }
    public static class Application { public static void Quit(int status) { } }
}

internal static class Person
{
    private static void Main(string[] words)
    {
        var hall = new HallBehaviour();
        Call(hall, "Start");
        if (words.Length > 0)
        {
            UnityEngine.Input.pressed = UnityEngine.KeyCode.UpArrow;
            Call(hall, "Update");
        }
        Call(hall, "OnDestroy");
    }

    private static void Call(HallBehaviour hall, string name)
    {
        var flags = System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic;
        typeof(HallBehaviour).GetMethod(name, flags).Invoke(hall, null);
    }
}
"""
"""A stand-in for the parts of Unity that the starter uses, and a person who moves once if there is an argument."""
_COMMAND = re.compile(r"^    tltlc (.+?)(?:  +.*)?$", re.MULTILINE)


@pytest.fixture(name="made")
def _made(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], list[str]]:  # noqa: F811
    """A function that makes a starter, enters its folder, and returns the commands to go on with."""

    def make(kind: str) -> list[str]:
        monkeypatch.chdir(tmp_path)
        result = tltlc("new", "my game", "--game", kind)
        assert result.status == 0, result.err
        first, *others = re.findall(r"^Next: (.*)$", result.err, re.MULTILINE)
        assert first == "cd 'my game'"
        monkeypatch.chdir(tmp_path / "my game")
        for command in others:
            if not command.startswith("tltlc "):
                assert command in runs_of_workflow()
                compile_it(command)
        return [command.removeprefix("tltlc ") for command in others if command.startswith("tltlc ")]

    return make


def compile_it(command: str) -> None:
    """Run the command of a starter that compiles its game; skip the test if there is no such compiler."""
    words = command.split()
    if shutil.which(words[0]) is None:
        pytest.skip(f"needs {words[0]}")
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert (result.returncode, result.stderr) == (0, "")


def play_all(tltlc: Run, commands: list[str]) -> None:  # noqa: F811
    """Run the commands of a starter, with a training of a few steps."""
    Path("settings.toml").write_text(FEW)
    Path("suite.toml").write_text(Path("suite.toml").read_text().replace("episodes = 50", "episodes = 25"))
    for command in commands:
        words = command.split()
        short = {"train": ["--steps", "64"], "baseline": ["--workers", "1"], "regress": ["--workers", "1"]}
        result = tltlc(*words, *short.get(words[0], []))
        # A training of a few steps does not succeed, and its agent may fail.
        assert result.status in ((0, 1) if words[0] in short else (0,)), result.err
        assert "error[" not in result.err
    assert Path("agent/policy.safetensors").is_file()
    assert Path("suite.baseline.json").is_file()


def test_the_starter_in_python_runs(tltlc: Run, made: Callable[[str], list[str]]) -> None:  # noqa: F811
    commands = made("python")
    play_all(tltlc, commands)
    listed = _COMMAND.findall(Path("README.md").read_text())
    assert [command for command in listed if command in commands] == commands
    result = tltlc("check", "--game", "hall.game.toml")
    assert "hall:v0 has the signals that `leave` uses" in result.err
    assert "equal seeds and actions give equal plays: yes" in result.err
    in_workflow = [run.removeprefix("tltlc ") for run in runs_of_workflow() if run.startswith("tltlc ")]
    assert [command.split()[0] for command in in_workflow] == ["test", "check", "regress"]
    for command in in_workflow:
        # The agent of a few steps may fail.
        assert tltlc(*command.split()).status in ((0, 1) if command.startswith("regress") else (0,)), command
    assert all(Path(name).is_file() for name in ("levels.xml", "report/report.html"))


def runs_of_workflow() -> list[str]:
    """Return the commands that the CI file of a starter runs."""
    return re.findall(r"^ +- run: (.*)$", Path(".github/workflows/levels.yml").read_text(), re.MULTILINE)


@pytest.mark.parametrize("kind", IN_PROCESSES)
def test_the_starters_in_processes_are_checked(tltlc: Run, made: Callable[[str], list[str]], kind: str) -> None:  # noqa: F811
    commands = made_in_process(made, kind)
    result = tltlc(*commands[0].split())
    assert result.status == 0, result.err
    assert "hall:v0 has the signals that `leave` uses" in result.err
    assert "equal seeds and actions give equal plays: yes" in result.err
    listed = _COMMAND.findall(Path("README.md").read_text())
    assert [command for command in listed if command in commands] == commands


@pytest.mark.parametrize("kind", IN_PROCESSES)
def test_the_starters_are_one_game(made: Callable[[str], list[str]], tmp_path: Path, kind: str) -> None:
    made("python")
    hall = run_path("hall.py")["make"]("hall")
    (tmp_path / "my game").rename(tmp_path / "python")
    made_in_process(made, kind)
    env = make_base_env(read_game_file(Path("hall.game.toml")), "hall")
    choose = Random(kind)
    for seed in range(20):
        env.reset(seed=seed)
        hall.reset()
        hall.player = hall.starts[seed % len(hall.starts)]
        for _ in range(40):
            action = choose.randrange(4)
            observation, _, ended, _, _ = env.step(action)
            wanted, _, wanted_end, _, _ = hall.step(action)
            assert (observation.tolist(), ended) == (wanted.tolist(), wanted_end)
            assert env.tltl_signals() == hall.tltl_signals()
            assert {name: place[:2] for name, place in env.scene_positions().items()} == hall.tltl_positions()
            if ended:
                break
    env.close()


def made_in_process(made: Callable[[str], list[str]], kind: str) -> list[str]:
    """Make a starter whose game is another process; skip the test if the program or its client is missing."""
    words = IN_PROCESSES[kind]
    if kind not in game_starter.kinds():
        pytest.skip(f"needs the client of the kind `{kind}`")
    commands = made(kind)
    if shutil.which(words[0]) is None:
        pytest.skip(f"needs {words[0]}")
    if words[0] == "lua5.4":
        has_sockets = subprocess.run([*words[:1], "-e", "require 'socket'"], capture_output=True, check=False)
        if has_sockets.returncode:
            pytest.skip("needs LuaSocket")
    path = Path("hall.game.toml")
    path.write_text(re.sub("^process = .*$", f"process = {json.dumps(words)}", path.read_text(), flags=re.MULTILINE))
    return commands


def test_a_person_is_recorded_in_the_starter_in_python(tltlc: Run, made: Callable[[str], list[str]]) -> None:  # noqa: F811
    made("python")
    played = subprocess.run(
        [sys.executable, "record.py"],
        input="wwwwaaaaaa\nq\n",
        capture_output=True,
        text=True,
        timeout=HANG_S,
        check=True,
    )
    assert "@" in played.stdout
    result = tltlc("monitor", "hall.tltl", "traces")
    assert result.status in (0, 1), result.err
    assert "trace-0001.csv" in result.out
    check_tape(tltlc, Path("traces/trace-0001.tape.jsonl"))


@pytest.mark.parametrize(("kind", "words"), [("python", [sys.executable, "record.py"]), ("unreal", ["./hall"])])
def test_a_walk_in_the_terminal_becomes_a_trace_if_the_player_moves(
    tltlc: Run,  # noqa: F811
    made: Callable[[str], list[str]],
    kind: str,
    words: list[str],
) -> None:
    made(kind)
    for keys in ("q\n", "w\nq\n", "q\n"):
        subprocess.run(words, input=keys, capture_output=True, text=True, timeout=HANG_S, check=True)
    check_one_trace(tltlc, Path("traces"))


def test_a_walk_in_unity_becomes_a_trace_if_the_player_moves(tltlc: Run, made: Callable[[str], list[str]]) -> None:  # noqa: F811
    """Unity is not here; a stand-in for its library is."""
    made("unity")
    Path("Unity.cs").write_text(UNITY, encoding="utf-8")
    sources = ["Assets/Tltl/TltlClient.cs", "Assets/Hall/Hall.cs", "Assets/Hall/HallBehaviour.cs", "Unity.cs"]
    compile_it(f"mcs -out:person.exe {' '.join(sources)}")
    for words in ([], ["move"], []):
        subprocess.run(["mono", "person.exe", *words], timeout=HANG_S, check=True)
    check_one_trace(tltlc, Path("traces"))


@pytest.mark.skipif(shutil.which("love") is None, reason="love is not installed")
def test_a_walk_in_love_becomes_a_trace_if_the_player_moves(
    tltlc: Run,  # noqa: F811
    made: Callable[[str], list[str]],
    tmp_path: Path,
) -> None:
    made("love")
    modules = ("audio", "graphics", "joystick", "sound", "touch", "video", "window")
    conf = Path("conf.lua").read_text(encoding="utf-8")
    without_screen = "".join(f"t.modules.{name} = false\n" for name in modules)
    Path("conf.lua").write_text(conf.replace("  if os", f"{without_screen}  if os"), encoding="utf-8")
    game = Path("main.lua").read_text(encoding="utf-8")
    for move in ("", 'love.keypressed("up")', ""):
        person = f"\nfunction love.update() {move} love.event.quit() end\n"
        Path("main.lua").write_text(game + person, encoding="utf-8")
        variables = {**os.environ, "XDG_DATA_HOME": str(tmp_path / "data")}
        subprocess.run(["love", "."], env=variables, timeout=HANG_S, check=True)
    check_one_trace(tltlc, tmp_path / "data" / "love" / "hall" / "traces")


@pytest.mark.skipif(shutil.which("godot3-server") is None, reason="needs godot3-server")
def test_a_walk_in_godot_becomes_a_trace_if_the_player_moves(
    tltlc: Run,  # noqa: F811
    made: Callable[[str], list[str]],
    tmp_path: Path,
) -> None:
    made("godot")
    game = Path("hall.gd").read_text(encoding="utf-8")
    variables = {**os.environ, "XDG_DATA_HOME": str(tmp_path / "data")}
    for frame in (99, 2, 99):
        person = (
            "\n\nfunc _process(_delta) -> void:\n"
            f'\tif Engine.get_physics_frames() == {frame}:\n\t\tInput.action_press("ui_up")\n'
            "\tif Engine.get_physics_frames() > 4:\n\t\tget_tree().quit()\n"
        )
        Path("hall.gd").write_text(game + person, encoding="utf-8")
        words = ["godot3-server", "--path", ".", "--fixed-fps", "10", "--disable-render-loop"]
        subprocess.run(words, env=variables, timeout=HANG_S, check=True)
    (folder,) = (tmp_path / "data").rglob("traces")
    check_one_trace(tltlc, folder)


def check_one_trace(tltlc: Run, folder: Path) -> None:  # noqa: F811
    """Check that a folder has one trace and its tape, which can be judged."""
    assert sorted(path.name for path in folder.iterdir()) == ["trace-0001.csv", "trace-0001.tape.jsonl"]
    result = tltlc("monitor", "hall.tltl", folder)
    assert "trace-0001.csv: not accepted: " in result.out, result.err
    check_tape(tltlc, folder / "trace-0001.tape.jsonl")


def check_tape(tltlc: Run, path: Path) -> None:  # noqa: F811
    """Check a tape of a walk: it says what was played, and is judged as its trace."""
    header = read_tape(path).header
    assert (header.game, header.scene, header.variant, header.clock_hz) == ("hall", "hall", "v0", 10)
    assert isinstance(header.seed, int)
    trace = path.with_name(path.name.replace("tape.jsonl", "csv"))
    assert tltlc("monitor", "hall.tltl", path).out == tltlc("monitor", "hall.tltl", trace).out != ""


@pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")
def test_in_the_page_a_new_walk_begins_after_a_saved_one(
    tltlc: Run,  # noqa: F811
    made: Callable[[str], list[str]],
    tmp_path: Path,
) -> None:
    def is_trace(download: Any) -> bool:
        return str(download.suggested_filename).endswith(".csv")

    def is_tape(download: Any) -> bool:
        return not is_trace(download)

    made("web")
    with served(Path.cwd()) as address, chromium.browser() as browser:
        page = browser.new_page()
        page.set_default_timeout(chromium.HANG_MS)
        page.add_init_script("Math.random = () => 0;")
        page.goto(f"{address}/index.html")
        page.wait_for_function("document.getElementById('map').textContent.includes('@')")
        start = page.text_content("#map")
        for number in (1, 2):
            assert page.is_disabled("#save")
            page.keyboard.press("ArrowRight")
            assert page.text_content("#map") != start
            with page.expect_download(is_trace) as trace, page.expect_download(is_tape) as tape:
                page.click("#save")
            for download in (trace.value, tape.value):
                download.save_as(tmp_path / "traces" / download.suggested_filename)
            check_tape(tltlc, tmp_path / "traces" / f"hall-trace-000{number}.tape.jsonl")
            page.wait_for_function("start => document.getElementById('map').textContent === start", arg=start)
    traces = [path.read_text(encoding="utf-8") for path in (tmp_path / "traces").glob("*.csv")]
    assert traces == ["time,has_key,at_door,on_spikes\n0,false,false,false\n"] * 2


@pytest.mark.parametrize("kind", game_starter.kinds())
def test_each_starter_is_complete(tltlc: Run, made: Callable[[str], list[str]], kind: str) -> None:  # noqa: F811
    made(kind)
    assert tltlc("test", "hall.tltl").status == 0
    assert Path(".github/workflows/levels.yml").is_file()
    readme = Path("README.md").read_text()
    assert readme.startswith("# The hall")
    rows = re.findall(r"^\| (`.*?) \| ", readme, re.MULTILINE)
    named = {name for row in rows for name in re.findall("`(.*?)`", row)}
    files = {path.as_posix() for path in Path().rglob("*") if path.is_file()}
    assert len(named) >= 8
    assert [name for name in named if not any(f"/{path}".endswith(f"/{name}") for path in files)] == []
    clients = [path for path in Path().rglob("*") if (CLIENTS / path.name).is_file()]
    assert clients
    assert all(path.read_bytes() == (CLIENTS / path.name).read_bytes() for path in clients)
    assert not [*Path().rglob("*.template"), *Path().rglob("starter.toml"), *Path().rglob("dot_*")]


def test_the_help_names_all_starters() -> None:
    (option,) = [option for option in new.command.params if option.name == "game"]
    folders = sorted(path.parent.name for path in game_starter.KINDS.glob("*/starter.toml"))
    assert sorted(re.findall(r"`(\w+)`", getattr(option, "help", ""))) == folders


def test_wrong_kinds_are_reported(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    result = tltlc("new", "mine", "--game", "pyton")
    assert (result.status, Path("mine").exists()) == (2, False)
    assert "there is no starter for games of the kind `pyton`\n  help: did you mean `python`?" in result.err
    result = tltlc("new", "mine", "--game", "python", "--level", "vault")
    assert result.status == 2
    assert "a new folder has either a level or a game" in result.err
