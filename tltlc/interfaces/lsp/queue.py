"""Which document is analysed next: the one that the user looked at last, and what takes long gives way to it."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final

from tltlc.interfaces.lsp.analysis import Analysis

LONG_S: Final = 0.5
"""An analysis that takes so many seconds gives way to what the user has looked at since, and begins anew after it.

Far more than that of a small file takes, and than it costs to start the process again.
"""


class Queue:
    """What waits to be analysed, one after another; ``analyse`` does it, and ends early once ``give_up`` is called."""

    def __init__(self, analyse: Callable[[str, bool], Awaitable[Analysis | None]], give_up: Callable[[], None]) -> None:
        self._analyse = analyse
        self._give_up = give_up
        self._waiting: dict[str, bool] = {}
        """What is to be analysed, and whether it is although an analysis is known."""
        self._looks: dict[str, int] = {}
        """When the user looked at a document last, as the number of that look."""
        self._working: str | None = None
        self._working_since = 0.0
        self._task: asyncio.Task[None] | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._asked: dict[str, list[asyncio.Future[Analysis | None]]] = {}

    def looked_at(self, uri: str) -> None:
        """The user is at a document: what waits for it comes first."""
        self._looks[uri] = max(self._looks.values(), default=0) + 1
        self._give_way()

    def put(self, uri: str, *, again: bool = False) -> None:
        """Have a document analysed; also if its analysis is known, where that is asked for."""
        self._waiting[uri] = again or self._waiting.get(uri, False)
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work())
        self._give_way()

    async def answer(self, uri: str) -> Analysis | None:
        """What is found of a document, which comes first; None where it is dropped, or takes too long."""
        future: asyncio.Future[Analysis | None] = asyncio.get_running_loop().create_future()
        self._asked.setdefault(uri, []).append(future)
        self.looked_at(uri)
        self.put(uri)
        return await future

    def drop(self, uri: str) -> None:
        """Nothing is to be found of a document as it was."""
        self._waiting.pop(uri, None)
        if self._working == uri:
            self._give_up()
        else:
            self._tell(uri, None)

    def clear(self) -> None:
        """Nothing is to be found of anything."""
        for uri in [*self._waiting]:
            self.drop(uri)
        self._give_up()

    def _look(self, uri: str) -> int:
        return self._looks.get(uri, 0)

    async def _work(self) -> None:
        while self._waiting:
            uri = max(self._waiting, key=self._look)
            again = self._waiting.pop(uri)
            self._working, self._working_since = uri, asyncio.get_running_loop().time()
            found = None
            try:
                found = await self._analyse(uri, again)
            finally:
                self._working = None
                if uri not in self._waiting:
                    self._tell(uri, found)

    def _give_way(self) -> None:
        """Give up what is being done, once it has had its time, if the user has looked at what waits since."""
        if self._timer is not None:
            self._timer.cancel()
        working = self._working
        if working is None or all(self._look(each) <= self._look(working) for each in self._waiting):
            return
        loop, end = asyncio.get_running_loop(), self._working_since + LONG_S
        if loop.time() < end:
            self._timer = loop.call_at(end, self._give_way)
        else:
            self._waiting[working] = True
            self._give_up()

    def _tell(self, uri: str, found: Analysis | None) -> None:
        for future in self._asked.pop(uri, ()):
            if not future.done():
                future.set_result(found)
