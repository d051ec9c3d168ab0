"""Convert the compiler's diagnostics to diagnostics of the Language Server Protocol."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from lsprotocol import types

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.diagnostics.shortening import shorten
from tltlc.grammar.tree import Import
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.positions import range_of

_SEVERITIES: Final = {
    "error": types.DiagnosticSeverity.Error,
    "warning": types.DiagnosticSeverity.Warning,
    "note": types.DiagnosticSeverity.Information,
}
_UNNECESSARY: Final = {"TLT0421", "TLT0422", "TLT0425", "TLT0427"}
"""Warnings about parts that can be removed, which editors show faded."""


def protocol_diagnostic(
    diagnostic: Diagnostic, document: Document, encoding: str, uri_of: Callable[[SourceFile], str]
) -> types.Diagnostic:
    """Convert a diagnostic for display in a document.

    A diagnostic of an imported file appears at the import through which the document reads that
    file. Columns are counted in units of ``encoding``, such as ``utf-16``. ``uri_of`` returns the
    URI of a source.
    """
    diagnostic = shorten(diagnostic)
    main = label_in(diagnostic, document)
    place = main.span if main else _import_of(diagnostic, document)
    message = diagnostic.title
    if main is not None and main.message:
        message += f": {main.message}"
    if diagnostic.help:
        message += f"\n{diagnostic.help}"
    related = [
        types.DiagnosticRelatedInformation(
            types.Location(uri_of(label.source), range_of(label.source, label.span, encoding)),
            label.message or ("here" if main else diagnostic.title),
        )
        for label in diagnostic.labels
        if label is not main
    ]
    return types.Diagnostic(
        range_of(document.source, place, encoding),
        message,
        severity=_SEVERITIES[diagnostic.severity],
        code=diagnostic.code,
        source="tltlc",
        related_information=related or None,
        tags=[types.DiagnosticTag.Unnecessary] if diagnostic.code in _UNNECESSARY else None,
    )


def label_in(diagnostic: Diagnostic, document: Document) -> Label | None:
    """Return the first label of a diagnostic that lies in a document; None if no label does."""
    return next((label for label in diagnostic.labels if label.source.name == document.source.name), None)


def project_file_diagnostic(diagnostic: Diagnostic, encoding: str) -> types.Diagnostic:
    """Convert a diagnostic of a project file (``tltl.toml``), for display in that file.

    Columns are counted in units of ``encoding``, such as ``utf-16``.
    """
    diagnostic = shorten(diagnostic)
    label = diagnostic.labels[0]
    return types.Diagnostic(
        range_of(label.source, label.span, encoding),
        "\n".join(filter(None, (diagnostic.title, diagnostic.help))),
        severity=_SEVERITIES[diagnostic.severity],
        code=diagnostic.code,
        source="tltlc",
    )


def _import_of(diagnostic: Diagnostic, document: Document) -> Span:
    """Return the span of the import through which the document reads the file of a diagnostic.

    The span covers the name or path after ``import``. Without such an import, return the span of
    the first import. If there is no import, or the diagnostic names no file, return an empty span
    at the start of the text.
    """
    names = {label.source.name for label in diagnostic.labels}
    for declaration, loaded in document.resolution.modules[-1].imports:
        waiting, seen = [loaded], set()
        while waiting:
            current = waiting.pop()
            if current.module.source.name in names:
                return declaration.target_span
            if id(current) not in seen:
                seen.add(id(current))
                waiting += [target for _, target in current.imports]
    first = next((candidate for candidate in document.module.declarations if isinstance(candidate, Import)), None)
    return first.target_span if first and names else Span(0, 0)
