"""Wrong arguments, missing files, huge texts, calls at the same time, and calls that are cancelled."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

import anyio
import anyio.to_thread
import pytest
from mcp import MCPError

from tests.interfaces.mcp.client import COMMAND, ENVIRONMENT, SPEC, connected
from tests.interfaces.mcp.pipes import open_for_writing, wait_until_broken
from tests.waiting import HANG_S
from tltlc.interfaces.mcp.worker import MOST_AT_ONCE

WRONG: list[tuple[str, Mapping[str, Any], str]] = [
    ("explain", {}, "give `path`, the path of a .tltl file, or `text`, the source text itself"),
    ("explain", {"text": 3}, "`text` must be a text"),
    ("explain", {"text": None}, "`text` must be a text"),
    ("explain", {"txet": SPEC}, "the call has no argument `txet`; it has `path`, `text`, "),
    ("explain", {"text": SPEC, "spec": "leaf"}, "did you mean `leave`?"),
    ("explain", {"path": "nowhere.tltl"}, "cannot read `nowhere.tltl`: there is no such file"),
    ("explain", {"path": "a\0b"}, "`path` has a character that the name of a file cannot have"),
    ("check", {"path": "\0"}, "`path` has a character that the name of a file cannot have"),
    ("check", {"text": SPEC, "libraries": ["a", "\0"]}, "`libraries.1` has a character"),
    ("diff", {"a": {"path": "a.tltl", "revision": "\0"}, "b": {"text": SPEC}}, "`a.revision` has a character"),
    ("monitor", {"text": SPEC, "traces": ["\0"]}, "`traces.0` has a character"),
    ("monitor", {"text": SPEC, "rows": [{}], "from_step": 10**19}, "`from_step` must be at most 1000000000000"),
    ("monitor", {"text": SPEC, "rows": [{}], "to_step": 10**19}, "`to_step` must be at most 1000000000000"),
    ("regress", {"suite": "a\0"}, "`suite` has a character"),
    ("regress", {"suite": "a", "changed": ["\0"]}, "`changed.0` has a character"),
    ("regress", {"spec": "a", "baseline": "\0", "now": "b"}, "`baseline` has a character"),
    ("explain", {"path": "x" * 5000}, "error[TLT0001]"),
    ("explain", {"path": "."}, "`.` is a folder: name a .tltl file in it"),
    ("explain", {"path": "-"}, "there is no standard input here"),
    ("explain", {"path": "game.toml"}, "`game.toml` is not a spec"),
    ("explain", {"path": "a.tltl:one", "text": SPEC, "spec": "two"}, "`path` names the spec `one`"),
    ("explain", {"code": "TLT9999"}, "there is no code `TLT9999`: did you mean "),
    ("explain", {"text": SPEC, "format": "html"}, "`format` must be one of `text`, `markdown`"),
    ("check", {"path": "."}, "there is no .tltl file in `.`: name another folder"),
    ("check", {"path": "a.tltl:leave", "text": SPEC}, "`check` checks all specs of a file"),
    ("check", {"text": SPEC, "libraries": "here"}, "`libraries` must be a list"),
    ("check", {"text": SPEC, "libraries": ["nowhere"]}, "there is no library folder `nowhere`"),
    ("check", {"text": SPEC, "params": {"most": [1]}}, "`params.most` must be a text or a number or true or false"),
    ("check", {"text": SPEC, "state_budget": 0}, "`state_budget` must be at least 1"),
    ("check", {"text": SPEC, "state_budget": 1.5}, "`state_budget` must be a whole number"),
    ("witness", {"text": SPEC, "kinds": []}, "`kinds` must not be empty"),
    ("witness", {"text": SPEC, "kinds": ["any"]}, "`kinds.0` must be one of `accepting`, `rejecting`, `cover`"),
    ("monitor", {"text": SPEC}, "give the trace in one of these: `traces` (paths), `trace_text`"),
    ("monitor", {"text": SPEC, "rows": [], "trace_text": ""}, "give the trace in one of these"),
    ("monitor", {"text": SPEC, "rows": ["step"]}, "`rows.0` must be an object"),
    ("monitor", {"text": SPEC, "traces": ["nowhere.csv"]}, "nowhere.csv"),
    ("monitor", {"text": SPEC + "spec other = F seen\n", "rows": [{}]}, "contains 2 specs"),
    ("diff", {"a": {"text": SPEC}}, "the call needs the argument `b`"),
    ("diff", {"a": {"text": SPEC}, "b": SPEC}, "`b` must be an object"),
    ("diff", {"a": {"text": SPEC}, "b": {}}, "give `path`, the path of a .tltl file"),
    ("diff", {"a": {"text": SPEC, "revision": "HEAD"}, "b": {"text": SPEC}}, "`revision` needs `path`"),
    ("regress", {}, "give `suite`, a TOML file, or `spec` with `baseline` and `now`"),
    ("regress", {"suite": "suite.toml", "workers": "two"}, "`workers` must be a whole number"),
]


def test_wrong_arguments_are_answered_with_a_plain_message(tmp_path: Path) -> None:
    async def session() -> None:
        async with connected(tmp_path) as agent:
            for name, arguments, message in WRONG:
                refusal = await agent.refusal(name, **arguments)
                assert message in refusal, (name, refusal)
                assert "Traceback" not in refusal and "a bug" not in refusal
            with pytest.raises(MCPError, match="there is no tool `compile`; there are `check`"):
                await agent.call("compile")

    anyio.run(session)
    assert not list(tmp_path.iterdir())


def test_errors_in_a_spec_are_results(tmp_path: Path) -> None:
    async def session() -> None:
        async with connected(tmp_path) as agent:
            for name, arguments in (
                ("check", {}),
                ("explain", {}),
                ("witness", {}),
                ("test", {}),
                ("monitor", {"rows": [{"seen": True}]}),
            ):
                document = await agent.document(name, text="spec leave { reach }", **arguments)
                assert any(diagnostic["severity"] == "error" for diagnostic in document["diagnostics"])
            document = await agent.document("diff", a={"text": SPEC}, b={"text": "spec"})
            assert document["diff"] is None and document["diagnostics"]
            # A trace that does not fit the spec is a result, too.
            document = await agent.document("monitor", text=SPEC, rows=[{"seen": "perhaps"}])
            assert document["unread"] == 1
            assert document["traces"][0]["diagnostics"][0]["severity"] == "error"

    anyio.run(session)


def test_huge_and_odd_texts(tmp_path: Path) -> None:
    rows = [{"distance": 9.0, "has_key": False, "seen": False}] * 20_000

    async def session() -> None:
        async with connected(tmp_path) as agent:
            document = await agent.document("check", text="signal a: bool\n" * 500_000)
            assert [diagnostic["code"] for diagnostic in document["diagnostics"]] == ["TLT0004"]
            document = await agent.document("check", text="spec \N{SNOWMAN} {\0}\r\n\t\N{BYTE ORDER MARK}")
            assert not document["ok"]
            # Very many errors are counted, not listed.
            many = "".join(f"spec s{number} = F a{number}\n" for number in range(1000))
            document = await agent.document("check", text=many)
            assert len(document["diagnostics"]) == 100 and document["left_out"] > 0
            document = await agent.document("monitor", text=SPEC, rows=rows, from_step=1)
            assert document["traces"][0]["samples"] == len(rows)
            assert len(document["rows"]) == 200
            # The automaton would be too large.
            document = await agent.document("explain", text=SPEC, state_budget=2)
            assert [diagnostic["code"] for diagnostic in document["diagnostics"]] == ["TLT0501"]

    anyio.run(session)


def test_calls_at_the_same_time_get_their_own_answers(tmp_path: Path) -> None:
    async def session() -> None:
        async with connected(tmp_path) as agent:

            async def ask(number: int) -> None:
                text = f"signal a{number}: bool\nspec s{number} = F a{number}\n"
                document = await agent.document("explain", text=text)
                assert [spec["name"] for spec in document["specs"]] == [f"s{number}"]

            async with anyio.create_task_group() as group:
                for number in range(3 * MOST_AT_ONCE):
                    group.start_soon(ask, number)

    anyio.run(session)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_cancelled_call_ends_its_process(tmp_path: Path) -> None:
    """The worker reads from a pipe that nothing is written to, so only the cancelling ends the call."""
    pipe = tmp_path / "endless.tltl"
    os.mkfifo(pipe)

    async def session() -> None:
        async with connected(tmp_path) as agent:
            for _ in range(2 * MOST_AT_ONCE):
                async with anyio.create_task_group() as group:
                    group.start_soon(partial(agent.call, "explain", path=pipe.name))
                    writing = await anyio.to_thread.run_sync(open_for_writing, pipe)
                    group.cancel_scope.cancel()
                # The pipe breaks when the process that reads from it has ended.
                await anyio.to_thread.run_sync(wait_until_broken, writing)
            # All workers are free again.
            assert (await agent.document("check", text=SPEC))["ok"]

    anyio.run(session)


def test_malformed_messages_do_not_end_the_server(tmp_path: Path) -> None:
    """Only the protocol is written to standard output."""
    initialize = {
        "protocolVersion": "2025-06-18",
        "capabilities": {},
        "clientInfo": {"name": "test", "version": "1"},
    }
    messages: list[Any] = [
        {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": initialize},
        {"jsonrpc": "2.0", "method": "notifications/initialized"},
        {"jsonrpc": "2.0", "id": 2, "method": "tools/call", "params": {"name": "check", "arguments": "text"}},
        {"jsonrpc": "2.0", "id": 3, "method": "tools/call", "params": {"name": ["check"]}},
        {"jsonrpc": "2.0", "id": 4, "method": "tools/call"},
        {"jsonrpc": "2.0", "id": 5, "method": "nothing/like/this", "params": {}},
        {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 99}},
        {"jsonrpc": "2.0", "id": "6", "method": "tools/call", "params": {"name": "check", "arguments": {"text": SPEC}}},
    ]
    lines = [json.dumps(message) for message in messages]
    lines[2:2] = ["", "{", "[]", "null", '{"jsonrpc": "1.0"}', "\x00\xff", "9" * 100_000]
    with subprocess.Popen(
        COMMAND,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        cwd=tmp_path,
        env={**os.environ, **ENVIRONMENT},
        encoding="utf-8",
    ) as process:
        assert process.stdin and process.stdout and process.stderr
        process.stdin.write("".join(f"{line}\n" for line in lines))
        process.stdin.flush()
        answers: dict[Any, Any] = {}
        while "6" not in answers:
            answer = json.loads(process.stdout.readline())
            answers[answer.get("id")] = answer
        process.stdin.close()
        assert process.stdout.read() == ""
        assert process.stderr.read() == ""
        assert process.wait(HANG_S) == 0
    assert answers["6"]["result"]["structuredContent"]["ok"]
    assert all("error" in answers[number] for number in (2, 3, 4, 5))
