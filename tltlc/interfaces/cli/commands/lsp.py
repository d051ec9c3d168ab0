"""``tltlc lsp``: run the language server for editors."""

from __future__ import annotations

import click


@click.command(
    epilog="""\b
Examples:
  tltlc lsp                       for editors; uses standard input and output

\b
The folder editors/vscode of the repository holds the extension for VS Code; docs/guides/editors.md shows the settings
of Neovim, Helix, Emacs and Kate.
"""
)
@click.option("--stdio", is_flag=True, help="Ignored; the server always uses standard input and output.")
def command(stdio: bool) -> int:
    """Start a language server for editors: errors, completion, hover, renaming, formatting.

    It needs the extra `lsp`. The exit status is 0 if the editor sent `shutdown` before it closed the connection, and 1
    otherwise.
    """
    from tltlc.interfaces.cli.exits import CLEAN, FINDINGS, missing_component

    try:
        import pygls.lsp.server  # noqa: F401
    except ModuleNotFoundError as error:
        raise missing_component("`tltlc lsp`", error.name or "pygls", "tltlc[lsp]") from None
    from tltlc.interfaces.lsp.server import serve

    return CLEAN if serve() else FINDINGS
