"""The client in C#: it passes the conversation with Mono, keeps every number, and plays as a component of Unity."""

from __future__ import annotations

import json
import os
import re
import shutil
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from math import isinf
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.runtime.wire import conversation, recorded_tapes
from tests.runtime.wire.recorded_traces import cells
from tests.runtime.wire.test_env import connected, free_port
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire.clients import tltl_client
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame

CLIENT = Path(tltl_client.__file__).with_name("TltlClient.cs")
STRICT = ("-langversion:6", "-warn:4", "-warnaserror")

pytestmark = pytest.mark.skipif(
    not (shutil.which("mcs") and shutil.which("mono")), reason="there is no Mono here: no client in C# is run"
)

UNITY = """
namespace UnityEngine
{
    public class Object { }
    public class MonoBehaviour : Object { }
    public static class Time { public static float fixedDeltaTime = 0.02f, timeScale = 1f; }
    public enum SimulationMode { FixedUpdate, Update, Script }
    public static class Physics
    {
        public static SimulationMode simulationMode;
        public static int ticks;
        public static void Simulate(float step) { ticks++; }
    }
    public static class QualitySettings { public static int vSyncCount = 1; }
    public static class Application
    {
        public static int status = -1;
        public static void Quit(int code) { status = code; }
    }
}

internal sealed class Walk : TltlGame
{
    private int _speed;

    public override Tltl.Message Hello
    {
        get
        {
            return new Tltl.Message
            {
                {"signals", new Tltl.Message {{"ticks", new Tltl.Message()}, {"speed", new Tltl.Message()}}},
                {"actions", new Tltl.Message {{"type", "box"}, {"low", -9}, {"high", 9}, {"shape", new[] {2}}}},
            };
        }
    }

    public override Tltl.State Reset(string scene, string variant, long? seed)
    {
        UnityEngine.Physics.ticks = _speed = 0;
        return Now();
    }

    protected override void Tick(object action) { _speed = (int)Tltl.TltlClient.Numbers(action)[1]; }

    protected override Tltl.State Now()
    {
        return new Tltl.State(new Tltl.Message {{"ticks", UnityEngine.Physics.ticks}, {"speed", _speed}});
    }

    private static int Main()
    {
        var game = new Walk();
        Call(game, "Start");
        for (int frame = 0; UnityEngine.Application.status < 0 && frame < 9; frame++) Call(game, "Update");
        bool isPaused = UnityEngine.Time.timeScale == 0 && UnityEngine.QualitySettings.vSyncCount == 0
            && UnityEngine.Physics.simulationMode == UnityEngine.SimulationMode.Script;
        System.Console.Error.WriteLine(isPaused);
        return UnityEngine.Application.status;
    }

    private static void Call(TltlGame game, string name)
    {
        var flags = System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic;
        typeof(TltlGame).GetMethod(name, flags).Invoke(game, null);
    }
}
"""
"""A stand-in for the parts of Unity that the example uses, and a game."""

