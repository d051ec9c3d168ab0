"""Diagnostics as one JSON document, for programs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from tltlc.core.record import EMPTY
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label


def render(diagnostics: Sequence[Diagnostic], *, color: bool = False, facts: Mapping[str, object] = EMPTY) -> str:
    """Return the diagnostics as the text of a JSON document, ``{"diagnostics": […]}``.

    Lines and columns count from 1, offsets from 0; columns and offsets are in characters. ``facts``
    are further keys of the document, with JSON data as their values. ``color`` has no effect.
    """
    document = {"diagnostics": list(map(entry, diagnostics)), **facts}
    return json.dumps(document, ensure_ascii=False, indent=2) + "\n"


def entry(diagnostic: Diagnostic) -> dict[str, object]:
    """Return a diagnostic as JSON data."""
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity,
        "title": diagnostic.title,
        "help": diagnostic.help,
        "labels": [_label(label) for label in diagnostic.labels],
        "fixes": [_fix(fix, diagnostic.labels[0].source) for fix in diagnostic.fixes],
    }


def _label(label: Label) -> dict[str, object]:
    return {"file": label.source.name, **_range(label.source, label.span), "message": label.message}


def _fix(fix: Fix, source: SourceFile) -> dict[str, object]:
    """Return a fix as JSON data; its edits are in ``source``."""
    edits = [{**_range(source, edit.span), "text": edit.text} for edit in fix.edits]
    return {"title": fix.title, "applicability": fix.applicability, "edits": edits}


def _range(source: SourceFile, span: Span) -> dict[str, object]:
    ends = []
    for offset in (span.start, span.end):
        line, column = source.position(offset)
        ends.append({"line": line, "column": column, "offset": offset})
    return {"start": ends[0], "end": ends[1]}
