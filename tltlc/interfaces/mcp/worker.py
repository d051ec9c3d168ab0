"""Answer calls in processes of their own, which can be killed while they compile a spec."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Mapping
from contextlib import suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, Final

import anyio
import anyio.to_thread

from tltlc.interfaces.mcp.answer import Answer
from tltlc.io.limits import ProcessLimit
from tltlc.io.parent_process import end_with_parent
from tltlc.io.resources import permit, permitted

MOST_AT_ONCE: Final = min(4, os.cpu_count() or 1)
"""The most calls that are answered at the same time; further calls wait."""


class Workers:
    """Answers calls of tools in worker processes, which start when they are first needed."""

    def __init__(self) -> None:
        self._limiter = anyio.CapacityLimiter(MOST_AT_ONCE)
        self._idle: list[_Worker] = []
        self._running: set[_Worker] = set()

    async def answer(self, name: str, arguments: Mapping[str, Any]) -> Answer:
        """Return the answer of the tool ``name``. If the call is cancelled, its process is killed."""
        async with self._limiter:
            worker = self._idle.pop() if self._idle else _Worker(permitted())
            self._running.add(worker)
            answer = None
            try:
                answer = await anyio.to_thread.run_sync(worker.exchange, name, arguments, abandon_on_cancel=True)
            finally:
                self._running.discard(worker)
                if answer is None:
                    worker.kill()
                else:
                    self._idle.append(worker)
            return answer or Answer(
                "the process of this call ended before it answered; memory may be short, and then a smaller spec helps",
                is_error=True,
            )

    def close(self) -> None:
        """Kill all worker processes."""
        for worker in (*self._idle, *self._running):
            worker.kill()
        self._idle.clear()


class _Worker:
    """A worker process, and the pipe to it."""

    def __init__(self, limit: ProcessLimit | None) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process: BaseProcess = context.Process(target=answer_all, args=(theirs, limit), daemon=True)
        self._process.start()
        theirs.close()

    def exchange(self, name: str, arguments: Mapping[str, Any]) -> Answer | None:
        """Send a call to the process, and return the answer; None if the process ends before."""
        with suppress(EOFError, OSError):
            self._pipe.send((name, dict(arguments)))
            answer: Answer = self._pipe.recv()
            return answer
        return None

    def kill(self) -> None:
        """Kill the process, and wait for its end. A thread that reads from the pipe then sees its end."""
        self._process.kill()
        self._process.join()


def answer_all(pipe: Connection, limit: ProcessLimit | None) -> None:
    """Answer the calls that arrive through ``pipe`` until it closes: the main function of a worker process."""
    end_with_parent()
    if limit is not None:
        permit(limit)
    from tltlc.interfaces.mcp.calls import answer_call

    with suppress(EOFError, KeyboardInterrupt, BrokenPipeError):
        while True:
            name, arguments = pipe.recv()
            pipe.send(answer_call(name, arguments))
