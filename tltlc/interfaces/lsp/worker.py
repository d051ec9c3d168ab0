"""A process for what takes long: it can be given up at any moment, in the middle of an automaton."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import threading
from contextlib import suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Final

from tltlc.interfaces.lsp.analysis import Analysis, Request
from tltlc.io.limits import COMMAND
from tltlc.io.resources import limit

LONGEST_S: Final = 60.0
"""After so many seconds an analysis is given up."""


class Worker:
    """One analysis at a time, in a process of its own that is started when it is first needed."""

    def __init__(self) -> None:
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None

    async def analyse(self, request: Request) -> Analysis | None:
        """What is to be said of a text; None where that was given up, took too long, or no process can be started."""
        pipe = None
        try:
            pipe = self._started()
            # A large text does not fit into the pipe before the process reads from it.
            answer = asyncio.get_running_loop().run_in_executor(None, _exchange, pipe, request)
            return await asyncio.wait_for(answer, LONGEST_S)
        except (EOFError, OSError, asyncio.TimeoutError):
            if pipe is self._pipe:
                self.abandon()
            return None
        except asyncio.CancelledError:
            # The server ends, and waits for the thread at the pipe.
            self.abandon()
            raise

    def abandon(self) -> None:
        """Give up what is being done; the next analysis starts a new process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
        # Whoever waits at the pipe finds it ended, and drops it.
        self._process = self._pipe = None

    def _started(self) -> Connection:
        if self._pipe is None or self._process is None or not self._process.is_alive():
            self.abandon()
            context = multiprocessing.get_context("spawn")
            ours, theirs = context.Pipe()
            process = context.Process(target=answer_all, args=(theirs,), daemon=True)
            process.start()
            theirs.close()
            self._process, self._pipe = process, ours
        return self._pipe


def _exchange(pipe: Connection, request: Request) -> Analysis | None:
    pipe.send(request)
    found: Analysis | None = pipe.recv()
    return found


def answer_all(pipe: Connection) -> None:
    """Answer requests until nobody asks any more: what the process does."""
    threading.Thread(target=_end_with_server, daemon=True).start()
    limit("RLIMIT_DATA", COMMAND.memory)
    from tltlc.interfaces.lsp.analysis import analyse

    with suppress(EOFError, KeyboardInterrupt, BrokenPipeError):
        while True:
            request = pipe.recv()
            try:
                pipe.send(analyse(request))
            except (RecursionError, MemoryError):
                pipe.send(None)


def _end_with_server() -> None:
    """End the process as soon as the server has ended, be it killed, and be it in the middle of an automaton."""
    server = multiprocessing.parent_process()
    if server is not None:
        server.join()
        os._exit(0)