DRIVER = """
using System.Collections.Generic;

internal sealed class Driver
{
    private static int Main(string[] words)
    {
        var german = System.Globalization.CultureInfo.GetCultureInfo("de-DE");
        System.Threading.Thread.CurrentThread.CurrentCulture = german;
        if (1.5.ToString() != "1,5") return 3;
        if (words.Length > 1) return RecordTape(words[0]);
        if (words.Length > 0) return Record(words[0]);
        System.Console.InputEncoding = System.Console.OutputEncoding = new System.Text.UTF8Encoding(false);
        for (string line; (line = System.Console.In.ReadLine()) != null;)
        {
            string answer;
            try { answer = "right " + Tltl.Json.Text(Tltl.Json.Parse(line)); }
            catch (System.FormatException error) { answer = "wrong " + error.Message; }
            System.Console.Out.Write(answer + "\\n");
            System.Console.Out.Flush();
        }
        return 0;
    }

    private static int RecordTape(string folder)
    {
        double[] sizes = {5e-324, -0.0, 1e-300, 1e22, -123456.789, 0.1};
        using (var recorder = new Tltl.Recorder(folder, new[] {"near(a, b)", "size", "seen"}, 60, "walk"))
        {
            recorder.Begin("crypt", "v1", 7);
            try { recorder.Sample(new Tltl.Message {{"near(a, b)", double.NaN}, {"size", 2}, {"seen", false}}, 0); }
            catch (System.ArgumentException) {}
            for (int step = 1; step <= 130; step++)
            {
                var values = new Tltl.Message {{"near(a, b)", step / 3.0}, {"size", sizes[step % 6]}, {"seen", false}};
                if (step == 3) values["near(a, b)"] = true;
                if (step > 128) values["seen"] = step - 129;
                recorder.Sample(values, new[] {step % 3, 1});
            }
            recorder.Begin();
            var signals = new Tltl.Message {{"near(a, b)", 1}, {"size", 2}, {"seen", false}};
            recorder.Sample(signals);
            try { recorder.Sample(signals, 1); return 4; }
            catch (System.InvalidOperationException error) { System.Console.Out.Write(error.Message + "\\n"); }
            recorder.Begin("crypt", null, 7);
            recorder.Sample(signals, 1);
        }
        return 0;
    }

    private static int Record(string folder)
    {
        using (var recorder = new Tltl.Recorder(folder, new[] {"near(a, b)", "seen"}, 60))
        {
            foreach (bool last in new[] {true, false})
            {
                System.Console.Out.Write(recorder.Begin() + "\\n");
                for (int step = 0; step < 4; step++)
                {
                    recorder.Sample(new Tltl.Message
                    {
                        {"near(a, b)", step / 3.0}, {"seen", last && step == 3}, {"unused", 1},
                    });
                }
            }
        }
        using (var other = new Tltl.Recorder(folder, new[] {"x"}))
        {
            other.Begin();
            foreach (object value in new object[] {double.NaN, float.PositiveInfinity, "1", null})
            {
                try { other.Sample(new Tltl.Message {{"x", value}}); return 4; }
                catch (System.ArgumentException error) { System.Console.Out.Write(error.Message + "\\n"); }
            }
            try { other.Sample(new Tltl.Message {{"y", 1}}); return 5; }
            catch (KeyNotFoundException error) { System.Console.Out.Write(error.Message + "\\n"); }
        }
        object[] values = {
            0.1f, 1.5m, ulong.MaxValue, System.DayOfWeek.Friday, new[,] {{1, 2}, {3, 4}}, new byte[] {7}, 'x', -0.0,
            new Dictionary<string, double> {{"y", 1e-300}}, 1234567890123457.0 * double.Epsilon,
        };
        System.Console.Out.Write(Tltl.Json.Text(values) + "\\n");
        object[] wrong = {double.NaN, new[] {float.NegativeInfinity}, new System.DateTime(), new Driver()};
        foreach (object value in wrong)
        {
            try { Tltl.Json.Text(value); return 6; }
            catch (System.ArgumentException error) { System.Console.Out.Write(error.Message + "\\n"); }
        }
        return 0;
    }
}
"""
"""Echoes lines of JSON, or tries the recorder, where a decimal point is a comma."""


