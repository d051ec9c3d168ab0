"""Quick fixes, as code actions of the Language Server Protocol."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from lsprotocol import types

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.interfaces.lsp.diagnostics import protocol_diagnostic
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import text_edit
from tltlc.interfaces.lsp.paths import location_of
from tltlc.tools.lint.fixes import fixes_of_errors, fixes_of_findings
from tltlc.tools.lint.rule import LintFinding


def actions(
    document: Document,
    span: Span,
    findings: tuple[LintFinding, ...],
    encoding: str,
    uri_of: Callable[[SourceFile], str],
    edit_of: Callable[[dict[str, list[types.TextEdit]]], types.WorkspaceEdit],
) -> list[types.CodeAction]:
    """Return the quick fixes for the compiler's diagnostics and the linter's findings at a span of a document.

    A fix of a compiler's error is offered only if the document has fewer errors after it. A fix of a
    finding is offered only if comments such as ``// tltlc: allow TLT0420`` still apply to the same
    places. Safe fixes are marked as preferred.

    ``findings`` are the linter's findings in ``document``. Columns are counted in units of
    ``encoding``, such as ``utf-16``. ``uri_of`` returns the URI of a source. ``edit_of`` makes a
    workspace edit from the text edits of each URI.
    """
    uri = uri_of(document.source)

    def errors(source: SourceFile) -> tuple[Sequence[Diagnostic], Sequence[Diagnostic]]:
        edited = document
        if source != document.source:
            edited = Document(source, document.project, {**document.texts, location_of(source): source.text})
        return edited.syntax_errors, edited.diagnostics

    findings_at_span = [finding for finding in findings if _touches(finding.diagnostic, document, span)]
    diagnostics = [diagnostic for diagnostic in document.diagnostics if _touches(diagnostic, document, span)]
    return [
        types.CodeAction(
            offer.fix.title,
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[protocol_diagnostic(offer.diagnostic, document, encoding, uri_of)],
            edit=edit_of({uri: [text_edit(document.source, edit, encoding) for edit in offer.fix.edits]}),
            # Editors may apply a preferred action without asking, so it must not be a guess.
            is_preferred=offer.fix.applicability == "safe",
        )
        for offer in (
            *fixes_of_findings(findings_at_span, document.module),
            *fixes_of_errors(diagnostics, document.source, errors),
        )
    ]


def _touches(diagnostic: Diagnostic, document: Document, span: Span) -> bool:
    return any(
        label.source.name == document.source.name and label.span.start <= span.end and span.start <= label.span.end
        for label in diagnostic.labels
    )
