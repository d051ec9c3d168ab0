"""Diagnostics as one JSON document, for programs."""

from __future__ import annotations

import json
from collections.abc import Sequence

from tltlc.diagnostics.diagnostic import Diagnostic, Label


def render(diagnostics: Sequence[Diagnostic], *, color: bool = False) -> str:
    """``{"diagnostics": […]}``; lines and columns count from 1, offsets from 0, all in characters."""
    found = [
        {
            "code": diagnostic.code,
            "severity": diagnostic.severity,
            "title": diagnostic.title,
            "help": diagnostic.help,
            "labels": [_label(label) for label in diagnostic.labels],
        }
        for diagnostic in diagnostics
    ]
    return json.dumps({"diagnostics": found}, ensure_ascii=False, indent=2) + "\n"


def _label(label: Label) -> dict[str, object]:
    places = []
    for offset in (label.span.start, label.span.end):
        line, column = label.source.position(offset)
        places.append({"line": line, "column": column, "offset": offset})
    return {"file": label.source.name, "start": places[0], "end": places[1], "message": label.message}
