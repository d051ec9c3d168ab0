"""The process that analyses, where the machine has none to give."""

from __future__ import annotations

import asyncio
import multiprocessing

import pytest

from tltlc.core.source import SourceFile
from tltlc.interfaces.lsp.analysis import Request
from tltlc.interfaces.lsp.worker import Worker


def test_where_no_process_can_be_started_the_next_analysis_tries_again(monkeypatch: pytest.MonkeyPatch) -> None:
    request = Request(SourceFile("a.tltl", "signal a: bool\nspec x = F a\n"), (), {}, {})
    context = multiprocessing.get_context("spawn")
    failing = iter([OSError(11, "Resource temporarily unavailable")])
    start = context.Process.start

    def started(process: multiprocessing.context.SpawnProcess) -> None:
        for error in failing:
            raise error
        start(process)

    monkeypatch.setattr(context.Process, "start", started)

    async def analyses() -> list[object]:
        worker = Worker()
        try:
            return [await worker.analyse(request) for _ in range(2)]
        finally:
            worker.abandon()

    none, found = asyncio.run(analyses())
    assert none is None and found is not None
