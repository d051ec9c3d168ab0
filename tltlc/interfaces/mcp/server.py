"""Run the server, and answer the requests of the agent."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
from collections.abc import Iterator
from typing import Any, Final

import anyio
from mcp import types
from mcp.server.context import ServerRequestContext
from mcp.server.lowlevel import Server
from mcp.server.stdio import stdio_server
from mcp.shared.exceptions import MCPError

from tltlc import __version__
from tltlc.interfaces.mcp.answer import Answer
from tltlc.interfaces.mcp.calls import argument_problem, failure
from tltlc.interfaces.mcp.tool import Tool
from tltlc.interfaces.mcp.tools import regress, tools
from tltlc.interfaces.mcp.worker import Workers

CLOSED_PIPE: Final = 141
"""The exit status if the agent stops reading: 128 plus the number of SIGPIPE."""

INSTRUCTIONS: Final = """\
tltlc judges how games play. A spec (.tltl) has the rules of a level: what the player must do, and what must not happen.

  clock 10 Hz                                       // steps per second
  signal distance_to_exit: length in [0 m, 100 m]   // what the game measures at each step
  signal has_key: bool
  signal seen: bool
  let at_exit = distance_to_exit < 2 m              // true or false at each step

  spec leave {
    limit 60 s
    reach has_key then at_exit    // in this order
    avoid seen                    // must never become true
  }

  test "being seen is the end" for leave {
    step has_key
    step seen
    expect violated
  }

After each change of a spec, call `check`, and apply a fix if it says what you mean. Then call `explain`, and compare
what the spec asks for with what was intended; `witness` shows a shortest trace that succeeds and one that fails.
`monitor` judges recorded play, `diff` compares two versions, `test` runs the `test` blocks of a file, and `regress`
reports which levels of a game still play as designed. Paths are relative to the folder in which the server runs.
"""


def serve() -> int:
    """Serve an agent over standard input and output until it closes the connection; return the exit status."""
    logging.getLogger("mcp").setLevel(logging.CRITICAL)
    if sys.stdin is None:
        # The caller closed standard input; the command line has opened the null device in its place.
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    try:
        anyio.run(_serve)
    except Exception as error:
        if not any(isinstance(cause, (BrokenPipeError, ConnectionResetError)) for cause in _causes(error)):
            raise
        return CLOSED_PIPE
    return 0


async def _serve() -> None:
    _end_on_signals()
    workers = Workers()
    server = create(workers)
    try:
        async with stdio_server() as (reading, writing):
            await server.run(reading, writing, server.create_initialization_options())
    finally:
        workers.close()


def create(workers: Workers) -> Server[Any]:
    """Return the server, with its handlers; ``workers`` answers the calls of most tools."""

    async def list_tools(
        context: ServerRequestContext[Any], params: types.PaginatedRequestParams | None
    ) -> types.ListToolsResult:
        return types.ListToolsResult(tools=list(map(_listed, tools().values())))

    async def call_tool(
        context: ServerRequestContext[Any], params: types.CallToolRequestParams
    ) -> types.CallToolResult:
        tool = tools().get(params.name)
        if tool is None:
            known = ", ".join(f"`{name}`" for name in tools())
            raise MCPError(types.INVALID_PARAMS, f"there is no tool `{params.name[:100]}`; there are {known}")
        return _result(await _answer(tool, params.arguments or {}, workers, context))

    return Server(
        "tltlc",
        version=__version__,
        title="tltlc",
        instructions=INSTRUCTIONS,
        on_list_tools=list_tools,
        on_call_tool=call_tool,
    )


async def _answer(
    tool: Tool, arguments: dict[str, Any], workers: Workers, context: ServerRequestContext[Any]
) -> Answer:
    try:
        problem = argument_problem(tool.arguments, arguments)
        if problem is not None:
            return Answer(problem, is_error=True)
        if tool.run is not None:
            return await workers.answer(tool.name, arguments)
        return await regress.run(arguments, lambda count, line: context.session.report_progress(count, None, line))
    except Exception as error:
        return failure(error)


def _result(answer: Answer) -> types.CallToolResult:
    content: list[types.ContentBlock] = [types.TextContent(text=answer.text)]
    document = None if answer.document is None else dict(answer.document)
    return types.CallToolResult(content=content, structured_content=document, is_error=answer.is_error)


def _listed(tool: Tool) -> types.Tool:
    annotations = types.ToolAnnotations(
        read_only_hint=not tool.writes, destructive_hint=False, idempotent_hint=True, open_world_hint=False
    )
    return types.Tool(
        name=tool.name,
        title=tool.title,
        description=tool.description,
        input_schema=tool.arguments,
        output_schema=tool.result,
        annotations=annotations,
    )


def _end_on_signals() -> None:
    """End the process at once on SIGINT, SIGTERM and SIGHUP, because a thread waits for the agent's next message.

    The child processes then end by themselves.
    """
    numbers = [signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else [])]
    for number in numbers:
        if signal.getsignal(number) is signal.SIG_IGN:
            continue
        if sys.platform == "win32":
            signal.signal(number, lambda number, _: os._exit(128 + number))
        else:
            asyncio.get_running_loop().add_signal_handler(number, os._exit, 128 + number)


def _causes(error: BaseException) -> Iterator[BaseException]:
    """Yield an exception, and those in it if it is a group."""
    yield error
    for inner in getattr(error, "exceptions", ()):
        yield from _causes(inner)
