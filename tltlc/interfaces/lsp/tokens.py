"""Semantic tokens: tell editors what each name refers to, so that they can colour it."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.occurrences import Occurrence
from tltlc.interfaces.lsp.positions import position

_TYPES: Final = {
    "signal": types.SemanticTokenTypes.Property,
    "param": types.SemanticTokenTypes.Variable,
    "predicate": types.SemanticTokenTypes.Function,
    "let": types.SemanticTokenTypes.Function,
    "entity": types.SemanticTokenTypes.EnumMember,
    "spec": types.SemanticTokenTypes.Class,
    "parameter": types.SemanticTokenTypes.Parameter,
    "variable": types.SemanticTokenTypes.Parameter,
    "group": types.SemanticTokenTypes.Enum,
}
_MODIFIERS: Final = (
    types.SemanticTokenModifiers.Declaration,
    types.SemanticTokenModifiers.Readonly,
    types.SemanticTokenModifiers.DefaultLibrary,
)
_NUMBERS: Final = {token_type: number for number, token_type in enumerate(dict.fromkeys(_TYPES.values()))}

LEGEND: Final = types.SemanticTokensLegend(
    [member.value for member in _NUMBERS], [member.value for member in _MODIFIERS]
)
"""The names of the token types, by number, and of the modifiers, by bit."""


def tokens(document: Document, encoding: str) -> list[int]:
    """Return five numbers for each name: line, column, length, type and modifiers.

    The line counts from the line of the previous name. The column counts from the previous name if
    both are on one line, and otherwise from the start of the line. Columns are counted in units of
    ``encoding``, such as ``utf-16``. The type is an index into the types of :data:`LEGEND`; the
    modifiers are a number with a bit for each modifier there.
    """
    numbers: list[int] = []
    line = column = 0
    for name in document.names:
        at = position(document.source, name.span.start, encoding)
        start = at.character - column if at.line == line else at.character
        # A name is ASCII, so it has the same length in any encoding.
        length = name.span.end - name.span.start
        numbers += [at.line - line, start, length, _NUMBERS[_TYPES[name.symbol.kind]], _modifiers(name)]
        line, column = at.line, at.character
    return numbers


def _modifiers(name: Occurrence) -> int:
    is_of_library = name.symbol.source.kind == "standard library"
    flags = (name.declares, name.symbol.kind == "param", is_of_library)
    return sum(1 << bit for bit, is_set in enumerate(flags) if is_set)
