"""Find the enums that a file declares by a name, ``enum Engine { Ok, Hot }``, and their signals, ``engine: Engine``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence, Set
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, Label
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.declaration_forms.meant import Cursor, MeantDeclaration, WholeText
from tltlc.grammar.mistakes.declaration_forms.ranges import read_values
from tltlc.grammar.mistakes.declaration_forms.reading import (
    lines_edit,
    meant_declaration,
    quoted_lines,
    span_of_first_line,
    span_of_piece,
)
from tltlc.grammar.mistakes.declaration_forms.signals import ENUM_WORDS

_MOST_LABELS: Final = 10
"""The most signals of an enum to which its error points."""


@record
class EnumSignals:
    """Enums with names, and the pieces of a file that declare signals with them.

    ``names`` are those of the enums, and ``pieces`` their declarations. ``signals`` are the other pieces, each with
    what it is meant to declare. There are several enums only if one piece declares signals of more than one.
    """

    names: frozenset[str]
    pieces: tuple[Sequence[Token], ...]
    signals: tuple[tuple[Sequence[Token], MeantDeclaration], ...]


class NamedEnums:
    """The enums that a file declares by a name and uses as types of signals."""

    def __init__(self, pieces: Sequence[Sequence[Token]], tokens: Sequence[Token]) -> None:
        declared = [(piece, *enum) for piece in pieces if (enum := _read_enum(piece)) is not None]
        counts = Counter(name for _, name, _ in declared)
        clear = [(piece, name, values) for piece, name, values in declared if counts[name] == 1]
        self.text = WholeText(tokens, {name: values for _, name, values in clear})
        """The whole file, for :func:`meant_declaration`."""
        groups = {name: EnumSignals(frozenset((name,)), (piece,), ()) for piece, name, _ in clear}
        self._signals: dict[int, MeantDeclaration] = {}
        for piece in pieces if groups else ():
            meant = None if _read_enum(piece) else meant_declaration(piece, self.text)
            if meant is not None and meant.enums:
                joined = _joined({groups[name].pieces[0][0].start: groups[name] for name in meant.enums}, piece, meant)
                groups.update(dict.fromkeys(joined.names, joined))
                self._signals[piece[0].start] = meant
        used = [group for group in groups.values() if group.signals]
        self._names = frozenset(name for group in used for name in group.names)
        self._short = [(token, enum) for token, enum in _short_values(tokens, self._names) if enum]
        self._firsts = {group.pieces[0][0].start: group for group in used}
        self._starts = frozenset(piece[0].start for group in used for piece in group.pieces)

    def starting_at(self, piece: Sequence[Token]) -> EnumSignals | None:
        """Return the enums of which this piece is the first declaration; None if it is no such one."""
        return self._firsts.get(piece[0].start)

    def declares(self, piece: Sequence[Token]) -> bool:
        """Whether a piece is the declaration of an enum that a signal has."""
        return piece[0].start in self._starts

    def signals_of(self, piece: Sequence[Token]) -> MeantDeclaration | None:
        """Return what a piece that declares signals of a named enum is meant to be; None for other pieces."""
        return self._signals.get(piece[0].start)

    def with_short_values(self, piece: Sequence[Token]) -> list[Token]:
        """Return the tokens of a piece with each ``Engine.Hot`` and ``Engine::Hot`` of a named enum as ``Hot``."""
        return [token for token, _ in _short_values(piece, self._names)]

    def short_values(self, enums: EnumSignals) -> tuple[Token, ...]:
        """Return a token ``Hot`` for each ``Engine.Hot`` of these enums outside the declarations of their signals."""
        declared = [span_of_piece(piece) for piece, _ in enums.signals]
        short = (token for token, enum in self._short if enum in enums.names)
        return tuple(token for token in short if not any(span.start <= token.start < span.end for span in declared))


def _joined(by_start: Mapping[int, EnumSignals], piece: Sequence[Token], meant: MeantDeclaration) -> EnumSignals:
    """Return groups of enums as one, with one more piece that declares signals."""
    groups = [by_start[start] for start in sorted(by_start)]
    return EnumSignals(
        frozenset().union(*(group.names for group in groups)),
        tuple(enum for group in groups for enum in group.pieces),
        (*(use for group in groups for use in group.signals), (piece, meant)),
    )


def _short_values(tokens: Sequence[Token], enums: Set[str]) -> Iterator[tuple[Token, str]]:
    """Yield the tokens, each ``Engine.Hot`` as one token ``Hot`` with its enum; others with an empty name."""
    cursor = Cursor(tokens)
    while not cursor.is_done:
        token, enum = cursor.token, ""
        name, _, value = token.text.partition(".")
        colons = [cursor.peek(1), cursor.peek(2)]
        if token.type == "NAME" and value and name in enums:
            token, enum = Token("NAME", value, token.start, token.end), name
        elif token.text in enums and [colon.text for colon in colons] == [":", ":"] and cursor.peek(3).type == "NAME":
            token, enum = Token("NAME", cursor.peek(3).text, token.start, cursor.peek(3).end), token.text
            cursor.at += 3
        cursor.at += 1
        yield token, enum


def _read_enum(piece: Sequence[Token]) -> tuple[str, tuple[str, ...]] | None:
    """Return the name and the values of the enum that a piece declares; None if it is something else.

    Examples are ``enum Engine { Ok, Hot }``, ``enum class Engine : byte { Ok, Hot };`` and ``type Engine = Ok | Hot``.
    """
    cursor = Cursor(piece)
    if not cursor.accept(*ENUM_WORDS):
        return None
    cursor.at += cursor.token.text in ("class", "struct") and cursor.peek(1).type == "NAME"
    name = cursor.token
    cursor.at += 1
    cursor.at += 2 * (cursor.token.text == ":" and cursor.peek(2).text == "{")
    values = read_values(cursor)
    cursor.accept(";")
    return (name.text, values) if name.type == "NAME" and values and cursor.is_done else None


def enum_error(source: SourceFile, enums: EnumSignals, short: Sequence[Token]) -> Diagnostic:
    """Return the one error for enums with names and their signals, with a fix for all their lines.

    ``short`` are the values that are written with their enum, as they should be: the fix writes them so.
    """
    first = enums.pieces[0]
    declared = [span_of_piece(piece) for piece, _ in enums.signals]
    spans = [*(span_of_piece(piece) for piece in enums.pieces), *declared]
    lines = [line for _, meant in enums.signals for line in meant.lines]
    is_one_line = len(enums.pieces) == 1 and "\n" not in source.slice(spans[0])
    help_ = f"write {quoted_lines(lines)}, and delete the {'line' if is_one_line else 'lines'} with `{first[0].text}`"
    if short:
        help_ += f"; a value stands alone: `{short[0].text}`"
    edits = (*_edits(source, enums), *(Edit(token.span, token.text) for token in short))
    has_comment = any("//" in source.slice(span) for span in spans)
    return Diagnostic(
        "TLT0107",
        f"a declaration cannot begin with `{first[0].text}`",
        (
            Label(source, span_of_first_line(source, spans[0])),
            *(Label(source, span, "its values belong here") for span in declared[:_MOST_LABELS]),
        ),
        help_,
        fixes=() if has_comment else (Fix(f"Write {quoted_lines(lines)}", edits, "maybe"),),
    )


def _edits(source: SourceFile, enums: EnumSignals) -> Iterator[Edit]:
    for piece in enums.pieces:
        yield Edit(_whole_lines(source, span_of_piece(piece)), "")
    for piece, meant in enums.signals:
        yield lines_edit(source, span_of_piece(piece), meant.lines)


def _whole_lines(source: SourceFile, span: Span) -> Span:
    """Return a span with the rest of its lines if nothing else stands on them; else the span alone."""
    start = source.text.rfind("\n", 0, span.start) + 1
    end = source.text.find("\n", span.end) + 1 or len(source.text)
    is_alone = not source.text[start : span.start].strip() and not source.text[span.end : end].strip()
    return Span(start, end) if is_alone else span
