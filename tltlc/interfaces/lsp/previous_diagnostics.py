"""What was found of an earlier state of a text, where it stands unchanged: remarks do not come and go at each key."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Label
from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.analysis import Analysis
from tltlc.interfaces.lsp.edits import difference


def kept(before: Document, found: Analysis, now: Document) -> tuple[Diagnostic, ...]:
    """What only the automata told of a document as it was, less what is said of places that have been edited."""
    edits = difference(before.source, now.source.text)
    told = {_without_fixes(each) for each in now.said}
    moved = (_moved(each, edits, now.source) for each in found.said if each not in before.said)
    return tuple(each for each in moved if each is not None and each not in told)


def _without_fixes(diagnostic: Diagnostic) -> Diagnostic:
    """The diagnostic alone: the edits of its fixes are for another text."""
    return replace(diagnostic, fixes=())


def _moved(diagnostic: Diagnostic, edits: list[Edit], source: SourceFile) -> Diagnostic | None:
    """The diagnostic at its new place; None where that was edited."""
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
