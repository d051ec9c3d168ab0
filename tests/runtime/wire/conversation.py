"""Check a client of the protocol ``tltl/1``, in any language, by a fixed conversation with a small game.

Usage: python conversation.py COMMAND…

Each client implements the same game with its own language's client file; the command starts that
game, which connects over TCP or WebSocket. The script prints a line for each exchange, and ends with
status 1 if one went wrong. The game:

**Counter.** A player stands on one of the places 0 to 10. An action is ``0`` (one place to the left),
``1`` (stay) or ``2`` (one place to the right); at 0 and at 10 the player stays where it would leave
the row. A tick is a tenth of a second.

- ``hello``: ``name`` is ``counter``, ``clock_hz`` 10, ``actions`` ``{"type": "discrete", "n": 3}``,
  ``observation`` ``{"type": "box", "low": 0, "high": 10, "shape": [1], "dtype": "float32"}``, ``params``
  ``{"goal": 10}``, ``scenes`` ``["short", "long"]``, ``capabilities`` ``seed``, ``positions``, ``snapshot``,
  ``release``, ``screenshot`` and ``outline`` in any order. ``signals``: ``position`` with the range [0, 10], ``moves``
  with the range [0, null], ``at_goal`` of the type ``bool``.
- ``reset``: the player begins at 1 + seed mod 4, or at 1 without a seed, and ``moves`` is 0. The goal is
  5 in the scene ``short``, which is the default, and 10 in ``long``. The variant ``trap``
  has a trap at 0; ``v0`` has none. Another scene or variant is answered by an ``error`` that names it.
- ``step``: each tick adds 1 to ``moves``. The episode has ended with the cause ``goal`` at or beyond the
  goal, and with the cause ``trap`` at a trap; otherwise ``cause`` is null. With ``repeat``, no further
  tick is played once the episode has ended.
- ``state``: the three signals, ``at_goal`` as a bool; the observation is ``[position]``; the positions are
  ``{"player": [position, 0]}``.
- ``snapshot``: the ids are 1, 2, 3 and so on. ``restore`` returns to the scene, variant, position and
  moves of a snapshot, and answers with the state; it can be repeated. ``release`` forgets a snapshot; its id
  is not given again. Another id, or one that was released, is answered by an ``error``.
- ``screenshot``: one row of 11 pixels, black, that of the player white, as ``uint8`` in base64.
- ``outline``: the bounds are from [-1, -2] to [11, 3]. Two boxes ``edge`` lie from [-1, -1] to [-0.5, 2] and from
  [10.5, -1] to [11, 2]. The region ``goal`` lies from [the goal - 0.5, -1] to [10.5, 2]. In the variant ``trap``
  of the scene ``long``, there is the polygon ``trap`` with the corners [-0.5, -1], [0.5, -1] and [0, 2]. The image,
  from [-0.5, -1] to [10.5, 2], has one white pixel, as ``uint8`` in base64. In the variant ``trap`` of the scene
  ``short``, the answer is an ``error``.
- ``close``, or the end of the connection: the game ends with exit status 0.
- An ``error`` from tltlc: the game ends with another status, and writes the message to standard error.
- Unknown keys are ignored; an unknown request is answered by an ``error``.
"""

from __future__ import annotations

import base64
import json
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from typing import Any

from tltl_runtime.wire.errors import GameGoneError, GameSilentError, MalformedMessageError
from tltl_runtime.wire.websocket import WebSocketChannel, WebSocketMessages

PATIENCE_S = 120.0
TOKEN = "0123456789abcdef"

HELLO: dict[str, Any] = {
    "tltl": 1,
    "token": TOKEN,
    "name": "counter",
    "clock_hz": 10,
    "signals": {"position": {"range": [0, 10]}, "moves": {"range": [0, None]}, "at_goal": {"type": "bool"}},
    "params": {"goal": 10},
    "actions": {"type": "discrete", "n": 3},
    "observation": {"type": "box", "low": 0, "high": 10, "shape": [1], "dtype": "float32"},
    "scenes": ["short", "long"],
    "capabilities": ["outline", "positions", "release", "screenshot", "seed", "snapshot"],
}


