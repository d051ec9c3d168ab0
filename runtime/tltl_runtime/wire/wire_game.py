"""How a game in another process is started, or where it runs already."""

from __future__ import annotations

from pathlib import Path

from tltlc.api import Diagnostic, TltlError, record

TLTL = "tltl"
GODOT_RL = "godot-rl"
ML_AGENTS = "ml-agents"
PROTOCOLS = (TLTL, GODOT_RL, ML_AGENTS)
"""The protocols that games in other processes may speak."""

START_S = 30.0
STEP_S = 5.0


@record
class WireGame:
    """A game in another process, as a game file describes it.

    Either ``process`` has the words of the command that starts the game in ``folder``, or ``connect``
    is the address, ``HOST:PORT``, of a game that is running. The game must say ``hello`` within
    ``start_s`` seconds, and answer each request within ``step_s`` seconds. ``name`` is used in
    messages. ``protocol`` is one of :data:`PROTOCOLS`. With another one than ``tltl``, ``connect`` is the
    address at which tltlc waits for a game that is running. ``parameters`` are the names and values of environment
    parameters; only games that speak ``ml-agents`` have them.
    """

    name: str
    folder: Path
    process: tuple[str, ...] = ()
    connect: str = ""
    start_s: float = START_S
    step_s: float = STEP_S
    protocol: str = TLTL
    parameters: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        if bool(self.process) == bool(self.connect):
            raise ValueError("a game has either `process` or `connect`")


def address(text: str) -> tuple[str, int]:
    """Return the host and the port of ``HOST:PORT``; an IPv6 address has brackets, as in ``[::1]:5000``.

    Raises:
        TltlError: TLT0803, ``text`` is no address.
    """
    host, colon, port = text.rpartition(":")
    host = host[1:-1] if host.startswith("[") and host.endswith("]") else host
    if not colon or not host or not port.isascii() or not port.isdigit() or not 0 < int(port) < 2**16:
        title, help_ = f"`{text}` is not an address", 'write `connect = "127.0.0.1:5000"`: a host and a port'
        raise TltlError([Diagnostic("TLT0803", title, help=help_)])
    return host, int(port)
