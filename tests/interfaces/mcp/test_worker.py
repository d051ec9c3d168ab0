"""The processes that answer calls."""

from __future__ import annotations

import multiprocessing
import os
from pathlib import Path

import anyio
import anyio.to_thread
import pytest

from tests.interfaces.mcp.client import SPEC
from tests.interfaces.mcp.pipes import open_for_writing, wait_until_broken
from tltlc.interfaces.mcp.answer import Answer
from tltlc.interfaces.mcp.worker import Workers


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_call_whose_process_is_killed_fails_and_the_next_call_gets_a_new_process(tmp_path: Path) -> None:
    pipe = tmp_path / "endless.tltl"
    os.mkfifo(pipe)
    before = set(multiprocessing.active_children())
    answers: list[Answer] = []

    async def calls() -> None:
        workers = Workers()

        async def ask() -> None:
            answers.append(await workers.answer("explain", {"path": str(pipe)}))

        async with anyio.create_task_group() as group:
            group.start_soon(ask)
            writing = await anyio.to_thread.run_sync(open_for_writing, pipe)
            (process,) = set(multiprocessing.active_children()) - before
            process.kill()
            await anyio.to_thread.run_sync(wait_until_broken, writing)
        answers.append(await workers.answer("check", {"text": SPEC}))
        workers.close()

    anyio.run(calls)
    failed, checked = answers
    assert failed.is_error and "the process of this call ended before it answered" in failed.text
    assert checked.document is not None and checked.document["ok"]
    assert set(multiprocessing.active_children()) == before
