"""Read TOML within the limits of :mod:`tltlc.limits`; what the standard reader says becomes a diagnostic."""

from __future__ import annotations

import re
import sys
from typing import Any, Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.limits import TOML, too_deep, too_many
from tltlc.source import SourceFile, Span

_PART: Final = r"(?:[A-Za-z0-9_-]+|\"(?:\\.|[^\"\\\n])*\"|'[^'\n]*')"
_DOTTED: Final = rf"{_PART}(?:[ \t]*\.[ \t]*{_PART})*"
_TOKEN: Final = re.compile(
    r"(?P<long>\"\"\"(?:\\.|(?!\"\"\")[^\\])*\"{3,5}|'''(?:(?!''').)*'{3,5})"
    r"|(?P<unclosed_long>\"\"\"|''')"
    rf"|(?P<key>{_DOTTED})"
    r"|(?P<unclosed>[\"'])|(?P<comment>#[^\n]*)|(?P<open>[\[{])|(?P<close>[\]}])|(?P<value>[,=])",
    re.DOTALL,
)


def parse(source: SourceFile, code: str, help_: str) -> dict[str, Any]:
    """The values in a text.

    Raises:
        TltlError: ``code`` with ``help_``, it is no TOML; TLT0006, it nests deeper or holds more values than
            :data:`tltlc.limits.TOML` allows.
    """
    _check_limits(source)
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


def _check_limits(source: SourceFile) -> None:
    """Refuse what the standard reader, whose time and memory grow with the square of the nesting, should not see.

    Each part of a dotted key and each open bracket is a level.
    """
    assert TOML.depth is not None
    assert TOML.values is not None
    depth = values = 0
    for token in _TOKEN.finditer(source.text):
        kind = token.lastgroup
        if kind == "open":
            depth += 1
        elif kind == "close":
            depth = max(0, depth - 1)
        elif kind == "value":
            values += 1
        elif kind in ("unclosed", "unclosed_long"):
            # The standard reader stops there, too.
            return
        # A quoted part may hold points: count exactly where there are many.
        is_long = kind == "key" and token[0].count(".") >= TOML.depth - depth
        if depth + (len(re.findall(_PART, token[0])) if is_long else 0) > TOML.depth:
            raise too_deep(source, TOML, Span(token.start(), min(token.end(), token.start() + 40)))
        if values > TOML.values:
            raise too_many(source, TOML, Span(token.start(), token.end()))


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
