"""The client in JavaScript: it passes the conversation in Node and in a page, and records traces that tltlc reads."""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

import pytest

from tests.runtime.wire import conversation, recorded_tapes
from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S, until
from tltl_runtime.wire import clients
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame

CLIENT: Final = Path(clients.__file__).with_name("tltl_client.js")
NODE: Final = shutil.which("node") or ""
BROWSER: Final = shutil.which("chromium-headless-shell") or shutil.which("chromium") or ""

pytestmark = pytest.mark.skipif(not NODE, reason="needs Node: apt-get install nodejs")
needs_browser = pytest.mark.skipif(not BROWSER, reason="needs Chromium: apt-get install chromium-headless-shell")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the counter game and the client, as a studio has them."""
    game = tmp_path / "game"
    shutil.copytree(GAMES / "javascript", game)
    shutil.copy(CLIENT, game)
    return game


def node(folder: Path, script: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run a module in Node, with only these environment variables."""
    (folder / "script.js").write_text(script, encoding="utf-8")
    return subprocess.run(
        [NODE, "script.js"], cwd=folder, capture_output=True, text=True, env=variables, timeout=HANG_S, check=False
    )


def wire_game(folder: Path, *words: str) -> WireGame:
    return WireGame("counter", folder, words, start_s=HANG_S, step_s=HANG_S)


def page_command(folder: Path, page: str) -> list[str]:
    """Return a command that opens the game in a page; it changes to the folder first, as tltlc does."""
    start = "import os, sys; os.chdir(sys.argv[1]); os.execvp(sys.argv[2], sys.argv[2:])"
    return [sys.executable, "-c", start, str(folder), NODE, "tltl_client.js", page, BROWSER]


def processes_with(text: str, file: str) -> list[int]:
    """Return the ids of the processes with a text in a file of /proc, such as ``cmdline`` or ``environ``, on Linux."""
    ids = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            data = (entry / file).read_bytes()
        except OSError:
            continue
        if text.encode() in data and int(entry.name) != os.getpid():
            ids.append(int(entry.name))
    return ids


