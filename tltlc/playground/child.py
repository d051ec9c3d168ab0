"""The process that answers one request of JSON, from its standard input to its standard output.

A compilation cannot be interrupted from within, so that it runs where it can be ended from outside.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import Final

NO_REQUEST: Final = 2
MOST_MEMORY: Final = 2 << 30
MOST_TIME: Final = 60
"""In bytes, and in seconds of work, where the system can hold a process to it: it may outlive the server."""


def main() -> None:
    """Load what a compilation needs, then wait for the request; exit status 2 where it is none."""
    from tltlc.playground.protocol import RequestError, answer

    with suppress(ImportError, OSError, ValueError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_TIME, MOST_TIME))
    request = sys.stdin.buffer.read()
    # A child that is no longer wanted is told nothing.
    if not request:
        return
    try:
        answered = answer(request.decode("utf-8"))
    except (RequestError, UnicodeDecodeError):
        sys.exit(NO_REQUEST)
    sys.stdout.buffer.write(answered.encode("utf-8"))
