"""A conversation with a game in another process, which is started, or runs already."""

from __future__ import annotations

import os
import secrets
import socket
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any, Final, NoReturn, TypeVar

from tltl_runtime.wire import errors, godot_rl, json_text, ml_agents
from tltl_runtime.wire.answers import ReportedError, body_of
from tltl_runtime.wire.byte_stream import ByteStream
from tltl_runtime.wire.channel import Channel, JsonLines, has_msgpack
from tltl_runtime.wire.errors import GameGoneError, GameSilentError, MalformedMessageError, WireError, wire_error
from tltl_runtime.wire.game_process import GameProcess
from tltl_runtime.wire.hello import JSON, MSGPACK, VERSION, Hello, hello_from
from tltl_runtime.wire.listener import Listener
from tltl_runtime.wire.ml_agents import MlAgentsChannel
from tltl_runtime.wire.requests import CloseRequest, Refusal
from tltl_runtime.wire.server import listen
from tltl_runtime.wire.start_watch import GRACE_S, StartWatch
from tltl_runtime.wire.wire_game import GODOT_RL, ML_AGENTS, TLTL, WireGame, address
from tltlc.api import fileio

_AT_ONCE: Final = 0.99
"""The share of the time for an answer that is left after a request was sent at once, at least."""
_TO_CLOSE_S: Final = 5.0
"""Seconds in which a game that has closed its connection, was refused, or was asked to close, ends by itself."""
_TO_LISTEN_S: Final = 5.0
"""Seconds in which a game that is running listens again."""
_PAUSE_S: Final = 0.05
"""Seconds between two tries to connect to a game that is running."""
_TOKEN_BYTES: Final = 16
_ENDED: Final = "correct the game; let it write what it does to standard error"
_UNREADABLE: Final = "correct the script: the engine cannot read it, and goes on without it"
_HELLO: Final = {
    TLTL: ("said hello", "say hello"),
    GODOT_RL: ("answered `env_info`", "connect and answer `env_info`"),
    ML_AGENTS: ("described its agent", "connect and describe its agent"),
}
"""How messages say, for each protocol, that the game has introduced itself, and that it does so."""

Answer = TypeVar("Answer")


