"""``tltlc lsp``: run the language server for editors."""

from __future__ import annotations

import click


@click.command(
    epilog="""\b
Examples:
  tltlc lsp                       what an editor starts; it speaks over standard input and output

\b
The folder editors/vscode of the repository holds the extension for VS Code; docs/guides/editors.md shows the settings
of Neovim, Helix, Emacs and Kate.
"""
)
@click.option("--stdio", is_flag=True, help="Without effect: there is no other way to speak.")
def command(stdio: bool) -> int:
    """Serve an editor: errors and warnings as you type, completion, what a name or a formula means, renaming, layout.

    Needs the extra `lsp`.  The exit status is 0 where the editor said `shutdown` before it left, else 1.
    """
    from tltlc.interfaces.cli.exits import CLEAN, FINDINGS, missing_component

    try:
        import pygls.lsp.server  # noqa: F401
    except ModuleNotFoundError as error:
        raise missing_component("`tltlc lsp`", error.name or "pygls", "tltlc[lsp]") from None
    from tltlc.interfaces.lsp.server import serve

    return CLEAN if serve() else FINDINGS
