"""What each name stands for, so that editors colour it: a grammar of patterns sees names alone."""

from __future__ import annotations

from typing import Final

from lsprotocol import types

from tltlc.interfaces.lsp.analysed_text import Document
from tltlc.interfaces.lsp.names import Occurrence
from tltlc.interfaces.lsp.positions import position
from tltlc.resolve.imports import STANDARD_LIBRARY_NAME

_TYPES: Final = {
    "signal": types.SemanticTokenTypes.Property,
    "param": types.SemanticTokenTypes.Variable,
    "predicate": types.SemanticTokenTypes.Function,
    "let": types.SemanticTokenTypes.Function,
    "entity": types.SemanticTokenTypes.EnumMember,
    "spec": types.SemanticTokenTypes.Class,
    "parameter": types.SemanticTokenTypes.Parameter,
    "variable": types.SemanticTokenTypes.Parameter,
}
_MODIFIERS: Final = (
    types.SemanticTokenModifiers.Declaration,
    types.SemanticTokenModifiers.Readonly,
    types.SemanticTokenModifiers.DefaultLibrary,
)
_NUMBERS: Final = {each: number for number, each in enumerate(dict.fromkeys(_TYPES.values()))}

LEGEND: Final = types.SemanticTokensLegend([each.value for each in _NUMBERS], [each.value for each in _MODIFIERS])
"""What the numbers of types and the bits of modifiers mean."""


def tokens(document: Document, encoding: str) -> list[int]:
    """Five numbers for each name: lines and columns from the one before, length, type and modifiers."""
    found: list[int] = []
    line = column = 0
    for each in document.names:
        at = position(document.source, each.span.start, encoding)
        start = at.character - column if at.line == line else at.character
        # A name is ASCII: as long in any encoding.
        length = each.span.end - each.span.start
        found += [at.line - line, start, length, _NUMBERS[_TYPES[each.symbol.kind]], _modifiers(each)]
        line, column = at.line, at.character
    return found


def _modifiers(name: Occurrence) -> int:
    is_of_library = name.symbol.source.name.startswith(STANDARD_LIBRARY_NAME)
    given = (name.declares, name.symbol.kind == "param", is_of_library)
    return sum(1 << bit for bit, is_given in enumerate(given) if is_given)
