"""The web game: Node and the page play alike, its monitor agrees with tltlc's, and its trained agent delivers."""

from __future__ import annotations

import json
import os
import shutil
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tltlc as compiler
from tests.interfaces.cli.conftest import ROOT, Outcome, tltlc  # noqa: F401
from tests.runtime.regression.page import chromium
from tests.runtime.wire.test_javascript_client import BROWSER, CLIENT, NODE, needs_browser
from tests.waiting import HANG_S
from tltl_runtime import TltlEnv, read_tape
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.wire_game import WireGame
from tltlc.backends import emit

Run = Callable[..., Outcome]
FOLDER = ROOT / "examples" / "web_game"
SPEC = FOLDER / "web_game.tltl"
RUNTIME = os.environ.get("ONNXRUNTIME_WEB", "")

pytestmark = pytest.mark.skipif(not NODE, reason="needs Node: apt-get install nodejs")

JUDGED = """
import { writeFileSync } from "node:fs";
import { Courier } from "./courier.js";
import { Monitor } from "./deliver_monitor.mjs";
import { play } from "./tltl_client.js";

const rows = [];
const monitor = new Monitor();

class JudgedCourier extends Courier {
  reset(...where) {
    monitor.reset();
    return super.reset(...where);
  }
  step(action) {
    const state = super.step(action);
    rows.push(monitor.step(state.signals));
    return state;
  }
  close() {
    writeFileSync("rows.json", JSON.stringify(rows));
  }
}
await play(new JudgedCourier());
"""


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """Serve a folder; give the address."""
    handler = partial(QuietHandler, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_address[1]}"
        finally:
            server.shutdown()
            thread.join()


class QuietHandler(SimpleHTTPRequestHandler):
    """Serves files, and logs nothing."""

    def log_message(self, *_: object) -> None:
        """Log nothing."""


@contextmanager
def played(folder: Path, *words: str, render: bool = False) -> Iterator[WireEnv]:
    game = WireGame("courier", folder, words, start_s=HANG_S, step_s=HANG_S)
    env = WireEnv(game, render_mode="rgb_array" if render else None)
    try:
        yield env
    finally:
        env.close()


def test_the_copied_and_the_generated_file_are_up_to_date() -> None:
    assert (FOLDER / "tltl_client.js").read_bytes() == CLIENT.read_bytes(), f"copy {CLIENT} to {FOLDER}"
    deliver, _ = compiler.compile_file(SPEC)
    for name, text in emit("javascript", deliver).items():
        assert (FOLDER / name).read_text(encoding="utf-8") == text, (
            "`tltlc compile web_game.tltl:deliver -t javascript`"
        )


@pytest.mark.parametrize("scene", ["yard", "alley"])
@pytest.mark.parametrize("variant", ["v0", "fast_dog", "dog_in_gap"])
def test_a_scene_can_be_played(scene: str, variant: str) -> None:
    with played(FOLDER, NODE, "node_game.js") as env:
        for seed in (0, 3, 2**31, 2**53 - 1):
            options = {"scene": scene, "variant": variant}
            observation, _ = env.reset(seed=seed, options=options)
            assert env.observation_space.contains(observation)
            start = env.tltl_signals()
            assert env.tltl_positions().keys() == {"player", "parcel", "door", "dog"}
            assert 0 < start["parcel_distance"] < 30 and 0 < start["door_distance"] < 30
            again, _ = env.reset(seed=seed, options=options)
            assert np.array_equal(observation, again)


def test_node_and_the_page_declare_the_same_scenes() -> None:
    node, page = (read_game_file(FOLDER / f"{name}.game.toml").scenes for name in ("web_game", "page"))
    assert [(scene.name, list(scene.variants)) for scene in node] == [
        (scene.name, list(scene.variants)) for scene in page
    ]


@needs_browser
def test_node_and_the_page_play_alike() -> None:
    pytest.importorskip("websockets")
    random = np.random.default_rng(5)
    in_page = played(FOLDER, NODE, "tltl_client.js", "index.html", BROWSER, render=True)
    with played(FOLDER, NODE, "node_game.js") as node, in_page as page:
        for scene in ("yard", "alley"):
            first, *_ = (env.reset(seed=11, options={"scene": scene})[0].tolist() for env in (node, page))
            assert first == page.reset(seed=11, options={"scene": scene})[0].tolist()
            ended = False
            for _ in range(40):
                action = int(random.integers(5))
                steps = [env.step(action) for env in (node, page)]
                assert steps[0][0].tolist() == steps[1][0].tolist()
                assert node.tltl_signals() == page.tltl_signals()
                assert node.tltl_positions() == page.tltl_positions()
                ended = steps[0][2]
                assert ended == steps[1][2]
                if ended:
                    break
            picture = page.render()
            assert picture is not None and picture.shape == (400, 640, 3)
            assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 4


