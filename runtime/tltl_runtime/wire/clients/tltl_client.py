"""Connect a game in Python to tltlc, and record the play of a person: copy this file into your game.

It needs Python 3.8 or newer and nothing else. A game is an object with the attribute ``hello`` and
some methods::

    import tltl_client

    class Game:
        hello = {
            "name": "counter",
            "clock_hz": 10,
            "signals": {"position": {"range": [0, 10]}, "at_goal": {"type": "bool"}},
            "actions": {"type": "discrete", "n": 3},
            "observation": {"type": "box", "low": 0, "high": 10, "shape": [1]},
            "scenes": ["short", "long"],
            "capabilities": ["seed", "positions"],
        }

        def reset(self, scene, variant, seed): ...     # begin an episode, return its first state
        def step(self, action): ...                    # play one tick, return the state

        def snapshot(self): ...                        # optional: keep the state of the game, return an id
        def restore(self, id): ...                     # optional: return to it, return the state
        def release_snapshot(self, id): ...            # optional: forget it: there will be no return to it
        def screenshot(self): ...                      # optional: return a picture, see `array`
        def outline(self): ...                         # optional: return what maps of the scene show, see below
        def close(self): ...                           # optional: called at the end

    if __name__ == "__main__":
        tltl_client.play(Game())

A state is a dict with ``signals``, ``observation``, ``ended``, ``cause`` and ``positions``; ``state``
makes one. Raise ``Refusal("there is no scene `crypt`")`` where a request cannot be met. An outline is
that of the current scene and variant, in metres, for example::

    {"boxes": {"wall": [[[0, 0], [8, 1]], [[8, 0], [9, 6]]]}, "regions": {"hall": [[0, 1], [8, 6]]}}

``play`` waits for requests. A game with a main loop of its own uses ``Client`` directly::

    client = tltl_client.Client(hello)
    while True:
        kind, body = client.request()
        ...
        client.answer_state(state)

``docs/wire.md`` of tltlc describes the protocol.
"""

from __future__ import annotations

import base64
import json
import os
import socket
import sys
from contextlib import suppress
from itertools import count
from math import isfinite
from pathlib import Path
from struct import pack
from typing import Any, Iterable, Iterator, Mapping, TextIO  # noqa: UP035 - Python 3.8 has no better place for them.
from zlib import adler32

PROTOCOL = 1
LONGEST_LINE = 1 << 25
KINDS = ("reset", "step", "snapshot", "restore", "release", "screenshot", "outline", "close")


class Refusal(Exception):
    """Raise this in a method of the game if a request cannot be met. tltlc shows the text, which says why."""


class Disconnected(Exception):
    """Raised if tltlc has closed the connection, or refuses this game. The text says why, if that is known."""


def state(
    signals: Mapping[str, float],
    observation: Any = None,
    ended: bool = False,
    cause: str | None = None,
    positions: Mapping[str, Iterable[float]] | None = None,
) -> dict[str, Any]:
    """Return the state of the game as a dict for a message.

    ``signals`` are numbers in SI units and bools, by name. ``ended`` says whether the episode has ended,
    and ``cause`` who or what ended it. ``positions`` are lists of two or three coordinates in metres, by
    the name of the entity; the player's name is ``player``.
    """
    message: dict[str, Any] = {"signals": signals, "ended": bool(ended), "cause": cause}
    if observation is not None:
        message["observation"] = observation
    if positions is not None:
        message["positions"] = positions
    return message


def array(data: bytes, dtype: str, shape: Iterable[int]) -> dict[str, Any]:
    """Return a large array, such as a picture, as a dict for a message.

    ``data`` are the bytes of the array, little-endian; the last index changes fastest. ``dtype`` is a
    word such as ``uint8``, and ``shape`` a list such as ``[84, 84, 3]``.
    """
    return {"base64": base64.b64encode(data).decode(), "dtype": dtype, "shape": list(shape)}


