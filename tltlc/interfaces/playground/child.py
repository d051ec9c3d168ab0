"""The program of a child process of the server: it reads one JSON request from its input, and prints the answer.

A compilation cannot be interrupted from inside its process, so it runs in a process that the server
can end.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import Final

from tltlc.io.confinement import confine_reads
from tltlc.io.limits import ANSWER, PLAYGROUND_CHILD
from tltlc.io.resources import limit

NO_REQUEST: Final = 2
NO_MEMORY: Final = 3


def main() -> None:
    """Load the compiler, wait for a request on standard input, and print the answer.

    The exit status is 0, or :data:`NO_REQUEST` if the input is not a valid request, or
    :data:`NO_MEMORY` if memory runs out. If the input is empty, print nothing.
    """
    try:
        _answer_request()
    except MemoryError:
        # Python would exit with 1, which does not tell a MemoryError from other exceptions.
        sys.exit(NO_MEMORY)


def _answer_request() -> None:
    from tltlc.interfaces.playground.protocol import RequestError, answer, size_error_answer

    limit_resources()
    request = sys.stdin.buffer.read()
    # An empty request means that this process is no longer needed.
    if not request:
        return
    try:
        with confine_reads(readable_folders()):
            response = answer(request.decode("utf-8")).encode("utf-8")
    except (RequestError, UnicodeDecodeError):
        sys.exit(NO_REQUEST)
    sys.stdout.buffer.write(response if len(response) <= ANSWER.size else size_error_answer().encode("utf-8"))


def limit_resources() -> None:
    """Limit memory and processor time if the system can, because this process may outlive the server."""
    limit("RLIMIT_AS", PLAYGROUND_CHILD.memory)
    limit("RLIMIT_CPU", PLAYGROUND_CHILD.work_s)


def readable_folders() -> list[str | os.PathLike[str]]:
    """Return the folders from which a spec may import: the current folder and tltlc's libraries."""
    from tltlc.resolve.imports import standard_library

    folders: list[str | os.PathLike[str]] = [standard_library()]
    # The current folder may have been deleted.
    with suppress(FileNotFoundError):
        folders.append(os.getcwd())  # noqa: PTH109
    return folders
