"""The tool ``regress``: recorded sessions of two builds, its progress, and its end."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path

import anyio
import anyio.to_thread
import pytest

from tests.interfaces.mcp.client import ENVIRONMENT, connected, text
from tests.interfaces.mcp.pipes import open_for_writing, wait_until_broken
from tests.runtime.regression.test_trace_cases import BURNT, SHORT, SPEC, WON, write_traces
from tltlc.interfaces.mcp.tools.regress import command_words


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a spec, and with traces of an old build and of a new one in which the lava burns players."""
    (tmp_path / "fetch.tltl").write_text(SPEC, encoding="utf-8")
    write_traces(tmp_path / "old", (95, WON), (5, SHORT))
    write_traces(tmp_path / "new", (30, WON), (65, BURNT), (5, SHORT))
    return tmp_path


def test_recorded_sessions_of_two_builds_are_compared(folder: Path) -> None:
    async def session() -> None:
        async with connected(folder) as agent:
            lines: list[str | None] = []

            async def on_progress(progress: float, total: float | None, message: str | None) -> None:
                lines.append(message)

            arguments = {"spec": "fetch.tltl", "baseline": "old", "now": "new", "output": "out"}
            result = await agent.client.call_tool("regress", arguments, progress_callback=on_progress)
            assert not result.is_error
            document = result.structured_content
            assert document["report"]["verdicts"] == {"pass": 0, "review": 0, "fail": 1}
            (case,) = document["report"]["cases"]
            assert case["verdict"] == "fail"
            assert "avoid on_lava" in text(result)
            assert lines and set(lines) <= set(document["messages"])

            # A build that plays as before passes.
            document = await agent.document("regress", spec="fetch.tltl", baseline="old", now="old", output="out")
            assert document["report"]["verdicts"]["pass"] == 1

    anyio.run(session)
    # It writes into the folder that was named, and nothing else.
    assert {path.name for path in folder.iterdir()} == {"fetch.tltl", "old", "new", "out"}


def test_mistakes_of_the_caller_are_told_plainly(folder: Path) -> None:
    async def session() -> None:
        async with connected(folder) as agent:
            assert "cannot read `nowhere.toml`" in await agent.refusal("regress", suite="nowhere.toml")
            assert "--now" in await agent.refusal("regress", spec="fetch.tltl", baseline="old")
            # A value is never taken for an option.
            assert "`--html=page.html`" in await agent.refusal("regress", suite="--html=page.html")
            assert "no `--help`" in await agent.refusal("regress", spec="fetch.tltl", baseline="--help", now="new")

    anyio.run(session)
    assert {path.name for path in folder.iterdir()} == {"fetch.tltl", "old", "new"}


def test_each_argument_becomes_an_option() -> None:
    arguments = {
        "suite": "-s.toml", "changed": ["a", "--b"], "fresh": True, "retrain": False, "judged_as": "traces",
        "output": "-o",
    }  # fmt: skip
    assert command_words(arguments) == [
        "--fresh", "--judged-as=traces", "--out=-o", "--changed=a", "--changed=--b", "--", "-s.toml",
    ]  # fmt: skip


def test_a_missing_extra_is_named(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The server starts the command with its own module search path, which here hides numpy."""
    (folder / "hidden" / "numpy").mkdir(parents=True)
    (folder / "hidden" / "numpy" / "__init__.py").write_text("raise ModuleNotFoundError(name='numpy')\n")
    path = os.pathsep.join([str(folder / "hidden"), ENVIRONMENT["PYTHONPATH"]])
    monkeypatch.setitem(ENVIRONMENT, "PYTHONPATH", path)

    async def session() -> None:
        async with connected(folder) as agent:
            refusal = await agent.refusal("regress", spec="fetch.tltl", baseline="old", now="new")
            assert "`tltlc regress` needs `numpy`, which is not installed" in refusal
            assert "pip install" in refusal and "'.[game]'" in refusal
            assert (await agent.document("check", path="fetch.tltl"))["ok"]

    anyio.run(session)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_cancelled_run_ends_with_its_processes(folder: Path) -> None:
    """The command reads a trace from a pipe that nothing is written to, so only the cancelling ends it."""
    pipe = folder / "endless.csv"
    os.mkfifo(pipe)

    async def session() -> None:
        async with connected(folder) as agent:
            call = partial(agent.call, "regress", spec="fetch.tltl", baseline="old", now=pipe.name)
            async with anyio.create_task_group() as group:
                group.start_soon(call)
                writing = await anyio.to_thread.run_sync(open_for_writing, pipe)
                group.cancel_scope.cancel()
            await anyio.to_thread.run_sync(wait_until_broken, writing)
            assert (await agent.document("check", path="fetch.tltl"))["ok"]

    anyio.run(session)
