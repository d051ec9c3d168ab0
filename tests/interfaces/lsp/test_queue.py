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
from tltlc.interfaces.lsp.server import create
from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis

ANALYSIS = DocumentAnalysis(())


class ControlledQueue:
    """A queue whose analyses run until they are ended or abandoned; ``started`` lists all that were
    started."""

    def __init__(self) -> None:
        self.queue = queue.Queue(self._analyse, self._give_up)
        self.started: list[str] = []
        self._now: asyncio.Future[DocumentAnalysis | None] | None = None

    async def open(self, *uris: str) -> None:
        for uri in uris:
            self.queue.record_look(uri)
            self.queue.put(uri)
        await run_pending_tasks()

    async def end(self, analysis: DocumentAnalysis | None = ANALYSIS) -> None:
        assert self._now is not None
        self._now.set_result(analysis)
        await run_pending_tasks()

    async def _analyse(self, uri: str, again: bool) -> DocumentAnalysis | None:
        self.started.append(uri)
        self._now = asyncio.get_running_loop().create_future()
        return await self._now

    def _give_up(self) -> None:
        if self._now is not None and not self._now.done():
            self._now.set_result(None)


async def run_pending_tasks() -> None:
    for _ in range(9):
        await asyncio.sleep(0)


def on_a_controlled_queue(
    long_s: float,
) -> Callable[[Callable[[ControlledQueue], Awaitable[None]]], Callable[[pytest.MonkeyPatch], None]]:
    """Return a decorator for tests of a controlled queue, in which an analysis gives way after ``long_s`` seconds."""

    def decorated(test: Callable[[ControlledQueue], Awaitable[None]]) -> Callable[[pytest.MonkeyPatch], None]:
        def run(monkeypatch: pytest.MonkeyPatch) -> None:
            monkeypatch.setattr(queue, "LONG_S", long_s)

            async def run_test() -> None:
                await test(ControlledQueue())

            asyncio.run(run_test())

        return run

    return decorated


NEVER, AT_ONCE = 1e6, 0.0


@on_a_controlled_queue(NEVER)
async def test_the_last_document_looked_at_is_analysed_first(controlled: ControlledQueue) -> None:
    await controlled.open("a", "b", "c", "d")
    assert controlled.started == ["d"]
    controlled.queue.record_look("b")
    for _ in range(4):
        await controlled.end()
    assert controlled.started == ["d", "b", "c", "a"]


@on_a_controlled_queue(AT_ONCE)
async def test_a_long_analysis_gives_way_and_starts_again(controlled: ControlledQueue) -> None:
    await controlled.open("large")
    await controlled.open("small")
    assert controlled.started == ["large", "small"]
    await controlled.end()
    assert controlled.started == ["large", "small", "large"]
    # A document that the user has not looked at waits for its turn.
    controlled.queue.put("other", again=True)
    await run_pending_tasks()
    assert controlled.started[3:] == []
    controlled.queue.record_look("other")
    await run_pending_tasks()
    assert controlled.started[3:] == ["other"]


@on_a_controlled_queue(NEVER)
async def test_an_analysis_gives_way_when_time_passes(controlled: ControlledQueue) -> None:
    await controlled.open("large")
    await controlled.open("small")
    assert controlled.started == ["large"]
    loop = asyncio.get_running_loop()
    later = loop.time() + 2 * NEVER
    loop.time = lambda: later  # type: ignore[method-assign]
    await run_pending_tasks()
    assert controlled.started == ["large", "small"]


@on_a_controlled_queue(AT_ONCE)
async def test_answers_wait_for_an_analysis_that_gave_way(controlled: ControlledQueue) -> None:
    answer = asyncio.ensure_future(controlled.queue.answer("large"))
    await run_pending_tasks()
    await controlled.open("small")
    await controlled.end()
    assert controlled.started == ["large", "small", "large"]
    assert not answer.done()
    await controlled.end()
    assert answer.result() is ANALYSIS


@on_a_controlled_queue(NEVER)
async def test_requests_for_dropped_documents_return_none(controlled: ControlledQueue) -> None:
    working, waiting = (asyncio.ensure_future(controlled.queue.answer(uri)) for uri in ("a", "b"))
    await run_pending_tasks()
    (first,) = controlled.started
    for uri in ("a", "b"):
        controlled.queue.drop(uri)
    await run_pending_tasks()
    assert (working.result(), waiting.result()) == (None, None)
    assert controlled.started == [first]


@on_a_controlled_queue(NEVER)
async def test_a_failed_analysis_does_not_stop_the_next(controlled: ControlledQueue) -> None:
    answer = asyncio.ensure_future(controlled.queue.answer("a"))
    await run_pending_tasks()
    assert controlled._now is not None
    controlled._now.set_exception(OSError("no more processes"))
    await run_pending_tasks()
    assert answer.result() is None
    await controlled.open("b")
    assert controlled.started == ["a", "b"]


@on_a_controlled_queue(AT_ONCE)
async def test_an_analysis_does_not_give_way_to_a_closed_document(controlled: ControlledQueue) -> None:
    server = create()
    server.queue = controlled.queue
    server.protocol.set_writer(io.BytesIO())
    await controlled.open("file:///small.tltl", "file:///large.tltl")
    document = types.TextDocumentIdentifier("file:///small.tltl")
    server.protocol.fm.features[types.TEXT_DOCUMENT_DID_CLOSE](types.DidCloseTextDocumentParams(document))
    await run_pending_tasks()
    assert controlled.started == ["file:///large.tltl"]


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
