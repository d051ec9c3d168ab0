"""Find the enums that a file declares by a name, ``enum Engine { Ok, Hot }``, and their signals, ``engine: Engine``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

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
        names = [name for _, name, _ in declared]
        self.text = WholeText(tokens, {name: values for _, name, values in declared if names.count(name) == 1})
        """The whole file, for :func:`meant_declaration`."""
        found = [EnumSignals(frozenset((name,)), (piece,), ()) for piece, name, _ in declared if names.count(name) == 1]
        for piece in pieces if found else ():
            meant = None if _read_enum(piece) else meant_declaration(piece, self.text)
            if meant is not None and meant.enums:
                joined = [group for group in found if group.names.intersection(meant.enums)]
                found = [group for group in found if group not in joined] + [_joined(joined, piece, meant)]
        self._groups = [group for group in found if group.signals]

    def starting_at(self, piece: Sequence[Token]) -> EnumSignals | None:
        """Return the enums of which this piece is the first declaration; None if it is no such one."""
        return next((group for group in self._groups if group.pieces[0][0] == piece[0]), None)

    def declares(self, piece: Sequence[Token]) -> bool:
        """Whether a piece is the declaration of an enum that a signal has."""
        return any(other[0] == piece[0] for group in self._groups for other in group.pieces)

    def signals_of(self, piece: Sequence[Token]) -> MeantDeclaration | None:
        """Return what a piece that declares signals of a named enum is meant to be; None for other pieces."""
        uses = (use for group in self._groups for use in group.signals)
        return next((meant for other, meant in uses if other[0] == piece[0]), None)


def _joined(groups: Sequence[EnumSignals], piece: Sequence[Token], meant: MeantDeclaration) -> EnumSignals:
    """Return groups of enums as one, with one more piece that declares signals."""
    return EnumSignals(
        frozenset().union(*(group.names for group in groups)),
        tuple(sorted((enum for group in groups for enum in group.pieces), key=lambda enum: enum[0].start)),
        (*(use for group in groups for use in group.signals), (piece, meant)),
    )


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


def enum_error(source: SourceFile, enums: EnumSignals) -> Diagnostic:
    """Return the one error for enums with names and their signals, with a fix for all their lines."""
    first = enums.pieces[0]
    lines = [line for _, meant in enums.signals for line in meant.lines]
    uses = [Label(source, span_of_piece(piece), "its values belong here") for piece, _ in enums.signals]
    label = Label(source, span_of_first_line(source, span_of_piece(first)))
    is_one_line = len(enums.pieces) == 1 and "\n" not in source.slice(span_of_piece(first))
    where = "the line with" if is_one_line else "the lines with"
    help_ = f"write {quoted_lines(lines)}, and delete {where} `{first[0].text}`"
    fixes: tuple[Fix, ...] = ()
    if not any(
        "//" in source.slice(span_of_piece(piece)) for piece in (*enums.pieces, *(use for use, _ in enums.signals))
    ):
        fixes = (Fix(f"Write {quoted_lines(lines)}", tuple(_edits(source, enums)), "maybe"),)
    title = f"a declaration cannot begin with `{first[0].text}`"
    return Diagnostic("TLT0107", title, (label, *uses), help_, fixes=fixes)


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
