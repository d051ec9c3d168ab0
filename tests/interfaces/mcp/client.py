"""A coding agent that starts ``tltlc mcp`` as a process, with the client of the library `mcp`."""

from __future__ import annotations

import os
import sys
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Literal

from jsonschema import Draft202012Validator
from mcp import Client, types
from mcp.client.stdio import StdioServerParameters, stdio_client

ROOT = Path(__file__).parents[3]
COMMAND = [sys.executable, "-m", "tltlc", "mcp"]
ENVIRONMENT = {"PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime"), *filter(None, sys.path)])}

SPEC = """\
signal distance: length in [0 m, 100 m]
signal has_key: bool
signal seen: bool
let at_exit = distance < 2 m

spec leave {
    limit 60 steps
    reach has_key then at_exit
    avoid seen
}

test "no key, no exit" for leave {
    step at_exit
    expect pending
}
"""


class Agent:
    """A connected agent. Each result of a tool must fit the tool's output schema."""

    def __init__(self, client: Client, tools: Sequence[types.Tool]) -> None:
        self.client = client
        self.tools = {tool.name: tool for tool in tools}

    async def call(self, name: str, /, **arguments: Any) -> types.CallToolResult:
        result = await self.client.call_tool(name, arguments)
        if result.structured_content is not None:
            schema = self.tools[name].output_schema
            assert schema is not None
            Draft202012Validator(schema).validate(result.structured_content)
        return result

    async def document(self, name: str, /, **arguments: Any) -> dict[str, Any]:
        """Return the structured result of a call that must not fail."""
        result = await self.call(name, **arguments)
        assert not result.is_error, text(result)
        document: dict[str, Any] = result.structured_content
        return document

    async def refusal(self, name: str, /, **arguments: Any) -> str:
        """Return the message of a call that must fail."""
        result = await self.call(name, **arguments)
        assert result.is_error, (arguments, text(result))
        return text(result)


@asynccontextmanager
async def connected(folder: Path, mode: Literal["auto", "legacy"] = "auto") -> AsyncIterator[Agent]:
    """Connect an agent to a server in this folder.

    At the end, no process may be left, and none may have printed anything: all of them share the
    standard error of the server.
    """
    reading, writing = os.pipe()
    server = StdioServerParameters(command=COMMAND[0], args=COMMAND[1:], env=ENVIRONMENT, cwd=folder)
    with os.fdopen(writing, "w", encoding="utf-8") as errors:
        async with Client(stdio_client(server, errlog=errors), mode=mode) as client:
            yield Agent(client, (await client.list_tools()).tools)
    with os.fdopen(reading, encoding="utf-8") as printed:
        assert printed.read() == ""


def text(result: types.CallToolResult) -> str:
    """Return the text of a result."""
    (content,) = result.content
    assert isinstance(content, types.TextContent)
    return content.text


def mended(source: str, fix: Mapping[str, Any]) -> str:
    """Return the source text after the edits of a fix, from the last to the first."""
    for edit in sorted(fix["edits"], key=lambda edit: -int(edit["start"]["offset"])):
        start, end = edit["start"]["offset"], edit["end"]["offset"]
        assert source[start:end] == edit["replaces"]
        source = source[:start] + edit["text"] + source[end:]
    return source
