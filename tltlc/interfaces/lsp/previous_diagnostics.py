"""Keep earlier diagnostics at unchanged places of a text, so they do not flicker with each key."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Label
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import difference
from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis


def previous_diagnostics(before: Document, analysis: DocumentAnalysis, now: Document) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of the slow analysis of an earlier text, moved to their places in the text ``now``.

    ``analysis`` is the slow analysis of ``before``. Left out are the diagnostics whose places were
    edited, those that ``now`` already has, and those that ``before`` had without the slow analysis.
    """
    edits = difference(before.source, now.source.text)
    reported = {_without_fixes(diagnostic) for diagnostic in now.diagnostics}
    moved = (
        _at_new_place(diagnostic, edits, now.source)
        for diagnostic in analysis.diagnostics
        if diagnostic not in before.diagnostics
    )
    return tuple(diagnostic for diagnostic in moved if diagnostic is not None and diagnostic not in reported)


def _without_fixes(diagnostic: Diagnostic) -> Diagnostic:
    """Return a diagnostic without its fixes, whose edits are for another text."""
    return replace(diagnostic, fixes=())


def _at_new_place(diagnostic: Diagnostic, edits: list[Edit], source: SourceFile) -> Diagnostic | None:
    """Move the labels of a diagnostic to their places in ``source``, the text after ``edits``.

    Return the moved diagnostic without fixes; None if one of the places was edited.
    """
    labels: list[Label] = []
    for label in diagnostic.labels:
        if label.source.name != source.name:
            labels.append(label)
            continue
        start, end = label.span.start, label.span.end
        for edit in edits:
            if edit.span.end < start:
                shift = len(edit.text) - (edit.span.end - edit.span.start)
                start, end = start + shift, end + shift
            elif edit.span.start <= end:
                return None
        labels.append(replace(label, source=source, span=Span(start, end)))
    return replace(_without_fixes(diagnostic), labels=tuple(labels))
