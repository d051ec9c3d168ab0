"""Errors of games in other processes."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.api import Diagnostic, TltlError

NOT_STARTED = "TLT0790"
LOST = "TLT0791"
MALFORMED = "TLT0792"
REPORTED = "TLT0793"


class WireError(TltlError):
    """Raised if a game in another process cannot be started, or is lost with its current episode.

    The code of the diagnostic says why. TLT0790: the game did not start. TLT0791: it hangs, has ended,
    or has closed its connection. TLT0792: it broke the protocol. TLT0793: it reported an error. The help
    contains the last lines that the game wrote to standard error.
    """


class MalformedMessageError(ValueError):
    """Raised for a message that breaks the protocol.

    The text completes the sentence "the game …", for example "sent NaN".
    """


class GameSilentError(Exception):
    """Raised if a game does not send or receive in time."""


class GameGoneError(Exception):
    """Raised if a game has closed its connection."""


def wire_error(code: str, title: str, help_: str, last_lines: Iterable[str] = ()) -> WireError:
    """Return an error; ``last_lines`` are the last lines of the game's standard error, none if they are unknown."""
    text = "\n".join(last_lines)
    shown = f"the game's standard error ends:\n{text}\n{help_}" if text else help_
    return WireError([Diagnostic(code, title, help=shown)])
