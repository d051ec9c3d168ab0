"""The analysis process on a machine that cannot start another process."""

from __future__ import annotations

import asyncio
import multiprocessing

import pytest

from tltlc.core.source import SourceFile
from tltlc.interfaces.lsp.slow_analysis import Request
from tltlc.interfaces.lsp.worker import AnalysisWorker


def test_the_next_analysis_retries_after_a_failed_start(monkeypatch: pytest.MonkeyPatch) -> None:
    request = Request(SourceFile("a.tltl", "signal a: bool\nspec x = F a\n"), (), {}, {})
    context = multiprocessing.get_context("spawn")
    failing = iter([OSError(11, "Resource temporarily unavailable")])
    start = context.Process.start

    def failing_start(process: multiprocessing.context.SpawnProcess) -> None:
        for error in failing:
            raise error
        start(process)

    monkeypatch.setattr(context.Process, "start", failing_start)

    async def analyses() -> list[object]:
        worker = AnalysisWorker()
        try:
            return [await worker.analyse(request) for _ in range(2)]
        finally:
            worker.abandon()

    first, second = asyncio.run(analyses())
    assert first is None and second is not None