def play(game: Any, client: Client | None = None) -> None:
    """Connect to tltlc and answer its requests, until it closes the connection.

    If tltlc refuses the game, or has not started it, the process ends with a message. If the game is
    started first and tltlc connects to it, pass a ``client``, and play again after each connection. The
    method ``close`` of the game is called at the end of each::

        while True:
            play(game, listen(game_hello(game), 5000))
    """
    try:
        client = client or Client(game_hello(game))
        while True:
            kind, body = client.request()
            if kind == "close":
                break
            try:
                _answer(game, client, kind, body)
            except Refusal as refusal:
                client.refuse(str(refusal))
    except Disconnected as error:
        if str(error):
            sys.exit(str(error))
    finally:
        if client is not None:
            client.close()
        if hasattr(game, "close"):
            game.close()


def game_hello(game: Any) -> dict[str, Any]:
    """Return the ``hello`` of a game.

    It has the capabilities ``snapshot``, ``release``, ``screenshot`` and ``outline`` if the game has the methods.
    """
    words = set(game.hello.get("capabilities", []))
    if hasattr(game, "snapshot") and hasattr(game, "restore"):
        words.add("snapshot")
    if hasattr(game, "release_snapshot"):
        words.add("release")
    if hasattr(game, "screenshot"):
        words.add("screenshot")
    if hasattr(game, "outline"):
        words.add("outline")
    return {**game.hello, "capabilities": sorted(words)}


def _answer(game: Any, client: Client, kind: str, body: Any) -> None:
    if kind == "reset":
        client.answer_state(game.reset(body.get("scene"), body.get("variant", "v0"), body.get("seed")))
    elif kind == "step":
        result = game.step(body["action"])
        for _ in range(body.get("repeat", 1) - 1):
            if result["ended"]:
                break
            result = game.step(body["action"])
        client.answer_state(result)
    elif kind == "snapshot" and hasattr(game, "snapshot"):
        client.answer({"snapshot": {"id": game.snapshot()}})
    elif kind == "restore" and hasattr(game, "restore"):
        client.answer_state(game.restore(body["id"]))
    elif kind == "release" and hasattr(game, "release_snapshot"):
        game.release_snapshot(body["id"])
        client.answer({"release": {"id": body["id"]}})
    elif kind == "screenshot" and hasattr(game, "screenshot"):
        client.answer({"screenshot": game.screenshot()})
    elif kind == "outline" and hasattr(game, "outline"):
        client.answer({"outline": game.outline()})
    else:
        raise Refusal(f"this game does not know the request `{kind}`")


class Client:
    """A connection to tltlc, which sends ``hello`` at once.

    ``hello`` is the declaration of the game, without version and token. By default, the port and
    the token come from the environment variables TLTL_PORT and TLTL_TOKEN. ``connection`` is a socket
    that is connected already; then no port is needed.

    Raises Disconnected if no tltlc can be reached.
    """

    def __init__(
        self,
        hello: Mapping[str, Any],
        port: int | str | None = None,
        token: str | None = None,
        connection: socket.socket | None = None,
    ) -> None:
        token = os.environ.get("TLTL_TOKEN", "") if token is None else token
        self._socket = connection or _connected(port or os.environ.get("TLTL_PORT"))
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._lines = self._socket.makefile("rb")
        self.answer({"hello": {"tltl": PROTOCOL, **({"token": token} if token else {}), **hello}})

    def request(self) -> tuple[str, Any]:
        """Wait for the next request; return its kind, such as ``step``, and its content.

        Raises Disconnected if tltlc has closed the connection, or refuses this game.
        """
        message = self._read()
        if "error" in message:
            body = message["error"]
            raise Disconnected(str(body.get("message") if isinstance(body, dict) else body))
        for kind in KINDS:
            if kind in message:
                return kind, message[kind]
        return next(iter(message), ""), {}

    def answer_state(self, message: Mapping[str, Any]) -> None:
        """Answer a ``reset``, a ``step`` or a ``restore`` with the result of :func:`state`."""
        self.answer({"state": message})

    def refuse(self, reason: str) -> None:
        """Answer that the request cannot be met."""
        self.answer({"error": {"message": reason}})

    def answer(self, message: Mapping[str, Any]) -> None:
        """Send a message.

        Raises ValueError if a number in it is not finite, and Disconnected if tltlc has closed the
        connection.
        """
        data = json.dumps(message, separators=(",", ":"), allow_nan=False).encode() + b"\n"
        try:
            self._socket.sendall(data)
        except OSError:
            raise Disconnected(self._last_words()) from None

    def close(self) -> None:
        """Close the connection."""
        self._lines.close()
        self._socket.close()

    def _read(self) -> dict[str, Any]:
        try:
            line = self._lines.readline(LONGEST_LINE + 1)
        except OSError:
            line = b""
        if not line.endswith(b"\n"):
            raise Disconnected
        message: dict[str, Any] = json.loads(line.decode())
        return message

    def _last_words(self) -> str:
        """Return why tltlc closed the connection, if it said so."""
        try:
            return str(self._read()["error"]["message"])
        except (Disconnected, KeyError, TypeError, ValueError):
            return ""


