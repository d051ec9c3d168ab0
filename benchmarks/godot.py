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
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from benchmarks.markdown import met_or_missed, spread, table
from benchmarks.measure import median, quartiles
from benchmarks.store import ROOT, Record, Store, measure_missing, source_digest

if TYPE_CHECKING:
    from tltl_runtime.wire.env import WireEnv

SECTION = "godot"
STEPS_PER_S: Final = 10_000
RATIO: Final = 0.8
PYTHON_US: Final = 60
STEPS: Final = 2_000
ROUNDS: Final = 9
_TIMEOUT_S: Final = 60.0
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

SIDES: Final = ("wire", "client", "bare")

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
    rounds: list[dict[str, Times]] = []
    with _bare_project() as project, _lockstep(project, "bare.tscn") as bare, _lockstep(_PROJECT) as client:
        _received(client)  # its hello
        env = WireEnv(game, scene=_KEY)
        try:
            for round_ in range(ROUNDS + 1):
                times = {
                    "wire": _times(lambda: _play(env, actions)),
                    "client": _times(lambda: _play_bare(client, actions)),
                    "bare": _times(lambda: _play_bare(bare, actions)),
                }
                if round_:
                    rounds.append(times)
        finally:
            env.close()
    return {
        "rounds": ROUNDS,
        "steps_per_s": {side: round(median([times[side].steps_per_s for times in rounds])) for side in SIDES},
        "cpu_us": {side: median([times[side].cpu_us for times in rounds]) for side in SIDES},
        "python_us": {side: median([times[side].python_us for times in rounds]) for side in SIDES},
        "ratio": quartiles([times["wire"].steps_per_s / times["bare"].steps_per_s for times in rounds]),
        "client_ratio": quartiles([times["client"].steps_per_s / times["bare"].steps_per_s for times in rounds]),
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
    _ask(connection, {"reset": {"scene": _KEY, "variant": "v0", "seed": 1}})
    for action in actions:
        if _ask(connection, {"step": {"action": action}})["state"]["ended"]:
            _ask(connection, {"reset": {"scene": _KEY, "variant": "v0", "seed": 1}})


def _ask(connection: socket.socket, message: object) -> Any:
    connection.sendall(json.dumps(message).encode() + b"\n")
    return _received(connection)


def _received(connection: socket.socket) -> Any:
    data = connection.recv(1 << 16)
    while not data.endswith(b"\n"):
        data += connection.recv(1 << 16)
    return json.loads(data)


@contextmanager
def _bare_project() -> Iterator[Path]:
    """Yield a copy of the game's project that also has the bare loop."""
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder, "project")
        shutil.copytree(_PROJECT, project)
        shutil.copy(_BARE, project)
        (project / "bare.tscn").write_text(_BARE_SCENE, encoding="utf-8")
        yield project


@contextmanager
def _lockstep(project: Path, *words: str) -> Iterator[socket.socket]:
    """Start a game; yield the connection to it.

    It runs in a session of its own, as tltlc starts games: Linux shares its cores among sessions.
    """
    with socket.create_server(("127.0.0.1", 0)) as server:
        command = [_ENGINE, "--path", str(project), *_WORDS, *words]
        environment = {**os.environ, "TLTL_PORT": str(server.getsockname()[1]), "TLTL_TOKEN": ""}
        process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, start_new_session=True)
        try:
            server.settimeout(_TIMEOUT_S)
            connection, _ = server.accept()
            with connection:
                connection.settimeout(_TIMEOUT_S)
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                yield connection
        finally:
            process.terminate()
            process.wait()


class Times(NamedTuple):
    """The steps of one round: how many in a second of wall time, and the CPU time of one, in µs.

    ``cpu_us`` is that of both processes, ``python_us`` that of Python's alone.
    """

    steps_per_s: float
    cpu_us: float
    python_us: float


def _times(play: Callable[[], None]) -> Times:
    start, before, own = time.perf_counter(), _cpu_s(os.getpid()), time.process_time()
    play()
    own, cpu = time.process_time() - own, _cpu_s(os.getpid()) - before
    return Times(STEPS / (time.perf_counter() - start), cpu / STEPS * 1e6, own / STEPS * 1e6)


def _cpu_s(pid: int) -> float:
    """Return the CPU time of a process and of its descendants that are alive, in seconds, from Linux's /proc."""
    folder = Path("/proc", str(pid))
    user, system = folder.joinpath("stat").read_text(encoding="utf-8").rpartition(")")[2].split()[11:13]
    children = folder.joinpath("task", str(pid), "children").read_text(encoding="utf-8").split()
    own = (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")
    return own + sum(_cpu_s(int(child)) for child in children)


def goals(records: Mapping[str, Record]) -> Iterable[Sequence[str]]:
    """Yield the rows of the table of goals, if there is a measurement."""
    record = records.get(_KEY, {})
    if "ratio" in record:
        speed = record["steps_per_s"]["wire"]
        goal = f"a Godot 3 game over the wire, one process, full signals, at {STEPS_PER_S:,} steps a second"
        yield goal, f"{speed:,}", met_or_missed(speed >= STEPS_PER_S)
        goal = f"a Godot 3 game over the wire at least {RATIO:g} times as fast as a bare lockstep loop"
        alone = f"the client in the game alone {record['client_ratio'][1]:.2f}"
        yield goal, f"{record['ratio'][1]:.2f}; {alone}", met_or_missed(record["ratio"][1] >= RATIO)
        python = record["python_us"]["wire"]
        goal = f"the protocol takes at most {PYTHON_US} µs of a step in Python"
        yield goal, f"{python:.0f} µs, the system's part included", met_or_missed(python <= PYTHON_US)


def section(records: Mapping[str, Record]) -> str:
    """Return the section on the Godot game; empty without measurements."""
    record = records.get(_KEY, {})
    if "ratio" not in record:
        return ""
    ratios = {"wire": spread(record["ratio"], 2), "client": spread(record["client_ratio"], 2), "bare": "1"}
    speeds, cpu, python = record["steps_per_s"], record["cpu_us"], record["python_us"]
    rows = [(side, f"{speeds[side]:,}", f"{cpu[side]:.0f}", f"{python[side]:.0f}", ratios[side]) for side in SIDES]
    return f"""
## A game in Godot 3 over the wire

The scene `{_KEY}` of `examples/godot_game`, with all its signals, a monitor inside, an observation of 20 numbers and
six positions, in {record["rounds"]} rounds of {STEPS:,} random actions, in turns; *speed* is steps per second of wall
time. *Wire*: an environment `WireEnv`, and the client in the game. *Client*: the client in the game, and a loop in
Python by hand on the other side, which reads lines with Python's `json` and checks nothing. *Bare*: also a loop by hand
in the game, which plays the same ticks, and sends its states with the engine's JSON, whose numbers have six decimals.
CPU times are those of both processes, and of Python's alone; they include the system's part. A step of the bare loop
contains the game itself: physics, its monitor, its signals.

{table(("", "speed", "CPU time of a step, µs", "in Python, µs", "speed / bare"), rows)}
"""


if __name__ == "__main__":
    print(json.dumps(compare(), indent=1))
