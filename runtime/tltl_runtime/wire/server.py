"""Listen at an address, where a game connects that speaks a protocol of another trainer."""

from __future__ import annotations

import errno
import socket

from tltl_runtime.wire.errors import NOT_STARTED, WireError, wire_error


def listen(host: str, port: int, other: str) -> socket.socket:
    """Return a socket that listens at a port of ``host``; 0 stands for a free one.

    ``other`` names a trainer that may use the port already. Raises WireError, TLT0790, if the socket cannot listen.
    """
    try:
        return socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError as error:
        raise cannot_listen(place_text(host, port), error, other) from None


def cannot_listen(place: str, error: Exception, other: str) -> WireError:
    """Return the error for an address at which tltlc cannot listen because of ``error``."""
    reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
    help_ = "in the game file, give `connect` an address of this machine, such as 127.0.0.1, and a port from 1024 on"
    if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
        help_ = f"end the other program that uses this port; it may be another tltlc, or {other}"
    return wire_error(NOT_STARTED, f"cannot wait for a game at `{place}`: {reason}", help_)


def place_text(host: str, port: int) -> str:
    """Return ``HOST:PORT``; an IPv6 address gets brackets, as in ``[::1]:5000``."""
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