def _connected(port: int | str | None) -> socket.socket:
    if not port:
        raise Disconnected("tltlc must start this game: the variable TLTL_PORT is not set")
    try:
        return socket.create_connection(("127.0.0.1", int(port)))
    except OSError as error:
        raise Disconnected(f"cannot connect to tltlc at port {port}: {error}") from None


def listen(hello: Mapping[str, Any], port: int, token: str | None = None) -> Client:
    """Wait on a port of 127.0.0.1 until tltlc connects; return the Client.

    Use this if the game file has ``connect = "127.0.0.1:PORT"``. The default of ``token`` is the
    environment variable TLTL_TOKEN. If the token is not empty, tltlc must send the same one. While one
    tltlc plays, no other can connect.

    Raises Disconnected if another program uses the port.
    """
    token = os.environ.get("TLTL_TOKEN", "") if token is None else token
    while True:
        connection = _accepted(port)
        with connection.makefile("rb") as lines:
            try:
                reason = _refusal(json.loads(lines.readline(1 << 16).decode()), token)
            except (OSError, ValueError):
                reason = "the first line must be a `hello`"
        if not reason:
            return Client(hello, token="", connection=connection)
        with connection, suppress(OSError):
            connection.sendall(json.dumps({"error": {"message": reason}}).encode() + b"\n")


def _accepted(port: int) -> socket.socket:
    with socket.socket() as server:
        if os.name != "nt":
            server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            server.bind(("127.0.0.1", port))
            server.listen(1)
        except OSError as error:
            raise Disconnected(f"cannot listen on port {port}: {error}; does this game run twice?") from None
        return server.accept()[0]


def _refusal(message: Any, token: str) -> str:
    """Return why the game refuses ``message``, the first message of tltlc; empty if it accepts the message."""
    hello = message.get("hello") if isinstance(message, dict) else None
    if not isinstance(hello, dict):
        return "the first line must be a `hello`"
    if hello.get("tltl") != PROTOCOL:
        return f"this game speaks version {PROTOCOL} of the protocol"
    if token and hello.get("token") != token:
        return "the token is wrong: start tltlc with the variable TLTL_TOKEN of this game"
    return ""