def state(position: int, moves: int, at_goal: bool = False, cause: str | None = None) -> dict[str, Any]:
    """Return the message that the game must send."""
    return {
        "state": {
            "signals": {"position": position, "moves": moves, "at_goal": at_goal},
            "observation": [position],
            "ended": cause is not None,
            "cause": cause,
            "positions": {"player": [position, 0]},
        }
    }


def picture(position: int) -> dict[str, Any]:
    """Return the message with the picture that the game must draw."""
    pixels = bytearray(33)
    pixels[3 * position : 3 * position + 3] = b"\xff\xff\xff"
    return {"screenshot": {"base64": base64.b64encode(pixels).decode(), "dtype": "uint8", "shape": [1, 11, 3]}}


def outline(goal: int, *, has_trap: bool = False) -> dict[str, Any]:
    """Return the message that the game must send for its scene and variant."""
    pixel = {"base64": "////", "dtype": "uint8", "shape": [1, 1, 3]}
    return {
        "outline": {
            "bounds": [[-1, -2], [11, 3]],
            "boxes": {"edge": [[[-1, -1], [-0.5, 2]], [[10.5, -1], [11, 2]]]},
            "polygons": {"trap": [[-0.5, -1], [0.5, -1], [0, 2]]} if has_trap else {},
            "regions": {"goal": [[goal - 0.5, -1], [10.5, 2]]},
            "image": {"pixels": pixel, "extent": [-0.5, -1, 10.5, 2]},
        }
    }


EXCHANGES: tuple[tuple[str, dict[str, Any], dict[str, Any]], ...] = (
    ("a reset begins where the seed says", {"reset": {"scene": "short", "variant": "v0", "seed": 6}}, state(3, 0)),
    ("an outline is that of the scene", {"outline": {}}, outline(5)),
    ("an action moves right", {"step": {"action": 2}}, state(4, 1)),
    ("an action stays", {"step": {"action": 1}}, state(4, 2)),
    ("an action moves left", {"step": {"action": 0}}, state(3, 3)),
    ("a snapshot has the id 1", {"snapshot": {}}, {"snapshot": {"id": 1}}),
    ("a step repeats until the end", {"step": {"action": 2, "repeat": 9}}, state(5, 5, True, "goal")),
    ("a screenshot shows the player", {"screenshot": {}}, picture(5)),
    ("a snapshot is restored", {"restore": {"id": 1}}, state(3, 3)),
    ("the game goes on from there", {"step": {"action": 0, "repeat": 2}}, state(1, 5)),
    ("the next snapshot has the id 2", {"snapshot": {}}, {"snapshot": {"id": 2}}),
    ("a reset without a seed", {"reset": {"scene": "long", "variant": "v0"}}, state(1, 0)),
    ("the edge holds the player", {"step": {"action": 0, "repeat": 3}}, state(0, 3)),
    ("the other scene has another goal", {"step": {"action": 2, "repeat": 6}}, state(6, 9)),
    ("a snapshot of another scene is restored", {"restore": {"id": 2}}, state(1, 5)),
    ("with the goal of that scene", {"step": {"action": 2, "repeat": 9}}, state(5, 9, True, "goal")),
    ("a trap ends the episode", {"reset": {"scene": "long", "variant": "trap", "seed": 0}}, state(1, 0)),
    ("an outline is that of the variant", {"outline": {}}, outline(10, has_trap=True)),
    ("with a cause", {"step": {"action": 0, "repeat": 4}}, state(0, 1, False, "trap")),
    ("a reset needs no scene and no variant", {"reset": {"seed": 5}}, state(2, 0)),
    ("unknown keys are ignored", {"reset": {"seed": 3, "later": [1]}, "also": {"x": None}}, state(4, 0)),
    ("an unknown key of a step is ignored", {"step": {"action": 1, "hint": {"a": 1}}}, state(4, 1)),
    ("a large seed is exact", {"reset": {"seed": 2**53 - 1}}, state(4, 0)),
    ("a snapshot is released", {"release": {"id": 1}}, {"release": {"id": 1}}),
    ("the episode goes on after that", {"step": {"action": 0}}, state(3, 1)),
    ("the id of the next snapshot is new", {"snapshot": {}}, {"snapshot": {"id": 3}}),
    ("the other snapshots are kept", {"restore": {"id": 2}}, state(1, 5)),
    ("a variant without an outline", {"reset": {"scene": "short", "variant": "trap", "seed": 0}}, state(1, 0)),
)
"""What is sent, and what the game must answer, in order."""

