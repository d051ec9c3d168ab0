"""Measure how fast the Godot game of the examples is over the wire, and in a bare lockstep loop.

The *bare* loop is written by hand: ``handwritten/gdscript3/bare_keep.gd`` plays the same ticks of the
same level, its monitor included, and sends its states with the engine's own JSON; the other side sends
the same actions, and reads the lines with Python's ``json``. There is no client, and nothing is checked.
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING, Any, Final

from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.measure import median, quartiles
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

if TYPE_CHECKING:
    from tltl_runtime.wire.env import WireEnv

SECTION = "godot"
STEPS_PER_S: Final = 10_000
RATIO: Final = 0.8
STEPS: Final = 5_000
ROUNDS: Final = 9
_KEY: Final = "courtyard"
_ENGINE: Final = "godot3-server"
_WORDS: Final = ("--fixed-fps", "10", "--disable-render-loop")
_PROJECT: Final = ROOT / "examples" / "godot_game" / "project"
_BARE: Final = ROOT / "benchmarks" / "handwritten" / "gdscript3" / "bare_keep.gd"
_BARE_SCENE: Final = """\
[gd_scene load_steps=2 format=2]

[ext_resource path="res://bare_keep.gd" type="Script" id=1]

[node name="Bare" type="Spatial"]
script = ExtResource( 1 )
"""

Actions = Sequence[Sequence[int]]


def measure(store: Store, _: float, say: Callable[[str], None]) -> None:
    """Measure both loops in turns, unless the store has a record."""
    if shutil.which(_ENGINE) is None:
        say(f"{SECTION} left out: {_ENGINE} is not installed")
        return
    measure_missing(store, SECTION, [_KEY], lambda _: compare(), say, field="ratio")


def compare() -> Record:
    """Return the steps a second over the wire and in the bare loop, and their ratio in each round."""
    from tltl_runtime.wire.env import WireEnv
    from tltl_runtime.wire.wire_game import WireGame

    actions = _actions(Random(1))
    game = WireGame(_KEY, _PROJECT, process=(_ENGINE, "--path", ".", *_WORDS))
    env = WireEnv(game, scene=_KEY)
    rates: list[tuple[float, float]] = []
    try:
        with _bare_loop() as bare:
            for round_ in range(ROUNDS + 1):
                pair = _rate(lambda: _play(env, actions)), _rate(lambda: _play_bare(bare, actions))
                if round_:
                    rates.append(pair)
    finally:
        env.close()
    return {
        "wire_steps_per_s": round(median([wire for wire, _ in rates])),
        "bare_steps_per_s": round(median([bare for _, bare in rates])),
        "ratio": quartiles([wire / bare for wire, bare in rates]),
        "source": source_digest("runtime/tltl_runtime/wire"),
    }


def _actions(random: Random) -> Actions:
    """Return actions that are held for some steps, as a player holds a key."""
    actions: list[list[int]] = []
    while len(actions) < STEPS:
        actions += [[random.randrange(3), random.randrange(3)]] * random.randrange(1, 12)
    return actions[:STEPS]


def _play(env: WireEnv, actions: Actions) -> None:
    env.reset(seed=1)
    for action in actions:
        _, _, ended, _, _ = env.step(action)
        if ended:
            env.reset(seed=1)


def _play_bare(connection: socket.socket, actions: Actions) -> None:
    _ask(connection, {"reset": {"seed": 1}})
    for action in actions:
        if _ask(connection, {"step": {"action": action}})["state"]["ended"]:
            _ask(connection, {"reset": {"seed": 1}})


def _ask(connection: socket.socket, message: object) -> Any:
    connection.sendall(json.dumps(message).encode() + b"\n")
    data = connection.recv(1 << 16)
    while not data.endswith(b"\n"):
        data += connection.recv(1 << 16)
    return json.loads(data)


@contextmanager
def _bare_loop() -> Iterator[socket.socket]:
    """Start the bare game; yield the connection to it."""
    with tempfile.TemporaryDirectory() as folder, socket.create_server(("127.0.0.1", 0)) as server:
        project = Path(folder, "project")
        shutil.copytree(_PROJECT, project)
        shutil.copy(_BARE, project)
        (project / "bare.tscn").write_text(_BARE_SCENE, encoding="utf-8")
        words = [_ENGINE, "--path", str(project), *_WORDS, "bare.tscn"]
        environment = {**os.environ, "TLTL_PORT": str(server.getsockname()[1])}
        process = subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL)
        try:
            server.settimeout(60.0)
            connection, _ = server.accept()
            with connection:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                yield connection
        finally:
            process.terminate()
            process.wait()


def _rate(play: Callable[[], None]) -> float:
    """Return steps per second of wall time."""
    start = time.perf_counter()
    play()
    return STEPS / (time.perf_counter() - start)


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, if there is a measurement."""
    record = records.get(_KEY, {})
    if "ratio" in record:
        speed = record["wire_steps_per_s"]
        goal = f"a Godot 3 game over the wire, one process, full signals, at {STEPS_PER_S:,} steps a second"
        yield goal, f"{speed:,}", met_or_missed(speed >= STEPS_PER_S)
        goal = f"a Godot 3 game over the wire at least {RATIO:g} times as fast as a bare lockstep loop"
        yield goal, f"{record['ratio'][1]:.2f}", met_or_missed(record["ratio"][1] >= RATIO)


def section(records: Mapping[str, Record]) -> str:
    """Return the section on the Godot game; empty without measurements."""
    record = records.get(_KEY, {})
    if "ratio" not in record:
        return ""
    row = (f"{record['wire_steps_per_s']:,}", f"{record['bare_steps_per_s']:,}", spread(record["ratio"], 2))
    return f"""
## A game in Godot 3 over the wire

Steps per second of wall time of the scene `{_KEY}` of `examples/godot_game`, with all its signals, a monitor inside,
an observation of 20 numbers and six positions, in {ROUNDS} rounds of {STEPS:,} random actions, in turns. *Wire*: an
environment `WireEnv`, and the client in the game. *Bare*: a lockstep loop by hand, which plays the same ticks and sends
its states with the engine's JSON, whose numbers have six decimals; the other side reads them with Python's `json`, and
checks nothing.

{table(("wire", "bare", "wire / bare"), [row])}
"""


if __name__ == "__main__":
    print(json.dumps(compare(), indent=1))