class WireSession:
    """A running game that has said ``hello``.

    Raises:
        WireError: the game does not start, does not say ``hello``, or says a wrong ``hello``.
        TltlError: TLT0803, ``connect`` is no address.
    """

    def __init__(self, game: WireGame) -> None:
        self._game = game
        self._process: GameProcess | None = None
        self._watch: StartWatch | None = None
        self._channel: Channel | None = None
        try:
            self._channel, message = self._opened()
            self.hello: Hello = hello_from(message)
            self._agree_on_encoding()
        except BaseException as error:
            raise self._lost(error, "hello", game.start_s) from None
        if self._watch:
            self._watch.end()

    @property
    def is_over(self) -> bool:
        """Whether the conversation has ended, by ``close`` or by an error."""
        return self._channel is None

    @property
    def process_id(self) -> int | None:
        """The id of the process that supervises the game; None for a game that tltlc did not start."""
        return self._process.pid if self._process else None

    def ask(self, kind: str, message: dict[str, Any], read: Callable[[Any], Answer]) -> Answer:
        """Send a request and return what ``read`` makes of the answer.

        ``kind`` is the kind of the request, such as ``step``. On any exception, even KeyboardInterrupt, the
        game is ended, because a late answer would count for the next request.

        Raises:
            WireError: TLT0791, the game is lost; TLT0792, its answer is malformed; TLT0793, the answer is an error.
        """
        assert self._channel is not None
        patience = self._game.step_s
        deadline = time.monotonic() + patience
        try:
            self._channel.send(message, patience)
            left = deadline - time.monotonic()
            # To set the timeout of a socket takes a call of the system, so keep it for a request that is sent at once.
            return read(self._channel.receive(patience if left > _AT_ONCE * patience else left))
        except BaseException as error:
            raise self._lost(error, kind, self._game.step_s) from None

    def last_lines(self) -> list[str]:
        """Return the last lines that a closed game wrote to standard error, those that help to mend it.

        There are none of a game that tltlc did not start.
        """
        return self._process.last_lines() if self._process else []

    def refuse(self, reason: str) -> NoReturn:
        """End a game that breaks the protocol; ``reason`` completes "the game …". Raises WireError, TLT0792."""
        raise self._lost(MalformedMessageError(reason), "hello", self._game.start_s)

    def close(self) -> None:
        """Ask the game to end, and close the connection.

        If tltlc started the game and it does not end within five seconds, kill it.
        """
        self._say_last(CloseRequest().message())
        self._end_process()

    # --- the beginning ------------------------------------------------------------------------------

    def _opened(self) -> tuple[Channel, Any]:
        """Start the game, or connect to it; return the connection and the game's ``hello``."""
        if self._game.protocol == GODOT_RL:
            return self._awaited()
        if self._game.protocol == ML_AGENTS:
            return self._served()
        return self._connected() if self._game.connect else self._started()

    def _awaited(self) -> tuple[Channel, Any]:
        """Wait for a game that speaks the protocol of Godot RL Agents. Start it first, unless it has ``connect``."""
        with listen(*self._place(), "Godot RL Agents") as server:
            if self._game.process:
                words = godot_rl.with_arguments(self._game.process, server.getsockname()[1])
                self._start(words, {})
            deadline = time.monotonic() + self._game.start_s
            channel = self._channel = godot_rl.accept(server, self._game.start_s, self._is_over())
        return channel, channel.hello(deadline - time.monotonic())

    def _served(self) -> tuple[Channel, Any]:
        """Wait for a game that speaks the protocol of ML-Agents. Start it first, unless it has ``connect``."""
        game = self._game
        channel = MlAgentsChannel(*self._place(), dict(game.parameters))
        self._channel = channel
        if game.process:
            self._start(ml_agents.with_arguments(game.process, channel.port), {})
        return channel, channel.hello(game.start_s, self._is_over())

    def _start(self, words: Sequence[str], variables: Mapping[str, str]) -> None:
        """Start the process of the game."""
        self._process = GameProcess(words, self._game.folder, variables)
        self._watch = StartWatch(self._game.name, self._process, self._game.start_s)

    def _is_over(self) -> Callable[[], bool]:
        """Return a function that says whether the game has ended, or its start is given up."""
        return self._watch.is_over if self._watch else lambda: False

    def _place(self) -> tuple[str, int]:
        """Return the host and the port at which tltlc waits for the game; the port 0 stands for a free one."""
        return address(self._game.connect) if self._game.connect else ("127.0.0.1", 0)

    def _started(self) -> tuple[Channel, Any]:
        """Start the game, and wait until it connects; return the connection and the game's first message."""
        token = secrets.token_hex(_TOKEN_BYTES)
        listener = Listener(token)
        try:
            variables = {"TLTL_PORT": str(listener.port), "TLTL_TOKEN": token}
            self._start(self._game.process, variables)
            try:
                return listener.hello(self._game.start_s, self._is_over())
            except GameSilentError:
                if listener.refusal:
                    raise MalformedMessageError(listener.refusal) from None
                raise
        finally:
            listener.close()

    def _connected(self) -> tuple[Channel, Any]:
        """Connect to a game that is already running; say hello and return the connection and the answer."""
        deadline = time.monotonic() + self._game.start_s
        stream = ByteStream(_connection(self._game.connect, deadline))
        channel = self._channel = JsonLines(stream)
        # The side that connects sends the token: here, this is tltlc.
        token = os.environ.get("TLTL_TOKEN", "")
        # This is no request: the game may have sent an error already, such as that it is busy.
        stream.send(json_text.line({"hello": {"tltl": VERSION, "token": token}}), deadline - time.monotonic())
        message = channel.receive(deadline - time.monotonic(), fileio.limits.WIRE_HELLO.size)
        body_of(message, "hello")
        return channel, message

    def _agree_on_encoding(self) -> None:
        if self.hello.encoding != MSGPACK:
            return
        assert self._channel is not None
        encoding = MSGPACK if has_msgpack() else JSON
        self._channel.send({"hello": {"tltl": VERSION, "encoding": encoding}}, self._game.start_s)
        if encoding == MSGPACK:
            self._channel = self._channel.with_msgpack()

    # --- the end ------------------------------------------------------------------------------------

    def _lost(self, error: BaseException, kind: str, patience: float) -> BaseException:
        """End the game after an error, and return the exception to raise.

        This is a WireError if the error is about the game, else the error itself. ``kind`` is the request
        to which no good answer came, and ``patience`` how many seconds the game had for it. If the game's
        ``hello`` breaks the protocol, tltlc first sends the game the reason.
        """
        if kind == "hello" and isinstance(error, MalformedMessageError) and self._game.protocol == TLTL:
            self._say_last(Refusal(str(error)).message())
        self._close_channel()
        has_ended = self._has_ended(error)
        self._end_process()
        if isinstance(error, WireError) or not isinstance(
            error, (GameSilentError, GameGoneError, MalformedMessageError, ReportedError)
        ):
            return error
        name = f"the game `{self._game.name}`"
        lines = self.last_lines()
        starting = kind == "hello"
        if isinstance(error, MalformedMessageError):
            help_ = "correct the game; `docs/wire.md` describes the messages"
            return wire_error(errors.MALFORMED, f"{name} {error}", help_, lines)
        if isinstance(error, ReportedError):
            return wire_error(
                errors.REPORTED, f"{name} reports: {error}", "correct the game, or what it asks for", lines
            )
        code = errors.NOT_STARTED if starting else errors.LOST
        said_hello, say_hello = _HELLO[self._game.protocol]
        before = f"before it {said_hello}" if starting else f"instead of answering `{kind}`"
        if self._watch and self._watch.gave_up:
            title = f"{name} did not {say_hello} within {GRACE_S:g} s after an error in a script, and was ended"
            return wire_error(code, title, _UNREADABLE, lines)
        if has_ended and self._process:
            return wire_error(code, f"{name} {self._process.end_text()} {before}", _ENDED, lines)
        if isinstance(error, GameGoneError):
            return wire_error(code, f"{name} closed its connection {before}", _ENDED, lines)
        key = "start_s" if starting else "step_s"
        what = say_hello if starting else f"answer `{kind}`"
        help_ = f"find out what it waits for, or allow more time with `{key}`"
        ended = ", and was ended" if self._process else ""
        return wire_error(code, f"{name} did not {what} within {patience:g} s{ended}", help_, lines)

    def _has_ended(self, error: BaseException) -> bool:
        """Whether the game has ended by itself.

        A game that has closed its connection may end soon, so wait for it a few seconds.
        """
        if self._process is None or (self._watch and self._watch.gave_up):
            return False
        return self._process.wait(_TO_CLOSE_S if isinstance(error, GameGoneError) else 0)

    def _say_last(self, message: dict[str, Any]) -> None:
        """Send the last message, close the connection, and wait a few seconds until the game has ended by itself."""
        if self._channel is not None:
            with suppress(Exception):
                self._channel.send(message, _TO_CLOSE_S)
            self._close_channel()
            if self._process is not None:
                self._process.wait(_TO_CLOSE_S)

    def _close_channel(self) -> None:
        if self._channel is not None:
            self._channel.close()
        self._channel = None

    def _end_process(self) -> None:
        if self._process is not None:
            self._process.end()


def _connection(place: str, deadline: float) -> socket.socket:
    """Connect to the game that listens at ``place``, ``HOST:PORT``, before the clock says ``deadline``.

    If nothing listens there, try again for a few seconds: a game listens again a moment after its last connection
    has ended, or later if it was lost in a slow step. Raises WireError, TLT0790, if that is in vain.
    """
    host, port = address(place)
    last_try = min(time.monotonic() + _TO_LISTEN_S, deadline)
    while True:
        try:
            return socket.create_connection((host, port), max(deadline - time.monotonic(), _PAUSE_S))
        except OSError as error:
            if not isinstance(error, ConnectionRefusedError) or time.monotonic() > last_try:
                title = f"no game listens at `{place}`: {error.strerror or error}"
                help_ = "start the game first; it may also be busy with another tltlc"
                raise wire_error(errors.NOT_STARTED, title, help_) from None
        time.sleep(_PAUSE_S)
