"""Diagnostics as SARIF 2.1.0 (OASIS), for code scanning services and editors."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Final
from urllib.parse import quote

from tltlc import __version__
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.code_pages import codes, title
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label

_SCHEMA: Final = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/os/schemas/sarif-schema-2.1.0.json"


def render(diagnostics: Sequence[Diagnostic], *, color: bool = False) -> str:
    """Return the text of a SARIF log, with all diagnostics in one run.

    Paths of files inside the current folder are relative to the folder. ``color`` has no effect.
    """
    rules = sorted({diagnostic.code for diagnostic in diagnostics})
    run = {
        "tool": {"driver": {"name": "tltlc", "version": __version__, "rules": [_rule(code) for code in rules]}},
        "columnKind": "unicodeCodePoints",
        "results": [_result(diagnostic, rules.index(diagnostic.code)) for diagnostic in diagnostics],
    }
    return json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, ensure_ascii=False, indent=2) + "\n"


def _rule(code: str) -> dict[str, object]:
    rule: dict[str, object] = {"id": code}
    if code in codes():
        rule["shortDescription"] = {"text": title(code)}
    return rule


def _result(diagnostic: Diagnostic, rule: int) -> dict[str, object]:
    label_message = diagnostic.labels[0].message if diagnostic.labels else ""
    text = "\n".join(part for part in (diagnostic.title, label_message, diagnostic.help) if part)
    result: dict[str, object] = {
        "ruleId": diagnostic.code,
        "ruleIndex": rule,
        "level": diagnostic.severity,
        "message": {"text": text},
        "locations": [_location(label) for label in diagnostic.labels[:1]],
    }
    if diagnostic.labels[1:]:
        related = []
        for label in diagnostic.labels[1:]:
            message = {"message": {"text": label.message}} if label.message else {}
            related.append({**_location(label), **message})
        result["relatedLocations"] = related
    if diagnostic.fixes:
        result["fixes"] = [_fix(fix, diagnostic.labels[0].source) for fix in diagnostic.fixes]
    return result


def _fix(fix: Fix, source: SourceFile) -> dict[str, object]:
    replacements = [
        {"deletedRegion": _region(source, edit.span), "insertedContent": {"text": edit.text}} for edit in fix.edits
    ]
    change = {"artifactLocation": {"uri": _uri(source)}, "replacements": replacements}
    return {"description": {"text": fix.title}, "artifactChanges": [change]}


def _location(label: Label) -> dict[str, object]:
    region = _region(label.source, label.span)
    return {"physicalLocation": {"artifactLocation": {"uri": _uri(label.source)}, "region": region}}


def _region(source: SourceFile, span: Span) -> dict[str, object]:
    start_line, start_column = source.position(span.start)
    end_line, end_column = source.position(span.end)
    return {"startLine": start_line, "startColumn": start_column, "endLine": end_line, "endColumn": end_column}


def _uri(source: SourceFile) -> str:
    """Return the URI of a source: a relative path for a file inside the current folder, else ``file://…``.

    For a text that is no file of the user, such as ``<stdin>``, return its quoted name.
    """
    is_file = source.kind == "file" and source.name
    path = _relative_path(source.name) if is_file else source.name
    if path is None:
        return "file://" + quote(os.path.abspath(source.name).replace(os.sep, "/"))  # noqa: PTH100
    return quote(path.replace(os.sep, "/"))


def _relative_path(file: str) -> str | None:
    """Return the path of a file relative to the current folder; None for a file outside this folder."""
    try:
        path = os.path.relpath(file)
    except ValueError:  # On Windows, the file is on another drive.
        return None
    return None if path == os.pardir or path.startswith(os.pardir + os.sep) else path
