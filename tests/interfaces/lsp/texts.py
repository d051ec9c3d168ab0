"""Documents for tests without an editor."""

from __future__ import annotations

from pathlib import Path

from tests.interfaces.lsp.endless.sitecustomize import NEVER_ENDS
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.workspace import Workspace

MARK = "¦"
"""Marks the cursor in a text."""

ENDLESS = f"signal a: bool\nspec slow = F a\n{NEVER_ENDS}"
"""A text whose analysis never ends in the servers of :mod:`tests.interfaces.lsp.client`."""

EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.tltl"))


def open_text(marked: str, folder: Path | None = None, **others: str) -> tuple[Document, int, Workspace]:
    """Return a document, the position of the mark in it, and its workspace; ``others`` are open
    files by name."""
    text, at = marked.replace(MARK, ""), max(0, marked.find(MARK))
    folder = folder or Path("/nowhere")
    workspace = Workspace()
    workspace.folders = [str(folder)]
    for name, other in others.items():
        workspace.put((folder / f"{name}.tltl").as_uri(), 1, other)
    uri = (folder / "main.tltl").as_uri()
    workspace.put(uri, 1, text)
    document = workspace.document(uri)
    assert document is not None
    return document, at, workspace
