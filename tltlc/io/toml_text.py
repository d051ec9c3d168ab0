"""Read TOML within the limits of :mod:`tltlc.io.limits`; errors become diagnostics."""

from __future__ import annotations

import re
import sys
from typing import Any, Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.io.limits import TOML, too_deep_error, too_many_values_error

_PART: Final = r"(?:[A-Za-z0-9_-]+|\"(?:\\.|[^\"\\\n])*\"|'[^'\n]*')"
_DOTTED: Final = rf"{_PART}(?:[ \t]*\.[ \t]*{_PART})*"
_TOKEN: Final = re.compile(
    r"(?P<long>\"\"\"(?:\\.|(?!\"\"\")[^\\])*\"{3,5}|'''(?:(?!''').)*'{3,5})"
    r"|(?P<unclosed_long>\"\"\"|''')"
    rf"|(?P<key>{_DOTTED})"
    r"|(?P<unclosed>[\"'])|(?P<comment>#[^\n]*)|(?P<open>[\[{])|(?P<close>[\]}])|(?P<value>[,=])",
    re.DOTALL,
)

_WHOLE_NUMBERS: Final = range(-(2**63), 2**63)
_MANY_DIGITS: Final = re.compile(
    r"(?<![\w.+-])(?:[+-]?[1-9](?:_?[0-9]){18,}|0x[0-9A-Fa-f](?:_?[0-9A-Fa-f]){15,}"
    r"|0o[0-7](?:_?[0-7]){20,}|0b[01](?:_?[01]){62,})(?![\w.])"
)
"""Matches integers that may need more than 64 bits."""
_MOST_CHARACTERS: Final = 200
"""More characters than any integer of 64 bits needs, in any base and with underscores between its digits."""


def parse(source: SourceFile, code: str, help_: str) -> dict[str, Any]:
    """Parse a TOML text, and return its top-level table.

    Raises:
        TltlError: the error ``code`` with the help ``help_`` if the text is not TOML; TLT0006 if it
            nests deeper or has more values than :data:`tltlc.io.limits.TOML` allows.
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
    except ValueError:
        # Python refuses to read integers of thousands of digits.
        raise _too_large_error(source, code) from None
    if not _has_64_bit_integers(table):
        raise _too_large_error(source, code)
    return table


def _has_64_bit_integers(value: object) -> bool:
    """Whether all integers in a value have at most 64 bits, as TOML requires."""
    if isinstance(value, dict):
        return all(map(_has_64_bit_integers, value.values()))
    if isinstance(value, list):
        return all(map(_has_64_bit_integers, value))
    return not isinstance(value, int) or value in _WHOLE_NUMBERS


def _too_large_error(source: SourceFile, code: str) -> TltlError:
    numbers = [match for match in _MANY_DIGITS.finditer(source.text) if not _is_whole_number(match[0])]
    # A number in a comment or a string matches, too. With several matches, label none.
    label = (Label(source, Span(*numbers[0].span()), "this whole number"),) if len(numbers) == 1 else ()
    title = f"`{source.name}` is not TOML: a whole number is too large"
    help_ = f"the largest whole number is {_WHOLE_NUMBERS[-1]:,}; write a larger number with an exponent, as in 1e20"
    return TltlError([Diagnostic(code, title, label, help_)])


def _is_whole_number(digits: str) -> bool:
    return len(digits) <= _MOST_CHARACTERS and int(digits, 0) in _WHOLE_NUMBERS


def _check_limits(source: SourceFile) -> None:
    """Raise TltlError, TLT0006, for a text that nests too deep or has too many values.

    Call this before the text is parsed, because the time and the memory that the TOML library takes
    grow with the square of the nesting. Each part of a dotted key and each open bracket is a level.
    """
    assert TOML.depth is not None
    assert TOML.values is not None
    depth = values = 0
    for token in _TOKEN.finditer(source.text):
        kind = token.lastgroup
        if kind == "open":
            depth += 1
            values += 1
        elif kind == "close":
            depth = max(0, depth - 1)
        elif kind == "value":
            values += 1
        elif kind in ("unclosed", "unclosed_long"):
            # The TOML library stops here, too.
            return
        # A quoted part may contain dots, so count the parts exactly if there may be too many.
        is_long = kind == "key" and token[0].count(".") >= TOML.depth - depth
        if depth + (len(re.findall(_PART, token[0])) if is_long else 0) > TOML.depth:
            raise too_deep_error(source, TOML, Span(token.start(), min(token.end(), token.start() + 40)))
        if values > TOML.values:
            raise too_many_values_error(source, TOML, Span(token.start(), token.end()))


def _syntax_error(source: SourceFile, message: str, code: str, help_: str) -> Diagnostic:
    """Return a diagnostic for an error message of the TOML library.

    Its label is at the position that the message names, or else at the end of the text.
    """
    location = re.search(r" \(at (?:line (\d+), column (\d+)|end of document)\)$", message)
    reason = message[: location.start()] if location else message
    label = Label(source, Span(len(source.text), len(source.text)), reason[:1].lower() + reason[1:])
    if location and location[1]:
        end_of_line = 0
        for _ in range(int(location[1]) - 1):
            end_of_line = source.text.index("\n", end_of_line) + 1
        start = min(end_of_line + int(location[2]) - 1, len(source.text))
        label = Label(source, Span(start, min(start + 1, len(source.text))), label.message)
    return Diagnostic(code, f"`{source.name}` is not TOML", (label,), help_)