def build(folder: Path, *sources: Path) -> Path:
    """Compile sources with the client, and return the path of the program."""
    program = folder / "game.exe"
    command = ["mcs", *STRICT, f"-out:{program}", str(CLIENT), *map(str, sources)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return program


def examples() -> tuple[str, str]:
    """Return the two programs in the head comment of the client: a game without an engine, and one for Unity."""
    head = CLIENT.read_text(encoding="utf-8").partition("\nnamespace")[0]
    blocks = [
        re.sub(r"^// {0,5}", "", block, flags=re.M) for block in re.findall(r"(?:^//(?:     .*)?\n)+", head, re.M)
    ]
    plain, unity = (block for block in blocks if "using Tltl;" in block)
    return plain, unity


@pytest.fixture(scope="module")
def counter(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the path of the game of the conversation."""
    return str(build(tmp_path_factory.mktemp("counter"), GAMES / "Counter.cs"))


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the path of the program ``DRIVER``."""
    folder = tmp_path_factory.mktemp("driver")
    (folder / "Driver.cs").write_text(DRIVER, encoding="utf-8")
    return str(build(folder, folder / "Driver.cs"))


@pytest.fixture(scope="module")
def echo(driver: str) -> Iterator[Callable[[str], str]]:
    """Return a function that lets the client read and write a line of JSON."""
    with subprocess.Popen(
        ["mono", driver], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
    ) as process:
        assert process.stdin is not None and process.stdout is not None
        lines, answers = process.stdin, process.stdout

        def ask(line: str) -> str:
            lines.write(line + "\n")
            lines.flush()
            return answers.readline().rstrip("\n")

        yield ask
        lines.close()


def test_the_client_passes_the_conversation(counter: str) -> None:
    lines: list[str] = []
    assert conversation.check(["mono", counter], lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10


def test_a_request_that_makes_no_sense_is_refused(counter: str) -> None:
    requests: list[tuple[Any, str]] = [
        ({"step": {}}, "the request `step` has no `action`"),
        ({"step": 3}, "the request `step` has no `action`"),
        ({"step": {"action": "left"}}, 'expected a whole number, received "left"'),
        ({"step": {"action": [1]}}, "expected a whole number, received [1]"),
        ({"step": {"action": 1.5}}, "expected a whole number, received 1.5"),
        ({"step": {"action": 2**40}}, "1099511627776 is too large"),
        ({"step": {"action": 1, "repeat": None}}, ""),
        ({"reset": {"seed": True}}, "expected a whole number, received true"),
        ({"reset": {"seed": 2.0, "scene": 3}}, ""),
        ({"restore": {}}, "the request `restore` has no `id`"),
        ({}, "this game does not know the request ``"),
    ]
    with conversation.Game(["mono", counter]) as game:
        conversation.hello(game)
        for request, reason in requests:
            answer = game.ask(request)
            assert answer == {"error": {"message": reason}} if reason else "state" in answer, request
        game.send([1])
        game.disconnect()
        assert game.status() == 1 and game.stderr() == "tltlc sent a line that is no object of JSON"


def test_without_tltlc_the_game_says_why_it_ends(counter: str) -> None:
    variables = {key: value for key, value in os.environ.items() if not key.startswith("TLTL_")}
    for port, reason in (
        ("", "tltlc must start this game: the variable TLTL_PORT is not set"),
        ("5e3", "cannot connect to tltlc at port 5e3: that is no port"),
    ):
        result = subprocess.run(
            ["mono", counter],
            capture_output=True,
            text=True,
            env={**variables, "TLTL_PORT": port},
            timeout=HANG_S,
            check=False,
        )
        assert (result.returncode, result.stderr) == (1, reason + "\n")


def test_a_running_game_is_played_again_and_again(counter: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TLTL_TOKEN", "open sesame")
    port = free_port()
    words = ["mono", counter, "--listen", str(port)]
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True) as process:
        try:
            for token in ("open sesame", "open barley", "open sesame"):
                monkeypatch.setenv("TLTL_TOKEN", token)
                if token == "open barley":
                    with pytest.raises(WireError, match="TLT0793: the game `counter` reports: the token is wrong"):
                        connected(port)
                    continue
                env = connected(port)
                env.reset(seed=0)
                assert env.step(2)[0].tolist() == [2]
                env.close()
        finally:
            process.kill()


def test_two_running_games_cannot_share_a_port(counter: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = other.getsockname()[1]
        words = ["mono", counter, "--listen", str(port)]
        second = subprocess.run(words, stderr=subprocess.PIPE, text=True, timeout=HANG_S, check=False)
    assert second.returncode == 1 and f"cannot listen on port {port}" in second.stderr


def test_the_game_in_the_head_comment_is_played(tmp_path: Path) -> None:
    source = tmp_path / "Walk.cs"
    source.write_text(examples()[0], encoding="utf-8")
    program = build(tmp_path, source)
    env = WireEnv(WireGame("walk", tmp_path, ("mono", program.name), start_s=HANG_S, step_s=HANG_S))
    env.reset(seed=3)
    assert [env.step(2)[2] for _ in range(2)] == [False, True]
    assert env.tltl_cause() == "goal" and env.tltl_signals() == {"position": 5, "at_goal": True}
    with pytest.raises(WireError, match="there is no variant `v9`"):
        env.reset(options={"variant": "v9"})
    env.close()


def test_the_component_in_the_head_comment_is_played(tmp_path: Path) -> None:
    """Unity is not here; a stand-in for its library and its loop is."""
    (tmp_path / "Unity.cs").write_text(UNITY, encoding="utf-8")
    (tmp_path / "Game.cs").write_text(examples()[1], encoding="utf-8")
    program = build(tmp_path, tmp_path / "Game.cs", tmp_path / "Unity.cs")
    with conversation.Game(["mono", str(program)]) as game:
        assert "hello" in game.receive()
        assert "state" in game.ask({"reset": {}})
        answer = game.ask({"step": {"action": [0, 2.0], "repeat": 3}})
        assert answer["state"]["signals"] == {"ticks": 3, "speed": 2}
        assert "telepathy" in game.ask({"telepathy": {}})["error"]["message"]
        game.send({"close": {}})
        assert (game.status(), game.stderr()) == (0, "True")
    with conversation.Game(["mono", str(program)]) as game:
        game.receive()
        game.send({"error": {"message": "because it is a test"}})
        assert (game.status(), game.stderr()) == (1, "because it is a test\nTrue")
    variables = {key: value for key, value in os.environ.items() if not key.startswith("TLTL_")}
    alone = subprocess.run(
        ["mono", str(program)], capture_output=True, text=True, env=variables, timeout=HANG_S, check=False
    )
    assert alone.stderr == "False\n", "without tltlc, the clock is not stopped"


TEXTS = st.text(st.characters(exclude_categories=()))
NUMBERS = st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False, allow_infinity=False)
VALUES = st.recursive(
    st.none() | st.booleans() | NUMBERS | TEXTS,
    lambda parts: st.lists(parts) | st.dictionaries(TEXTS, parts),
)


@given(VALUES, st.booleans())
def test_a_message_keeps_its_values(echo: Callable[[str], str], value: Any, is_ascii: bool) -> None:
    line = json.dumps(value, ensure_ascii=is_ascii)
    if not is_ascii and any("\ud800" <= char <= "\udfff" for char in line):
        line = json.dumps(value)  # UTF-8 has no lone surrogates.
    kind, _, answer = echo(line).partition(" ")
    assert kind == "right" and same(json.loads(answer), value)


def same(one: Any, other: Any) -> bool:
    """Whether two values of JSON are equal; numbers by value, and bools are no numbers."""
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    return bool(one == other) and isinstance(one, bool) == isinstance(other, bool)


def refuse(name: str) -> None:
    raise ValueError(name)


def finite(text: str) -> float:
    if isinf(value := float(text)):
        raise ValueError(text)
    return value


@given(VALUES.map(json.dumps), st.data())
def test_a_broken_line_is_refused(echo: Callable[[str], str], line: str, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(line)))
    more = data.draw(st.text(st.sampled_from('{}[]",:-+.eE0123456789tfnul\\u \t\x01N'), max_size=2))
    text = line[:at] + more + line[at + data.draw(st.integers(0, 2)) :]
    try:
        value = json.loads(text, parse_constant=refuse, parse_float=finite, parse_int=lambda word: whole(word))
    except ValueError:
        assert echo(text).startswith("wrong the line is not JSON at character ")
        return
    kind, _, answer = echo(text).partition(" ")
    assert kind == "right" and same(json.loads(answer), value)


NUMERALS = st.builds(
    "{}.{}e{}".format, st.integers(0, 10**25), st.from_regex(r"[0-9]{1,40}", fullmatch=True), st.integers(-360, 310)
)


@given(NUMERALS)
@example("1.7976931348623157e308")
@example("2.2250738585072011e-308")
@example("2.5e-324")
@example("2.4e-324")
@example("9007199254740993.0")
@example("9007199254740993." + "0" * 500 + "1")
@example("0." + "0" * 400 + "123456789e390")
@example("1" * 400 + "e-390")
@example("-0e99999999999")
def test_a_numeral_is_read_exactly(echo: Callable[[str], str], text: str) -> None:
    kind, _, answer = echo(text).partition(" ")
    if isinf(float(text)):
        assert kind == "wrong"
    else:
        assert kind == "right" and json.loads(answer) == float(text)


def whole(word: str) -> float:
    """Return a whole number as the client has it: exactly if it fits into 64 bits."""
    number = int(word)
    return number if -(2**63) <= number < 2**63 else finite(word)


@pytest.mark.parametrize(
    "text", ["", " ", "nul", "[" * 5000, '{"a":' * 5000, "1e999", "NaN", "-", "[1,]", '"\\ud8"', "\0"]
)
def test_a_hostile_line_is_refused(echo: Callable[[str], str], text: str) -> None:
    assert echo(text).startswith("wrong the line is not JSON at character ")


def test_a_recorded_trace_is_judged(driver: str, tmp_path: Path) -> None:
    folder = tmp_path / "traces"
    output = subprocess.run(["mono", driver, str(folder)], capture_output=True, text=True, timeout=HANG_S, check=False)
    assert output.returncode == 0, output.stderr
    first, second, *rest = output.stdout.splitlines()
    assert [first, second] == [str(folder / f"trace-000{number}.csv") for number in (1, 2)]
    values = rest.pop(5)
    assert json.loads(values)[-1] == 1234567890123457 * 5e-324
    assert values.startswith('[0.10000000149011612,1.5,18446744073709551615,5,[[1,2],[3,4]],[7],"x",0,{"y":1E-300},')
    assert rest == [
        "the signal x is NaN, and numbers must be finite",
        "the signal x is Infinity, and numbers must be finite",
        "the signal x is no number and no bool",
        "the signal x is no number and no bool",
        "the signal x is missing",
        "the number NaN is not finite",
        "the number -Infinity is not finite",
        "a message cannot contain a System.DateTime",
        "a message cannot contain a Driver",
    ]
    recorder = tltl_client.Recorder(tmp_path / "python", ["near(a, b)", "seen"], clock_hz=60)
    path = recorder.begin()
    for step in range(4):
        recorder.sample({"near(a, b)": step / 3, "seen": step == 3})
    recorder.end()
    names, *rows = path.read_text(encoding="utf-8").splitlines()
    other_names, *other_rows = Path(first).read_text(encoding="utf-8").splitlines()
    assert names == other_names == 'time,"near(a, b)",seen'
    assert [cells(row) for row in rows] == [cells(row) for row in other_rows]
    spec = tmp_path / "see.tltl"
    text = "clock 60 Hz\nsignal near(a, b): number in [0, 1]\nsignal seen: bool\nspec see = F seen\n"
    spec.write_text(text, encoding="utf-8")
    assert not (folder / "trace-0003.csv").exists()  # All of its samples were refused.
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(folder)]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert "1 of 2 accepted" in result.stdout, result.stderr


def test_a_recorder_writes_the_tape_of_a_play(driver: str, tmp_path: Path) -> None:
    (tmp_path / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    words = ["mono", driver, str(tmp_path), "tape"]
    result = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert (result.returncode, result.stdout) == (0, "give the action of each sample of an episode, or of none\n")
    tape = recorded_tapes.check_tape(tmp_path / "trace-0002.tape.jsonl", tmp_path)
    assert "csharp" in tape.header.versions
    assert (tmp_path / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert not (tmp_path / "trace-0003.tape.jsonl").exists()
    recorded_tapes.check_tape_without_a_variant(tmp_path / "trace-0004.tape.jsonl")
