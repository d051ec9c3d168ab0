"""Read a declaration in another form, and build its error, with the declarations to write instead."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix, Label, replacement_fix
from tltlc.grammar.keywords import DECLARATIONS
from tltlc.grammar.lexer import Token, tokenize
from tltlc.grammar.mistakes.declaration_forms.clocks import read_clock
from tltlc.grammar.mistakes.declaration_forms.heads import SpecHead
from tltlc.grammar.mistakes.declaration_forms.meant import MeantDeclaration, WholeText
from tltlc.grammar.mistakes.declaration_forms.signals import read_entities, read_signals

_LONGEST: Final = 200
"""A declaration has at most this many tokens; a longer piece is something else."""
_MOST_SHOWN: Final = 4
"""The most declarations that a help quotes one by one."""


def meant_declaration(piece: Sequence[Token], text: WholeText) -> MeantDeclaration | None:
    """Return what a piece is meant to declare; None if it is well formed, or means nothing that is known here.

    ``piece`` are the tokens of the declaration, ``text`` the whole file.
    """
    if not piece or len(piece) > _LONGEST:
        return None
    meant = read_clock(piece) or read_entities(piece) or read_signals(piece, text)
    is_same = meant is not None and [token.text for token in piece] == [
        token.text for line in meant.lines for token in tokenize(line).tokens[:-1]
    ]
    return None if is_same else meant


def tokens_as_meant(piece: Sequence[Token], lines: Sequence[str]) -> list[list[Token]]:
    """Return the tokens of each declaration of ``lines``, at the places where the piece has the same words.

    Words that the piece lacks get its whole span.
    """
    span = span_of_piece(piece)
    places = {token.text: token for token in reversed(piece)}
    declared: list[list[Token]] = []
    for line in lines:
        tokens: list[Token] = []
        for token in tokenize(line).tokens[:-1]:
            place = places.get(token.text)
            start, end = (place.start, place.end) if place else (span.start, span.end)
            tokens.append(Token(token.type, token.text, start, end))
        first, last = tokens[0], tokens[-1]
        tokens[0] = Token(first.type, first.text, span.start, span.end)
        tokens[-1] = Token(last.type, last.text, last.start, span.end)
        declared.append(tokens)
    return declared


def declaration_error(source: SourceFile, piece: Sequence[Token], meant: MeantDeclaration) -> Diagnostic:
    """Return the error for a piece that is meant as other declarations, with a fix if nothing is left to choose."""
    marked = _mark_at_end(source, piece, meant)
    if marked is not None:
        return marked
    span = span_of_piece(piece)
    first = piece[0]
    is_known = first.text in DECLARATIONS and first.type != "NAME"
    code = "TLT0101" if is_known else "TLT0107"
    title = f"a declaration cannot begin with `{first.text}`"
    if is_known:
        title = f"{'an' if meant.noun == 'entity' else 'a'} {meant.noun} is declared in another form"
    fixes: tuple[Fix, ...] = ()
    if meant.is_complete and "//" not in source.slice(span):
        fixes = (replacement_fix(source, span, _newline(source).join(meant.lines)),)
    return Diagnostic(code, title, (Label(source, span_of_first_line(source, span)),), _help(meant), fixes=fixes)


def head_error(source: SourceFile, piece: Sequence[Token], head: SpecHead) -> Diagnostic:
    """Return the error for the beginning of a spec in another form, with a fix if the author wrote a name."""
    span = Span(piece[0].start, piece[head.length - 1].end)
    if not head.closes and head.text.endswith("{"):
        what = f"write `{head.text}`"
    elif head.closes:
        what = f"write `{head.text}`, and `}}` after the last clause"
    else:
        what = f"write `{head.text} …`"
    is_known = piece[0].text == "spec"
    title = "a spec begins in another form" if is_known else f"a declaration cannot begin with `{piece[0].text}`"
    edits = [Edit(span, head.text if piece[head.length].start > span.end else f"{head.text} ")]
    if head.closes:
        edits.append(Edit(Span(piece[-1].end, piece[-1].end), " }" if _is_one_line(source, piece) else "\n}"))
    fixes = (Fix(f"Write `{head.text}`", tuple(edits), "maybe"),) if head.has_name else ()
    label = Label(source, span_of_first_line(source, span))
    return Diagnostic("TLT0101" if is_known else "TLT0107", title, (label,), what, fixes=fixes)


def _mark_at_end(source: SourceFile, piece: Sequence[Token], meant: MeantDeclaration) -> Diagnostic | None:
    """Return the error for a declaration that is right but for a mark at its end, as ``signal a: bool;`` is."""
    last = piece[-1]
    written = [token.text for token in piece[:-1]]
    if last.text not in (";", ",") or written != [
        token.text for line in meant.lines for token in tokenize(line).tokens[:-1]
    ]:
        return None
    title, help_ = f"`{last.text}` means nothing here", "leave it out: nothing is needed between declarations"
    fix = Fix(f"Leave out `{last.text}`", (Edit(last.span, ""),), "maybe")
    return Diagnostic("TLT0104", title, (Label(source, last.span),), help_, fixes=(fix,))


def _help(meant: MeantDeclaration) -> str:
    if meant.help:
        return meant.help
    return f"write {quoted_lines(meant.lines)}{meant.reason}"


def quoted_lines(lines: Sequence[str]) -> str:
    """Return declarations as a help quotes them: `` `signal a: bool` and `signal b: bool` ``."""
    shown = [f"`{line}`" for line in lines[:_MOST_SHOWN]]
    if len(lines) > _MOST_SHOWN:
        shown.append("…")
    *others, last = shown
    return f"{', '.join(others)} and {last}" if others else last


def lines_edit(source: SourceFile, span: Span, lines: Sequence[str]) -> Edit:
    """Return the change that replaces a span by declarations, one on each line."""
    return Edit(span, _newline(source).join(lines))


def _newline(source: SourceFile) -> str:
    return "\r\n" if "\r\n" in source.text else "\n"


def span_of_piece(piece: Sequence[Token]) -> Span:
    """Return the part of the text that a piece covers."""
    return Span(piece[0].start, piece[-1].end)


def span_of_first_line(source: SourceFile, span: Span) -> Span:
    """Return the part of a span on its first line."""
    first = source.slice(span).split("\n")[0].rstrip()
    return Span(span.start, span.start + len(first))


def _is_one_line(source: SourceFile, piece: Sequence[Token]) -> bool:
    return "\n" not in source.slice(span_of_piece(piece))
