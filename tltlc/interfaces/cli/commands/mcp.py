"""``tltlc mcp``: run the server for coding agents."""

from __future__ import annotations

import click


@click.command(
    epilog="""\b
Examples:
  tltlc mcp                              for coding agents; uses standard input and output
  claude mcp add tltlc -- tltlc mcp      register it in Claude Code

\b
docs/guides/coding-agents.md shows the settings of other agents.
"""
)
def command() -> int:
    """Start a server for coding agents: check, explain, witness, monitor, test, diff and regress as tools.

    It speaks the Model Context Protocol, and needs the extra `mcp`. The agent starts it, and paths are relative to the
    folder in which it starts. Only the tool `regress` writes files. The exit status is 0 after the agent has closed the
    connection.
    """
    from tltlc.interfaces.cli.exits import missing_component

    try:
        import mcp.server.lowlevel  # noqa: F401
    except ModuleNotFoundError as error:
        raise missing_component("`tltlc mcp`", error.name or "mcp", "tltlc[mcp]") from None
    from tltlc.interfaces.mcp.server import serve

    return serve()