def test_the_monitor_inside_agrees_with_the_one_outside(tmp_path: Path) -> None:
    folder = tmp_path / "game"
    shutil.copytree(FOLDER, folder)
    (folder / "judged.js").write_text(JUDGED, encoding="utf-8")
    wanted: list[Any] = []
    verdicts = set()
    with played(folder, NODE, "judged.js") as game, played(folder, NODE, "node_game.js") as scout:
        env = TltlEnv(game, str(SPEC) + ":deliver")
        for seed in range(24):
            env.reset(seed=seed)
            scout.reset(seed=seed)
            over = False
            while not over:
                action = (int(env.np_random.integers(5)), _careful_action(scout), _chasing_action(scout))[seed % 3]
                scout.step(action)
                _, _, terminated, truncated, _ = env.step(action)
                over = terminated or truncated
                assert env.taken is not None
                wanted.append(env.taken)
            verdicts.add(wanted[-1].verdict)
        env.close()
    rows = json.loads((folder / "rows.json").read_text(encoding="utf-8"))
    assert len(rows) == len(wanted)
    for row, step in zip(rows, wanted, strict=True):
        assert (row["state"], row["verdict"], row["done"]) == (step.state, step.verdict, step.done)
        for name in ("progress", "reward", "robustness"):
            assert row[name] == pytest.approx(getattr(step, name), abs=1e-12)
    assert {"holding", "violated"} <= verdicts


@pytest.mark.slow
@pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")
def test_a_person_plays_the_page_and_saves_the_ride(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    with served(FOLDER) as address, chromium.browser() as browser:
        page = browser.new_page()
        page.set_default_timeout(chromium.HANG_MS)
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(f"{address}/index.html")
        page.keyboard.down("ArrowRight")
        page.wait_for_function("document.getElementById('progress').value > 0")
        page.wait_for_function("!document.getElementById('save').disabled")
        page.keyboard.up("ArrowRight")
        downloads: list[Any] = []
        page.on("download", lambda download: downloads.append(download))
        with page.expect_download(lambda download: download.suggested_filename.endswith(".tape.jsonl")):
            page.click("#save")
        for download in downloads:
            download.save_as(tmp_path / download.suggested_filename)
        # In the next ride, nothing can be saved that would divide its trace in two.
        page.keyboard.press("ArrowRight")
        assert page.is_disabled("#save")
        assert errors == []
    names = [download.suggested_filename for download in downloads]
    assert names == ["courier-trace-0001.csv", "courier-trace-0001.tape.jsonl"]
    trace, tape = (tltlc("monitor", f"{SPEC}:deliver", tmp_path / name) for name in names)
    assert trace.err.splitlines()[-1].startswith("not accepted"), trace.err
    assert trace.out == tape.out
    ride = read_tape(tmp_path / names[1])
    env = WireEnv(WireGame("courier", FOLDER, (NODE, "node_game.js")), scene=ride.header.scene)
    env.reset(seed=ride.header.seed)
    for step in ride.steps:
        env.step(step.action)
        assert env.tltl_signals() == step.signals
    env.close()


@pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")
@pytest.mark.skipif(not RUNTIME, reason="needs ONNXRUNTIME_WEB, the folder of npm's onnxruntime-web")
def test_the_trained_agent_rides_in_the_page(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    pytest.importorskip("onnx")
    folder = tmp_path / "game"
    shutil.copytree(FOLDER, folder)
    (folder / "node_modules").mkdir()
    (folder / "node_modules" / "onnxruntime-web").symlink_to(RUNTIME, target_is_directory=True)
    exported = tltlc("inspect", folder / "courier.safetensors", "-o", folder / "courier.onnx")
    assert exported.status == 0, exported.err
    with served(folder) as address, chromium.browser() as browser:
        page = browser.new_page()
        page.set_default_timeout(chromium.HANG_MS)
        page.goto(f"{address}/index.html")
        for _ in range(5):
            page.click("#agent")
            page.wait_for_function("document.getElementById('text').textContent.startsWith('Still')")
            page.wait_for_function("/^(Delivered|That|There)/.test(document.getElementById('text').textContent)")
            text = page.inner_text("#text")
            if text == "Delivered!":
                return
    raise AssertionError(f"the agent delivered in none of five rides: {text}")


def _careful_action(game: WireEnv) -> int:
    """Return the action that leads nearer to what comes next, and not near the dog."""
    target = "door_distance" if game.tltl_signals()["carrying"] else "parcel_distance"
    return _nearer(game, target, keep_off=2)


def _chasing_action(game: WireEnv) -> int:
    """Return the action that leads to the door, and beyond the gap in the wall to the dog."""
    is_beyond = game.tltl_positions()["player"][0] > 8
    return _nearer(game, "dog_distance" if is_beyond else "door_distance", keep_off=0)


def _nearer(game: WireEnv, target: str, keep_off: float) -> int:
    """Return the action after which a distance is least, farther than ``keep_off`` from the dog; 0 if none lessens it.

    The game plays each action, and returns to where it was.
    """
    kept = game.tltl_snapshot()
    best, chosen = game.tltl_signals()[target], 0
    for action in range(1, 5):
        game.step(action)
        signals = game.tltl_signals()
        if signals["dog_distance"] >= keep_off and signals[target] < best:
            best, chosen = signals[target], action
        game.tltl_restore(kept)
    return chosen


@pytest.mark.slow
def test_the_trained_agent_delivers(tltlc: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:  # noqa: F811
    monkeypatch.chdir(FOLDER)
    result = tltlc("regress", "suite.toml", "--out", tmp_path, "--workers", "1")
    assert result.status in (0, 1), result.err
    lines = [line.split() for line in result.out.splitlines() if line.startswith("yard")]
    verdicts = {words[0]: words[1] for words in lines}
    assert verdicts["yard:v0"] == "pass"
    assert verdicts["yard:dog_in_gap"] == "fail"
