"""The process that answers one request of JSON, from its standard input to its standard output.

A compilation cannot be interrupted from within, so that it runs where it can be ended from outside.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import Final

from tltlc.io.files import confined
from tltlc.io.limits import ANSWER, PLAYGROUND_CHILD
from tltlc.io.resources import limit

NO_REQUEST: Final = 2
NO_MEMORY: Final = 3


def main() -> None:
    """Load what a compilation needs, then wait for the request.

    The exit status is :data:`NO_REQUEST` if it is none, :data:`NO_MEMORY` if memory runs out.
    """
    try:
        _answer_request()
    except MemoryError:
        # What Python itself prints for it, and its exit status, could mean anything.
        sys.exit(NO_MEMORY)


def _answer_request() -> None:
    from tltlc.interfaces.playground.protocol import RequestError, answer, gave_up_on_size

    limit_resources()
    request = sys.stdin.buffer.read()
    # An empty request means that nobody needs this process any more.
    if not request:
        return
    try:
        with confined(readable_folders()):
            answered = answer(request.decode("utf-8")).encode("utf-8")
    except (RequestError, UnicodeDecodeError):
        sys.exit(NO_REQUEST)
    sys.stdout.buffer.write(answered if len(answered) <= ANSWER.size else gave_up_on_size().encode("utf-8"))


def limit_resources() -> None:
    """Limit memory and processor time where the system can: this process may outlive the server."""
    limit("RLIMIT_AS", PLAYGROUND_CHILD.memory)
    limit("RLIMIT_CPU", PLAYGROUND_CHILD.work_s)


def readable_folders() -> list[str | os.PathLike[str]]:
    """The folders that a text may import from: the current one, and the libraries of tltlc."""
    from tltlc.resolve.imports import standard_library

    folders: list[str | os.PathLike[str]] = [standard_library()]
    # The current folder may have been deleted.
    with suppress(FileNotFoundError):
        folders.append(os.getcwd())  # noqa: PTH109
    return folders