def test_the_client_passes_the_conversation_in_node(folder: Path) -> None:
    lines: list[str] = []
    assert conversation.check([NODE, str(folder / "counter.js")], lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10


@needs_browser
def test_the_client_passes_the_conversation_in_a_page(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("websockets")
    # The browsers inherit this variable.
    monkeypatch.setenv("GAME_OF_THIS_TEST", str(folder))
    lines: list[str] = []
    assert conversation.check(page_command(folder, "index.html"), lines.append), "\n".join(lines)
    assert len(lines) == len(conversation.EXCHANGES) + len(conversation.REFUSALS) + 10
    until(lambda: not processes_with(f"GAME_OF_THIS_TEST={folder}", "environ"), "the end of all browsers")


@needs_browser
def test_no_command_contains_the_token(folder: Path) -> None:
    """Every user of a machine can read all commands."""
    pytest.importorskip("websockets")
    token = "the-token-of-this-test"
    with conversation.Game(page_command(folder, "index.html"), token) as game:
        assert game.receive()["hello"]["token"] == token
        assert processes_with(token, "environ")
        assert not processes_with(token, "cmdline")


def test_without_tltlc_the_game_says_why_it_ends(folder: Path) -> None:
    result = subprocess.run(
        [NODE, "counter.js"], cwd=folder, capture_output=True, text=True, env={}, timeout=HANG_S, check=False
    )
    assert result.returncode == 1
    assert result.stderr == "tltlc must start this game: the variable TLTL_PORT is not set\n"


def test_a_game_that_listens_plays_one_tltlc_after_the_other(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    variables = {**os.environ, "TLTL_TOKEN": "open sesame"}
    words = [NODE, "counter.js", "--listen", str(port)]
    with subprocess.Popen(words, cwd=folder, env=variables) as process:
        game = WireGame("counter", folder, connect=f"127.0.0.1:{port}", start_s=HANG_S, step_s=HANG_S)
        monkeypatch.setenv("TLTL_TOKEN", "guessed")
        with pytest.raises(WireError, match="the token is wrong"):
            until(lambda: opened(game), "the game to listen")
        monkeypatch.setenv("TLTL_TOKEN", "open sesame")
        for _ in range(2):
            env = until(lambda: opened(game), "the game to listen again")
            assert env is not None
            env.reset(seed=3)
            assert env.step(2)[2]
            env.close()
        process.terminate()


def opened(game: WireGame) -> WireEnv | None:
    """Return the game, or None if nobody listens at its port yet."""
    try:
        return WireEnv(game)
    except WireError as error:
        if "refused" in str(error):
            return None
        raise


NOT_FINITE = """
import { play, state } from "./tltl_client.js";
const hello = { signals: { x: {} }, actions: { type: "discrete", n: 2 } };
await play({ hello, reset: () => state({ signals: { x: 1 } }), step: () => state({ signals: { x: 0 / 0 } }) });
"""


def test_a_number_that_is_not_finite_is_an_error_in_the_game(folder: Path) -> None:
    (folder / "broken.js").write_text(NOT_FINITE, encoding="utf-8")
    env = WireEnv(wire_game(folder, NODE, "broken.js"))
    env.reset()
    with pytest.raises(WireError) as caught:
        env.step(1)
    assert "x is NaN, and numbers must be finite" in (caught.value.diagnostics[0].help or "")


@needs_browser
def test_an_error_in_a_page_is_shown(folder: Path) -> None:
    pytest.importorskip("websockets")
    (folder / "counter.js").write_text(NOT_FINITE, encoding="utf-8")
    env = WireEnv(wire_game(folder, NODE, "tltl_client.js", "index.html", BROWSER))
    env.reset()
    with pytest.raises(WireError) as caught:
        env.step(1)
    assert "x is NaN, and numbers must be finite" in (caught.value.diagnostics[0].help or "")


@needs_browser
def test_a_script_that_a_page_cannot_read_is_the_first_line_of_the_error(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("websockets")
    game = (folder / "counter.js").read_text(encoding="utf-8")
    (folder / "counter.js").write_text(f"// The game.\nfunction (\n{game}", encoding="utf-8")
    monkeypatch.setattr("tltl_runtime.wire.start_watch.GRACE_S", 0.0)
    with pytest.raises(WireError, match="did not say hello within 5 s after an error in a script") as caught:
        WireEnv(wire_game(folder, NODE, "tltl_client.js", "index.html", BROWSER))
    help_ = caught.value.diagnostics[0].help or ""
    assert help_.startswith("the game's standard error ends:\nUncaught SyntaxError: ")
    assert "\n   At: counter.js:2\n" in help_


@needs_browser
def test_all_lines_of_a_message_on_the_console_are_shown(folder: Path) -> None:
    pytest.importorskip("websockets")
    game = (folder / "counter.js").read_text(encoding="utf-8")
    messages = """console.error("first\\n\\"second\\", source: third\\nfourth");\nconsole.log("fifth");\n"""
    (folder / "counter.js").write_text(messages + game, encoding="utf-8")
    with conversation.Game(page_command(folder, "index.html")) as playing:
        playing.receive()
        until(lambda: "fifth" in playing.stderr(), "the message on the console")
        assert playing.stderr() == 'first\n"second", source: third\nfourth\nfifth'


@needs_browser
def test_the_profile_of_a_game_that_was_killed_is_removed_by_the_next_one(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("websockets")
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    # Only the shell needs no profile.
    browser = folder / "chromium"
    browser.write_text(f'#!/bin/sh\nexec {BROWSER} "$@"\n', encoding="utf-8")
    browser.chmod(0o755)
    words = [*page_command(folder, "index.html")[:-1], str(browser)]
    with conversation.Game(words) as killed:
        killed.receive()
        killed.process.kill()
        killed.process.wait(HANG_S)
    until(lambda: not processes_with(f"TMPDIR={temporary}", "environ"), "the end of the browser")
    (left,) = temporary.glob("tltl-page-*")
    with conversation.Game(words) as game:
        game.receive()
        (profile,) = temporary.glob("tltl-page-*")
        assert profile != left and profile.stat().st_mode & 0o777 == 0o700
        game.send({"close": {}})
        assert game.status() == 0
    assert not [*temporary.glob("tltl-page-*")]


RECORD = """
import { Recorder } from "./tltl_client.js";
const recorder = new Recorder("traces", ["near(a, b)", "seen"], { clockHz: 60 });
for (const last of [true, false]) {
  console.log(recorder.begin());
  for (let step = 0; step < 4; step++) {
    recorder.sample({ "near(a, b)": step / 3, seen: last && step === 3, unused: 1 });
  }
}
recorder.end();
"""


def test_a_recorded_trace_is_judged(folder: Path) -> None:
    result = node(folder, RECORD)
    assert result.stdout.split() == ["traces/trace-0001.csv", "traces/trace-0002.csv"], result.stderr
    assert (folder / "traces" / "trace-0002.csv").read_text(encoding="utf-8").splitlines()[:3] == [
        'time,"near(a, b)",seen',
        "0,0,false",
        "0.016666666666666666,0.3333333333333333,false",
    ]
    spec = folder / "see.tltl"
    spec.write_text(
        "clock 60 Hz\nsignal near(a, b): number in [0, 1]\nsignal seen: bool\nspec see = F seen\n", encoding="utf-8"
    )
    words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(folder / "traces")]
    judged = subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False)
    assert "1 of 2 accepted" in judged.stdout, judged.stderr


def test_a_recorder_overwrites_no_trace(folder: Path) -> None:
    traces = folder / "traces"
    traces.mkdir()
    (traces / "trace-0001.csv").write_text("kept", encoding="utf-8")
    script = 'import { Recorder } from "./tltl_client.js"; new Recorder("traces", ["x"]).sample({ x: 1e-7 });'
    assert node(folder, script).returncode == 0
    assert (traces / "trace-0001.csv").read_text(encoding="utf-8") == "kept"
    assert (traces / "trace-0002.csv").read_text(encoding="utf-8") == "x\n1e-7\n"


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("0 / 0", "the signal x is NaN, and numbers must be finite"),
        ("-1 / 0", "the signal x is -Infinity, and numbers must be finite"),
        ("undefined", "the signal x has no value: undefined"),
        ("'1'", "the signal x has no value: 1"),
    ],
)
def test_a_recorder_refuses_what_is_no_finite_number(folder: Path, value: str, message: str) -> None:
    script = f"""
import {{ Recorder }} from "./tltl_client.js";
const recorder = new Recorder("traces", ["x"]);
recorder.begin();
try {{ recorder.sample({{ x: {value} }}); }} catch (error) {{ console.log(error.message); }}
try {{ recorder.sample({{ x: 1 }}, 1n); }} catch (error) {{ console.log(error.message); }}
"""
    assert node(folder, script).stdout.splitlines() == [message, "Do not know how to serialize a BigInt"]
    assert not (folder / "traces").exists()


TAPE = """
const recorder = new Recorder("traces", ["near(a, b)", "size", "seen"], { clockHz: 60, game: "walk" });
const sizes = [5e-324, -0, 1e-300, 1e22, -123456.789, 0.1];
recorder.begin("crypt", "v1", 7);
try { recorder.sample({ "near(a, b)": 0 / 0, size: 2, seen: false }, 0); } catch {}
for (let step = 1; step <= 130; step++) {
  const signals = { "near(a, b)": step / 3, size: sizes[step % 6], seen: step === 130 };
  if (step === 3) signals["near(a, b)"] = true;
  if (step > 128) signals.seen = step - 129;
  recorder.sample(signals, step % 2 ? [step % 3, 1] : Uint8Array.of(step % 3, 1));
}
"""


def test_a_recorder_writes_the_tape_of_a_play(folder: Path, tmp_path: Path) -> None:
    script = (
        'import { Recorder } from "./tltl_client.js";'
        + TAPE
        + """
recorder.begin();
const signals = { "near(a, b)": 1, size: 2, seen: false };
recorder.sample(signals);
try { recorder.sample(signals, 1); } catch (error) { console.log(error.message); }
try { recorder.sample(signals, [0 / 0]); } catch (error) { console.log(error.message); }
recorder.begin("crypt", null, 7);
recorder.sample(signals, 1);
recorder.end();
"""
    )
    (folder / "traces").mkdir()
    (folder / "traces" / "trace-0001.tape.jsonl").write_text("kept", encoding="utf-8")
    assert node(folder, script).stdout.splitlines() == [
        "give the action of each sample of an episode, or of none",
        "the action is NaN, and numbers must be finite",
    ]
    tape = recorded_tapes.check_tape(folder / "traces" / "trace-0002.tape.jsonl", tmp_path)
    assert tape.header.versions["node"].startswith("v")
    assert (folder / "traces" / "trace-0001.tape.jsonl").read_text(encoding="utf-8") == "kept"
    assert not (folder / "traces" / "trace-0003.tape.jsonl").exists()
    recorded_tapes.check_tape_without_a_variant(folder / "traces" / "trace-0004.tape.jsonl")


@needs_browser
def test_a_page_has_no_text_of_a_trace_without_a_sample(folder: Path) -> None:
    page = 'import { Recorder } from "./tltl_client.js";' + TAPE
    page += "recorder.end();const next = recorder.begin(); recorder.download();"
    page += "console.error(JSON.stringify([next, recorder.begin(), recorder.end(), recorder.tape()]));"
    assert logged_by_page(folder, page) == ["trace-0002.csv", "trace-0002.csv", "", ""]


@needs_browser
def test_a_page_has_the_text_of_the_tape(folder: Path, tmp_path: Path) -> None:
    page = 'import { Recorder } from "./tltl_client.js";' + TAPE
    page += "console.error(JSON.stringify([recorder.end(), recorder.tape()]));"
    trace, tape = logged_by_page(folder, page)
    (tmp_path / "trace-0001.csv").write_text(trace, encoding="utf-8")
    (tmp_path / "trace-0001.tape.jsonl").write_text(tape, encoding="utf-8")
    recorded_tapes.check_tape(tmp_path / "trace-0001.tape.jsonl", tmp_path)


def logged_by_page(folder: Path, script: str) -> Any:
    """Return what a script in a page writes to the console, as JSON."""
    (folder / "index.html").write_text(f"<script type=module>{script}</script>", encoding="utf-8")
    words = [*page_command(folder, "index.html")]
    variables = {**os.environ, "TLTL_PORT": "1"}
    with subprocess.Popen(words, stderr=subprocess.PIPE, text=True, env=variables) as process:
        assert process.stderr is not None
        line = process.stderr.readline()
        process.terminate()
    return json.loads(line)
