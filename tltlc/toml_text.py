"""Reading TOML: what the standard reader says becomes a diagnostic with its place."""

from __future__ import annotations

import re
import sys
from typing import Any

from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.source import SourceFile, Span


def parse(source: SourceFile, code: str, help_: str) -> dict[str, Any]:
    """The values in a text; raises TltlError with ``code`` and ``help_`` where it is no TOML."""
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        table: dict[str, Any] = tomllib.loads(source.text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        message = str(error) or "it is nested too deeply"
        raise TltlError([_syntax_error(source, message, code, help_)]) from None
    return table


def _syntax_error(source: SourceFile, message: str, code: str, help_: str) -> Diagnostic:
    """The TOML reader's message; its place becomes a label."""
    found = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)$", message)
    reason = message[: found.start()] if found else message
    label = Label(source, Span(len(source.text), len(source.text)), reason[:1].lower() + reason[1:])
    if found and found[1]:
        end_of_line = 0
        for _ in range(int(found[1]) - 1):
            end_of_line = source.text.index("\n", end_of_line) + 1
        start = min(end_of_line + int(found[2]) - 1, len(source.text))
        label = Label(source, Span(start, min(start + 1, len(source.text))), label.message)
    return Diagnostic(code, f"`{source.name}` is not TOML", (label,), help_)
