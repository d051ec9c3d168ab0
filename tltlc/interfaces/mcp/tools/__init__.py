"""The tools of the server, each a module with a constant ``TOOL``."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from tltlc.interfaces.mcp.tool import Tool


@lru_cache(maxsize=1)
def tools() -> Mapping[str, Tool]:
    """Return all tools by name, in the order in which the server lists them."""
    from tltlc.interfaces.mcp.tools import check, diff, explain, monitor, regress, test, witness

    modules = (check, explain, witness, monitor, test, diff, regress)
    return {module.TOOL.name: module.TOOL for module in modules}
