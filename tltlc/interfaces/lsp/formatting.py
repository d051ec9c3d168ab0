"""Format a document like ``tltlc fmt``."""

from __future__ import annotations

from lsprotocol import types

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import difference, text_edit
from tltlc.tools.fmt import format_source


def formatting(document: Document, encoding: str) -> list[types.TextEdit] | None:
    """Return the edit that formats a document in the style of its project.

    The list is empty if the document is formatted already. Return None if it has a syntax error.
    Columns are counted in units of ``encoding``, such as ``utf-16``.

    Raises:
        TltlError: TLT0004, the text is too large, or would become too large.
    """
    try:
        after = format_source(document.source, document.project.formatting)
    except TltlError as error:
        if any(diagnostic.code == "TLT0004" for diagnostic in error.diagnostics):
            raise
        return None
    return [text_edit(document.source, edit, encoding) for edit in difference(document.source, after)]
