"""The order in which documents are analysed, independent of real time."""

from __future__ import annotations

import asyncio
import io
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from lsprotocol import types

from tests.interfaces.lsp.client import Client
from tests.interfaces.lsp.test_server import codes
from tests.interfaces.lsp.texts import ENDLESS
from tltlc.interfaces.lsp import queue
from tltlc.interfaces.lsp.analysis import DocumentAnalysis
from tltlc.interfaces.lsp.server import create

FOUND = DocumentAnalysis(())


class Desk:
    """A queue whose analyses run until they are ended or abandoned; ``begun`` lists all that were
    started."""

    def __init__(self) -> None:
        self.queue = queue.Queue(self._analyse, self._give_up)
        self.begun: list[str] = []
        self._now: asyncio.Future[DocumentAnalysis | None] | None = None

    async def open(self, *uris: str) -> None:
        for uri in uris:
            self.queue.looked_at(uri)
            self.queue.put(uri)
        await settled()

    async def end(self, found: DocumentAnalysis | None = FOUND) -> None:
        assert self._now is not None
        self._now.set_result(found)
        await settled()

    async def _analyse(self, uri: str, again: bool) -> DocumentAnalysis | None:
        self.begun.append(uri)
        self._now = asyncio.get_running_loop().create_future()
        return await self._now

    def _give_up(self) -> None:
        if self._now is not None and not self._now.done():
            self._now.set_result(None)


async def settled() -> None:
    for _ in range(9):
        await asyncio.sleep(0)


def on_a_desk(long_s: float) -> Callable[[Callable[[Desk], Awaitable[None]]], Callable[[pytest.MonkeyPatch], None]]:
    """A decorator for a test of a desk on which an analysis gives way after ``long_s`` seconds."""

    def decorated(test: Callable[[Desk], Awaitable[None]]) -> Callable[[pytest.MonkeyPatch], None]:
        def run(monkeypatch: pytest.MonkeyPatch) -> None:
            monkeypatch.setattr(queue, "LONG_S", long_s)

            async def go() -> None:
                await test(Desk())

            asyncio.run(go())

        return run

    return decorated


NEVER, AT_ONCE = 1e6, 0.0


@on_a_desk(NEVER)
async def test_the_last_document_looked_at_is_analysed_first(desk: Desk) -> None:
    await desk.open("a", "b", "c", "d")
    assert desk.begun == ["d"]
    desk.queue.looked_at("b")
    for _ in range(4):
        await desk.end()
    assert desk.begun == ["d", "b", "c", "a"]


@on_a_desk(AT_ONCE)
async def test_a_long_analysis_gives_way_and_starts_again(desk: Desk) -> None:
    await desk.open("large")
    await desk.open("small")
    assert desk.begun == ["large", "small"]
    await desk.end()
    assert desk.begun == ["large", "small", "large"]
    # A document that the user has not looked at waits for its turn.
    desk.queue.put("other", again=True)
    await settled()
    assert desk.begun[3:] == []
    desk.queue.looked_at("other")
    await settled()
    assert desk.begun[3:] == ["other"]


@on_a_desk(NEVER)
async def test_an_analysis_gives_way_when_time_passes(desk: Desk) -> None:
    await desk.open("large")
    await desk.open("small")
    assert desk.begun == ["large"]
    loop = asyncio.get_running_loop()
    later = loop.time() + 2 * NEVER
    loop.time = lambda: later  # type: ignore[method-assign]
    await settled()
    assert desk.begun == ["large", "small"]


@on_a_desk(AT_ONCE)
async def test_answers_wait_for_an_analysis_that_gave_way(desk: Desk) -> None:
    answer = asyncio.ensure_future(desk.queue.answer("large"))
    await settled()
    await desk.open("small")
    await desk.end()
    assert desk.begun == ["large", "small", "large"]
    assert not answer.done()
    await desk.end()
    assert answer.result() is FOUND


@on_a_desk(NEVER)
async def test_dropped_documents_are_answered_with_none(desk: Desk) -> None:
    working, waiting = (asyncio.ensure_future(desk.queue.answer(uri)) for uri in ("a", "b"))
    await settled()
    (first,) = desk.begun
    for uri in ("a", "b"):
        desk.queue.drop(uri)
    await settled()
    assert (working.result(), waiting.result()) == (None, None)
    assert desk.begun == [first]


@on_a_desk(NEVER)
async def test_a_failed_analysis_does_not_stop_the_next(desk: Desk) -> None:
    answer = asyncio.ensure_future(desk.queue.answer("a"))
    await settled()
    assert desk._now is not None
    desk._now.set_exception(OSError("no more processes"))
    await settled()
    assert answer.result() is None
    await desk.open("b")
    assert desk.begun == ["a", "b"]


@on_a_desk(AT_ONCE)
async def test_no_analysis_gives_way_to_a_closed_document(desk: Desk) -> None:
    server = create()
    server.queue = desk.queue
    server.protocol.set_writer(io.BytesIO())
    await desk.open("file:///small.tltl", "file:///large.tltl")
    document = types.TextDocumentIdentifier("file:///small.tltl")
    server.protocol.fm.features[types.TEXT_DOCUMENT_DID_CLOSE](types.DidCloseTextDocumentParams(document))
    await settled()
    assert desk.begun == ["file:///large.tltl"]


def test_a_small_file_does_not_wait_for_a_large_one(client: Client, tmp_path: Path) -> None:
    """Both are opened together. The analysis of the large file never ends."""
    slow = client.open(tmp_path / "slow.tltl", ENDLESS)
    small = client.open(tmp_path / "small.tltl", "signal a: bool\nspec s = G (a or not a)\n")
    assert codes(client.diagnostics(small, bool)) == ["TLT0411"]
    client.ask("textDocument/hover", {"textDocument": {"uri": slow}, "position": {"line": 0, "character": 0}})
    other = client.open(tmp_path / "other.tltl", "signal b: bool\nspec t = G (b or not b)\n")
    assert codes(client.diagnostics(other, bool)) == ["TLT0411"]


def test_tests_run_on_demand_beside_a_long_analysis(client: Client, tmp_path: Path) -> None:
    client.open(tmp_path / "slow.tltl", ENDLESS)
    small = client.open(
        tmp_path / "small.tltl", 'signal a: bool\nspec s = F a\ntest "t" for s { step a  expect satisfied }\n'
    )
    for spec, text in (("s", "s: 1 test passes"), ("t", "there is no spec `t`, so there are no tests to run")):
        client.ask("workspace/executeCommand", {"command": "tltlc.runTests", "arguments": [small, spec]})
        assert client.message("window/showMessage")["message"] == text
