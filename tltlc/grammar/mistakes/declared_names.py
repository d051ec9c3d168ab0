"""What a text declares, as far as its tokens say: the names, their types, a clock and imports.

A text with a syntax error has no syntax tree, so the types are those that its tokens spell.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile
from tltlc.grammar.lexer import Token, tokenize
from tltlc.grammar.mistakes.declaration_forms.enums import NamedEnums
from tltlc.grammar.mistakes.declaration_forms.reading import meant_declaration, tokens_as_meant
from tltlc.grammar.mistakes.fragments import declarations

_TYPED: Final = ("SIGNAL", "PARAM")
_WITH_PARAMETERS: Final = (*_TYPED, "PREDICATE", "LET")


@record
class DeclaredName:
    """A name that a text declares.

    ``keyword`` is the word that begins the declaration, or ``parameter`` for a parameter of one. ``type``
    is that of a signal or param: ``enum`` for a list of values, ``number`` where none is written. It is
    empty for other names. ``values`` are the values of an enum, ``members`` those of a group of entities.
    ``parameters`` are the names of the parameters, and ``ends`` the texts of the two ends of a range.
    """

    keyword: str
    type: str = ""
    values: tuple[str, ...] = ()
    parameters: tuple[str, ...] = ()
    members: tuple[str, ...] = ()
    ends: tuple[str, ...] = ()


@record
class DeclaredNames:
    """The names that a text declares, and whether it declares a clock and imports names of other files.

    ``has_clock`` is that of a clock with a rate, ``clock_varies`` that of `clock varies`. ``step_s`` is the length
    of a step in seconds, 0 if no clock declares it.
    """

    names: Mapping[str, DeclaredName]
    has_clock: bool
    clock_varies: bool
    has_imports: bool
    step_s: float = 0.0

    def type_of(self, name: str) -> str:
        """Return the type of a signal or param; ``int`` for ``times``, ``""`` for other names."""
        known = self.names.get(name)
        if known is None and name == "times":
            return "int"
        return "" if known is None else known.type


def declared_names(source: SourceFile) -> DeclaredNames:
    """Return what a text declares."""
    return _declared_names(source.text)


@lru_cache(maxsize=1)
def _declared_names(text: str) -> DeclaredNames:
    names: dict[str, DeclaredName] = {}
    has_clock = clock_varies = has_imports = False
    step_s = 0.0
    tokens = tokenize(text).tokens[:-1]
    for piece in _as_meant(list(declarations(SourceFile("", text, "text"), tokens)), tokens):
        kind = piece[0].type
        has_imports |= kind == "IMPORT"
        has_clock |= kind == "CLOCK" and len(piece) > 1 and piece[1].type == "NUMBER"
        if kind == "CLOCK" and len(piece) > 2 and piece[1].type == "NUMBER":
            step_s = _step_length(float(piece[1].text), piece[2].text)
        clock_varies |= kind == "CLOCK" and len(piece) > 1 and piece[1].text == "varies"
        for name, declared in _declared_by(piece):
            names.setdefault(name, declared)
    return DeclaredNames(names, has_clock, clock_varies, has_imports, step_s)


def _as_meant(pieces: Sequence[list[Token]], tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of declarations; those in other forms as they should be written."""
    enums = NamedEnums(pieces, tokens)
    for piece in pieces:
        if enums.declares(piece):
            continue
        meant = meant_declaration(piece, enums.text)
        if meant is None:
            yield piece
        else:
            yield from tokens_as_meant(piece, meant.read_as)


def _step_length(number: float, unit: str) -> float:
    """Return the length of a step in seconds of `clock 60 Hz` or `clock 20 ms`; 0 for another unit."""
    if unit == "Hz":
        return 1 / number if number else 0.0
    return number * {"s": 1.0, "ms": 0.001}.get(unit, 0.0)


def _declared_by(piece: Sequence[Token]) -> Iterator[tuple[str, DeclaredName]]:
    """Yield the names that a declaration declares."""
    head = piece[0]
    if head.type == "ENTITY":
        members = tuple(token.text for token in piece[3:] if token.type == "NAME")
        is_group = len(piece) > 2 and piece[2].type == "EQUAL"
        for at, token in enumerate(piece[1:]):
            if token.type == "NAME":
                yield token.text, DeclaredName(head.text, members=members if is_group and at == 0 else ())
    if head.type not in _WITH_PARAMETERS or len(piece) < 2 or piece[1].type != "NAME":
        return
    parameters: tuple[str, ...] = ()
    at = 2
    if at < len(piece) and piece[at].type == "LPAR":
        at = _closing(piece, at) + 1
        pairs = tuple(pairwise(piece[2:at]))
        parameters = tuple(
            token.text for before, token in pairs if before.type in ("LPAR", "COMMA") and token.type == "NAME"
        )
        for parameter in parameters:
            yield parameter, DeclaredName("parameter")
    if head.type not in _TYPED:
        yield piece[1].text, DeclaredName(head.text, parameters=parameters)
    elif at + 1 < len(piece) and piece[at].type == "COLON" and piece[at + 1].type == "LPAR":
        values = tuple(token.text for token in piece[at + 2 : _closing(piece, at + 1)] if token.type == "NAME")
        yield piece[1].text, DeclaredName(head.text, "enum", values, parameters)
    else:
        has_type = at + 1 < len(piece) and piece[at].type == "COLON"
        type_ = piece[at + 1].text if has_type else "number"
        yield piece[1].text, DeclaredName(head.text, type_, (), parameters, (), _ends(piece[at:]))


def _ends(piece: Sequence[Token]) -> tuple[str, ...]:
    """Return the texts of the two ends of a range such as ``in [0 m, 10 m]``; () if there is none."""
    opening = next((at for at, token in enumerate(piece) if token.type == "LSQB"), len(piece))
    closing = next((at for at, token in enumerate(piece) if token.type == "RSQB"), 0)
    inside = piece[opening + 1 : closing]
    comma = next((at for at, token in enumerate(inside) if token.type == "COMMA"), 0)
    ends = (inside[:comma], inside[comma + 1 :]) if comma else ()
    return tuple(" ".join(token.text for token in end) for end in ends)


def _closing(piece: Sequence[Token], opening: int) -> int:
    """Return the index of the next closing bracket; the last index if there is none."""
    return next((at for at in range(opening, len(piece)) if piece[at].type == "RPAR"), len(piece) - 1)