class Recorder:
    """Writes the play of a person as traces, which ``tltlc monitor`` can judge later; needs no connection.

    Each episode is a file in ``folder``: ``trace-0001.csv``, ``trace-0002.csv`` and so on; no file is
    overwritten. ``signals`` are the names of the signals, as specs write them. With ``clock_hz``,
    the number of samples in a second, the files have a column ``time``::

        recorder = tltl_client.Recorder("traces", ["position", "at_goal"], clock_hz=10)
        recorder.begin()
        recorder.sample({"position": 1, "at_goal": False})    # after each tick
        recorder.end()

    With the actions of the person, as tltlc would send them, each episode is also a tape,
    ``trace-0001.tape.jsonl``, with which the play can be repeated. ``game`` is the name of the game::

        recorder.begin("short", "v0", seed=7)
        recorder.sample({"position": 1, "at_goal": False}, action=2)

    Raises ValueError, in ``sample``, if a number is not finite, or if some samples of an episode have an
    action and others have none; and KeyError if a signal is missing.
    """

    def __init__(
        self,
        folder: str | os.PathLike[str],
        signals: Iterable[str],
        clock_hz: float | None = None,
        game: str = "game",
    ) -> None:
        self._folder, self._signals, self._clock_hz = Path(folder), tuple(signals), clock_hz
        self._game = game
        self._file: TextIO | None = None
        self._tape: TextIO | None = None
        self._played: dict[str, Any] = {}

    def begin(self, scene: str | None = None, variant: str | None = None, seed: int | None = None) -> Path:
        """Begin a new trace, and end the one before; return the path of its file, which the first sample makes.

        A tape says which scene, variant and seed were played; without a variant it is ``v0``.
        """
        self.end()
        self._played = {"scene": scene, "variant": "v0" if variant is None else variant, "seed": seed}
        self._samples, self._digest = 0, 1
        return next(self._free_paths())

    def sample(self, signals: Mapping[str, float], action: Any = None) -> None:
        """Write the values of all signals at one moment to the file at once; begin a trace if there is none.

        With ``action``, what the person did in the tick before it, the step is written to the tape, too.
        """
        texts = {name: _value(name, signals[name]) for name in self._signals}
        action_text = (
            None if action is None else json.dumps(action, separators=(",", ":"), allow_nan=False, default=_as_list)
        )
        if not self._played:
            self.begin()
        if self._file is None:
            self._make_trace()
        if self._samples and (action_text is None) != (self._tape is None):
            raise ValueError("give the action of each sample of an episode, or of none")
        if action_text is not None:
            self._write_step(action_text, texts, {name: float(signals[name]) for name in self._signals})
        times = [repr(self._samples / self._clock_hz)] if self._clock_hz else []
        self._write([*times, *texts.values()])
        self._samples += 1

    def end(self) -> None:
        """End the trace and its tape, if there is one."""
        for file in (self._file, self._tape):
            if file is not None:
                file.close()
        self._file = self._tape = None
        self._played = {}

    def _free_paths(self) -> Iterator[Path]:
        paths = (self._folder / f"trace-{number:04d}.csv" for number in count(1))
        return (path for path in paths if not path.exists() and not _tape_path(path).exists())

    def _make_trace(self) -> None:
        self._folder.mkdir(parents=True, exist_ok=True)
        for path in self._free_paths():
            # Another recorder may just have made this file.
            with suppress(FileExistsError):
                self._file, self._path = path.open("x", encoding="utf-8", newline="\n"), path
                break
        self._write(map(_cell, ("time", *self._signals) if self._clock_hz else self._signals))

    def _write_step(self, action: str, texts: Mapping[str, str], numbers: Mapping[str, float]) -> None:
        """Write a step to the tape, and before the first one the header."""
        if self._tape is None:
            self._tape = _tape_path(self._path).open("x", encoding="utf-8", newline="\n")
            self._bools = {name for name, text in texts.items() if text in ("true", "false")}
            types = {name: {"type": "bool" if name in self._bools else "number"} for name in texts}
            about = {"spec": None, "versions": {"python": sys.version.split()[0]}, "clock_hz": self._clock_hz}
            header = {"tape": 1, "game": self._game, **self._played, **about, "signals": types}
            self._tape.write(json.dumps(header, separators=(",", ":"), default=_as_list) + "\n")
        # A signal keeps the type of its first value.
        numbers = {name: float(number != 0) if name in self._bools else number for name, number in numbers.items()}
        values = {
            name: _value(name, number == 1 if name in self._bools else number) for name, number in numbers.items()
        }
        members = ",".join(f"{json.dumps(name)}:{value}" for name, value in values.items())
        # The bytes of -0 are not those of 0.
        self._digest = adler32(pack(f"<{len(numbers)}d", *(number + 0.0 for number in numbers.values())), self._digest)
        is_checked = (self._samples + 1) % 60 == 0
        digest = f',"digest":"{self._digest:08x}"' if is_checked else ""
        self._tape.write(f'{{"action":{action},"signals":{{{members}}}{digest}}}\n')
        self._tape.flush()

    def _write(self, cells: Iterable[str]) -> None:
        assert self._file is not None
        self._file.write(",".join(cells) + "\n")
        self._file.flush()


def _value(name: str, value: float) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if not isfinite(value):
        raise ValueError(f"the signal {name} is {value}, and numbers must be finite")
    return repr(float(value))


def _tape_path(trace: Path) -> Path:
    return trace.with_name(f"{trace.stem}.tape.jsonl")


def _as_list(value: Any) -> Any:
    """Return an array or a number of NumPy as JSON can have it."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"an action of the type {type(value).__name__} cannot be written")


def _cell(name: str) -> str:
    quoted = name.replace('"', '""')
    return f'"{quoted}"' if "," in name or name.startswith('"') else name
