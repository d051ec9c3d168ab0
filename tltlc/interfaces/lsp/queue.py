"""Choose the document to analyse next: the one that the user looked at last.

If the analysis of another document takes long, it is stopped, and repeated afterwards.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Final

from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis

LONG_S: Final = 0.5
"""Seconds after which an analysis may be stopped for a document that the user looked at later.

The analysis of a small file takes much less time. To start the process again also takes less.
"""


class Queue:
    """Analyses documents one after another; the document that the user looked at last comes first.

    The caller passes two functions. ``analyse(uri, again)`` analyses a document; if ``again`` is
    false, it may return an earlier analysis of the same text. ``give_up()`` stops the current
    analysis: ``analyse`` then returns None soon.
    """

    def __init__(
        self, analyse: Callable[[str, bool], Awaitable[DocumentAnalysis | None]], give_up: Callable[[], None]
    ) -> None:
        self._analyse = analyse
        self._give_up = give_up
        self._waiting: dict[str, bool] = {}
        """The URIs of the documents to analyse. The value says whether to do so even if the analysis is known."""
        self._looks: dict[str, int] = {}
        """When the user last looked at each document, by URI. A greater number means a later look."""
        self._current: str | None = None
        self._current_since = 0.0
        self._task: asyncio.Task[None] | None = None
        self._timer: asyncio.TimerHandle | None = None
        self._answers: dict[str, list[asyncio.Future[DocumentAnalysis | None]]] = {}

    def record_look(self, uri: str) -> None:
        """Record that the user looks at a document, which is then analysed before others."""
        self._looks[uri] = max(self._looks.values(), default=0) + 1
        self._give_way()

    def put(self, uri: str, *, again: bool = False) -> None:
        """Schedule the analysis of a document; with ``again``, even if its text was analysed before."""
        self._waiting[uri] = again or self._waiting.get(uri, False)
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work())
        self._give_way()

    async def answer(self, uri: str) -> DocumentAnalysis | None:
        """Analyse a document before all others, and return the analysis.

        Return None if :meth:`drop` cancels the analysis, if it takes too long, or if the document
        has errors.
        """
        future: asyncio.Future[DocumentAnalysis | None] = asyncio.get_running_loop().create_future()
        self._answers.setdefault(uri, []).append(future)
        self.record_look(uri)
        self.put(uri)
        return await future

    def drop(self, uri: str) -> None:
        """Cancel the analysis of a document that has changed or was closed; :meth:`answer` then returns None for it."""
        self._waiting.pop(uri, None)
        if self._current == uri:
            self._give_up()
        else:
            self._set_answer(uri, None)

    def clear(self) -> None:
        """Cancel all analyses, the waiting ones and the current one."""
        for uri in [*self._waiting]:
            self.drop(uri)
        self._give_up()

    def _last_look(self, uri: str) -> int:
        return self._looks.get(uri, 0)

    async def _work(self) -> None:
        while self._waiting:
            uri = max(self._waiting, key=self._last_look)
            again = self._waiting.pop(uri)
            self._current, self._current_since = uri, asyncio.get_running_loop().time()
            analysis = None
            try:
                analysis = await self._analyse(uri, again)
            finally:
                self._current = None
                if uri not in self._waiting:
                    self._set_answer(uri, analysis)

    def _give_way(self) -> None:
        """Stop a long analysis if the user has since looked at another document in the queue.

        If the analysis has taken less than :data:`LONG_S` so far, check again after that time.
        """
        if self._timer is not None:
            self._timer.cancel()
        current = self._current
        if current is None or all(self._last_look(uri) <= self._last_look(current) for uri in self._waiting):
            return
        loop, end = asyncio.get_running_loop(), self._current_since + LONG_S
        if loop.time() < end:
            self._timer = loop.call_at(end, self._give_way)
        else:
            self._waiting[current] = True
            self._give_up()

    def _set_answer(self, uri: str, analysis: DocumentAnalysis | None) -> None:
        for future in self._answers.pop(uri, ()):
            if not future.done():
                future.set_result(analysis)
