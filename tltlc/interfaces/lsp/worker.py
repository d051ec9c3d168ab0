"""Run slow analyses in a process of their own, which can be killed while it builds an automaton."""

from __future__ import annotations

import asyncio
import multiprocessing
from contextlib import suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Final

from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis, Request
from tltlc.io.limits import COMMAND
from tltlc.io.parent_process import end_with_parent
from tltlc.io.resources import limit

LONGEST_S: Final = 60.0
"""Seconds after which an analysis is stopped."""


class AnalysisWorker:
    """Runs one analysis at a time, in a process of its own that starts when it is first needed."""

    def __init__(self) -> None:
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None

    async def analyse(self, request: Request) -> DocumentAnalysis | None:
        """Analyse a text in the worker process, and return the analysis.

        Return None if the analysis is abandoned, takes longer than :data:`LONGEST_S` or needs too
        much memory, or if no process can be started.
        """
        pipe = None
        try:
            pipe = self._connection()
            # A large text blocks the sender until the process reads from the pipe, so send it in a thread.
            answer = asyncio.get_running_loop().run_in_executor(None, _exchange, pipe, request)
            return await asyncio.wait_for(answer, LONGEST_S)
        except (EOFError, OSError, asyncio.TimeoutError):
            if pipe is self._pipe:
                self.abandon()
            return None
        except asyncio.CancelledError:
            # The server is ending, and will wait for the thread that reads from the pipe. So end the process.
            self.abandon()
            raise

    def abandon(self) -> None:
        """Kill the process that runs the current analysis; the next analysis starts a new process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
        # The thread that reads from the old pipe sees its end, and then releases the pipe.
        self._process = self._pipe = None

    def _connection(self) -> Connection:
        """Return the pipe to the worker process; start this process first if it is not running."""
        if self._pipe is None or self._process is None or not self._process.is_alive():
            self.abandon()
            context = multiprocessing.get_context("spawn")
            ours, theirs = context.Pipe()
            process = context.Process(target=answer_all, args=(theirs,), daemon=True)
            process.start()
            theirs.close()
            self._process, self._pipe = process, ours
        return self._pipe


def _exchange(pipe: Connection, request: Request) -> DocumentAnalysis | None:
    pipe.send(request)
    analysis: DocumentAnalysis | None = pipe.recv()
    return analysis


def answer_all(pipe: Connection) -> None:
    """Analyse the texts that arrive through ``pipe``, and send back the results, until the pipe closes.

    The result is None if an analysis needs too much memory or nests too deep. This is the main
    function of the worker process.
    """
    end_with_parent()
    limit("RLIMIT_DATA", COMMAND.memory)
    from tltlc.interfaces.lsp.slow_analysis import analyse

    with suppress(EOFError, KeyboardInterrupt, BrokenPipeError):
        while True:
            request = pipe.recv()
            try:
                pipe.send(analyse(request))
            except (RecursionError, MemoryError):
                pipe.send(None)