REFUSALS: tuple[tuple[str, dict[str, Any], str], ...] = (
    ("an outline is refused", {"outline": {}}, "trap"),
    ("a snapshot that was released is not restored", {"restore": {"id": 1}}, "1"),
    ("and not released again", {"release": {"id": 1}}, "1"),
    ("an unknown scene is refused", {"reset": {"scene": "crypt"}}, "crypt"),
    ("an unknown variant is refused", {"reset": {"variant": "v9"}}, "v9"),
    ("an unknown snapshot is refused", {"restore": {"id": 77}}, "77"),
    ("an unknown request is refused", {"telepathy": {}}, "telepathy"),
)
"""What the game must answer by an ``error`` that contains the text; it stays ready afterwards."""


class Failure(Exception):
    """An exchange went wrong."""


class Game:
    """The process of a game that has connected."""

    def __init__(self, command: Sequence[str], token: str = TOKEN) -> None:
        with socket.create_server(("127.0.0.1", 0)) as server:
            server.settimeout(PATIENCE_S)
            variables = {**os.environ, "TLTL_PORT": str(server.getsockname()[1]), "TLTL_TOKEN": token}
            self.errors = tempfile.TemporaryFile()  # noqa: SIM115
            self.process = subprocess.Popen(command, env=variables, stdin=subprocess.DEVNULL, stderr=self.errors)
            try:
                self.connection, _ = server.accept()
            except BaseException:  # It did not connect in time, or Ctrl-C.
                self.process.kill()
                self.process.wait()
                raise
        self.connection.settimeout(PATIENCE_S)
        is_page = self.connection.recv(4, socket.MSG_PEEK) == b"GET "
        self.web = WebSocketChannel(self.connection, WebSocketMessages()) if is_page else None
        self.lines = self.connection.makefile("rb")

    def __enter__(self) -> Game:
        return self

    def __exit__(self, *_: object) -> None:
        self.disconnect()
        self.process.kill()
        self.process.wait()
        self.errors.close()

    def receive(self) -> Any:
        """Return the next message of the game."""
        if self.web is not None:
            return self._from_page(self.web)
        line = self.lines.readline(1 << 20)
        if not line.endswith(b"\n"):
            raise Failure(f"the game closed its connection; its standard error: {self.stderr()}")
        try:
            return json.loads(line, parse_constant=_refuse_constant)
        except ValueError as error:
            raise Failure(f"the game sent {line[:200]!r}: {error}") from None

    def send(self, message: Any) -> None:
        """Send a message in two pieces, since TCP may divide any."""
        if self.web is not None:
            self.web.send(message, PATIENCE_S)
            return
        data = json.dumps(message).encode() + b"\n"
        self.connection.sendall(data[:5])
        self.connection.sendall(data[5:])

    def _from_page(self, web: WebSocketChannel) -> Any:
        try:
            return web.receive(PATIENCE_S)
        except (GameGoneError, GameSilentError, MalformedMessageError) as error:
            raise Failure(f"the page did not answer: {error}; its standard error: {self.stderr()}") from None

    def ask(self, message: Any) -> Any:
        """Send a request and return the answer."""
        self.send(message)
        return self.receive()

    def disconnect(self) -> None:
        """End the connection."""
        self.lines.close()
        self.connection.close()

    def status(self) -> int:
        """Wait for the end of the process and return its exit status."""
        try:
            return self.process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            raise Failure("the game did not end") from None

    def stderr(self) -> str:
        """Return what the game has written to standard error."""
        self.errors.seek(0)
        return self.errors.read().decode(errors="replace").strip()


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is not JSON")


