"""The description of a tool: its name, its texts, the schemas of its arguments and results, and its function."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tltlc.core.record import record
from tltlc.interfaces.mcp.answer import Answer
from tltlc.interfaces.mcp.schemas import Schema


@record
class Tool:
    """A tool of the server.

    ``description`` tells an agent when to use the tool. ``arguments`` and ``result`` are JSON schemas.
    ``run`` answers a call in a worker process; it gets arguments that fit ``arguments``, and may raise
    WrongUseError. It is None for a tool that the server runs itself. ``writes`` says whether the tool
    writes files.
    """

    name: str
    title: str
    description: str
    arguments: Schema
    result: Schema
    run: Callable[[Mapping[str, Any]], Answer] | None
    writes: bool = False
