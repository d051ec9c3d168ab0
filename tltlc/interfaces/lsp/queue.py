"""Choose the document to analyse next: the one that the user looked at last.

Long analyses give way to it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final

from tltlc.interfaces.lsp.analysis import DocumentAnalysis

LONG_S: Final = 0.5
"""Seconds after which an analysis gives way to a document that the user looked at since.

The analysis restarts afterwards. This limit is much longer than the analysis of a small file, and
than a restart of the process.
"""


class Queue:
    """Analyses documents one after another.

    ``analyse`` does the work, and ends early after ``give_up`` is called.
    """

    def __init__(
        self, analyse: Callable[[str, bool], Awaitable[DocumentAnalysis | None]], give_up: Callable[[], None]
    ) -> None:
        self._analyse = analyse
        self._give_up = give_up
        self._waiting: dict[str, bool] = {}
        """The documents to analyse, and whether to do so even if an analysis is known."""
        self._looks: dict[str, int] = {}
        """The number of the last look at each document; later looks have greater numbers."""
        self._working: str | None = None
        self._working_since = 0.0
        self._task: asyncio.Task[None] | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._asked: dict[str, list[asyncio.Future[DocumentAnalysis | None]]] = {}

    def looked_at(self, uri: str) -> None:
        """Record that the user is at a document, which is then analysed before others."""
        self._looks[uri] = max(self._looks.values(), default=0) + 1
        self._give_way()

    def put(self, uri: str, *, again: bool = False) -> None:
        """Schedule the analysis of a document; with ``again``, even if its analysis is known."""
        self._waiting[uri] = again or self._waiting.get(uri, False)
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work())
        self._give_way()

    async def answer(self, uri: str) -> DocumentAnalysis | None:
        """Return the analysis of a document, which goes first.

        Return None if it is dropped or takes too long.
        """
        future: asyncio.Future[DocumentAnalysis | None] = asyncio.get_running_loop().create_future()
        self._asked.setdefault(uri, []).append(future)
        self.looked_at(uri)
        self.put(uri)
        return await future

    def drop(self, uri: str) -> None:
        """Cancel the analysis of a document, whose text is outdated."""
        self._waiting.pop(uri, None)
        if self._working == uri:
            self._give_up()
        else:
            self._tell(uri, None)

    def clear(self) -> None:
        """Cancel all analyses."""
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
            analysis = None
            try:
                analysis = await self._analyse(uri, again)
            finally:
                self._working = None
                if uri not in self._waiting:
                    self._tell(uri, analysis)

    def _give_way(self) -> None:
        """Give up a long analysis if the user has looked at a waiting document since.

        If the analysis is not long yet, check again when it is.
        """
        if self._timer is not None:
            self._timer.cancel()
        working = self._working
        if working is None or all(self._look(uri) <= self._look(working) for uri in self._waiting):
            return
        loop, end = asyncio.get_running_loop(), self._working_since + LONG_S
        if loop.time() < end:
            self._timer = loop.call_at(end, self._give_way)
        else:
            self._waiting[working] = True
            self._give_up()

    def _tell(self, uri: str, analysis: DocumentAnalysis | None) -> None:
        for future in self._asked.pop(uri, ()):
            if not future.done():
                future.set_result(analysis)