def hello(game: Game) -> None:
    """Receive the first message, and compare all that it must contain."""
    message = game.receive()
    declared = message.get("hello", {})
    declared = {**declared, "capabilities": sorted(declared.get("capabilities", []))}
    wanted = {key: declared.get(key) for key in HELLO}
    expect(wanted == HELLO, HELLO, wanted)


def expect(is_right: bool, wanted: Any, answer: Any) -> None:
    """Raise Failure unless the answer is right."""
    if not is_right:
        raise Failure(f"expected {json.dumps(wanted)}, received {json.dumps(answer)}")


def contains(answer: Any, wanted: Any) -> bool:
    """Whether an answer has all that is wanted, with numbers of equal value and bools that are bools."""
    if isinstance(wanted, dict):
        return isinstance(answer, dict) and all(key in answer and contains(answer[key], wanted[key]) for key in wanted)
    if isinstance(wanted, list):
        return isinstance(answer, list) and len(answer) == len(wanted) and all(map(contains, answer, wanted))
    return bool(answer == wanted) and isinstance(answer, bool) == isinstance(wanted, bool)


def check(command: Sequence[str], report: Callable[[str], None] = print) -> bool:
    """Hold all conversations with the client that ``command`` starts; return whether all went right."""
    results = [_talk(command, report)]
    for name, conversation in (
        ("close ends the game", _close),
        ("the end of the connection ends the game", _end),
        ("a refusal at hello ends the game", _refused),
        ("a second game has a state of its own", _second),
    ):
        results.append(_attempt(name, lambda run=conversation: run(command), report))  # type: ignore[misc]
    report("all exchanges went right" if all(results) else f"{results.count(False)} conversations went wrong")
    return all(results)


def _talk(command: Sequence[str], report: Callable[[str], None]) -> bool:
    """Hold the main conversation; it ends at the first wrong answer."""
    with Game(command) as game:
        if not _attempt("the game says hello", lambda: hello(game), report):
            return False
        for name, message, wanted in (*EXCHANGES, *(_refusal(*refusal) for refusal in REFUSALS), *EXCHANGES[:4]):

            def exchange(message: Any = message, wanted: Any = wanted) -> None:
                answer = game.ask(message)
                if callable(wanted):
                    wanted(answer)
                else:
                    expect(contains(answer, wanted), wanted, answer)

            if not _attempt(name, exchange, report):
                return False
    return True


def _refusal(name: str, message: dict[str, Any], text: str) -> tuple[str, dict[str, Any], Any]:
    def is_refusal(answer: Any) -> None:
        reason = answer.get("error", {}).get("message", "") if isinstance(answer, dict) else ""
        expect(text in reason, {"error": {"message": f"… {text} …"}}, answer)

    return name, message, is_refusal


def _attempt(name: str, run: Callable[[], None], report: Callable[[str], None]) -> bool:
    try:
        run()
    except (Failure, OSError) as failure:
        report(f"WRONG  {name}: {failure}")
        return False
    report(f"right  {name}")
    return True


def _close(command: Sequence[str]) -> None:
    with Game(command) as game:
        hello(game)
        game.send({"close": {}})
        game.disconnect()
        expect(game.status() == 0, "exit status 0", game.status())


def _end(command: Sequence[str]) -> None:
    with Game(command) as game:
        hello(game)
        game.ask({"reset": {}})
        game.disconnect()
        expect(game.status() == 0, "exit status 0", game.status())


def _refused(command: Sequence[str]) -> None:
    with Game(command) as game:
        game.receive()
        game.send({"error": {"message": "tltlc refuses this game, because it is a test"}})
        game.disconnect()
        expect(game.status() != 0, "another exit status than 0", game.status())
        expect("because it is a test" in game.stderr(), "the message on standard error", game.stderr())


def _second(command: Sequence[str]) -> None:
    with Game(command) as one, Game(command) as other:
        hello(one)
        hello(other)
        one.ask({"reset": {"seed": 0}})
        other.ask({"reset": {"seed": 3}})
        answer = one.ask({"step": {"action": 2}})
        expect(contains(answer, state(2, 1)), state(2, 1), answer)


if __name__ == "__main__":
    sys.exit(0 if check(sys.argv[1:]) else 1)
