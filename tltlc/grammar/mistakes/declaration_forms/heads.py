"""Read the beginning of specs in other forms: ``rule x {``, ``spec "name" {``, ``spec name: reach a``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.keywords import CLAUSES
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.declaration_forms.meant import Cursor
from tltlc.grammar.mistakes.declaration_forms.ranges import name_for
from tltlc.grammar.tables import load

SPEC_WORDS: Final = frozenset(
    """
    rule property specification objective mission quest contract formula requirement constraint task
    goal plan scenario behavior behaviour assert theorem
    """.split()
)
_SIGNS: Final = (":", "=", "->", ":=")


@record
class SpecHead:
    """The beginning of a spec in another form.

    ``text`` is what it should be: ``spec NAME {`` or ``spec NAME =``. It replaces the first ``length``
    tokens of the piece. ``closes`` says whether a brace is missing after the last token. ``has_name``
    is false if the author wrote no name, so that the text has a made-up one.
    """

    text: str
    name: str
    length: int
    closes: bool
    has_name: bool = True


def read_head(piece: Sequence[Token]) -> SpecHead | None:
    """Return how the spec that a piece is meant as begins; None if it begins as it should, or is no spec."""
    cursor = Cursor(piece)
    if not cursor.accept("spec", *SPEC_WORDS):
        return None
    name = None
    if cursor.token.type in ("NAME", "STRING"):
        name = _name(cursor)
        if name is None:
            return None
    if cursor.token.text == "(" and cursor.peek(1).text == ")":
        cursor.at += 2
    sign = cursor.token.text
    sign = sign if cursor.accept(*_SIGNS) else ""
    opens = cursor.accept("{")
    is_clause = cursor.token.text in CLAUSES and cursor.token.type != "NAME"
    if cursor.is_done or not (opens or is_clause or (sign and name)):
        return None
    written = [token.text for token in piece[: cursor.at]]
    if written == ["spec", name, "{"] or (written == ["spec", name, "="] and not is_clause):
        return None
    if opens or is_clause:
        closes = not opens and piece[-1].type != "RBRACE"
        return SpecHead(f"spec {name or 'NAME'} {{", name or "NAME", cursor.at, closes, name is not None)
    return SpecHead(f"spec {name} =", str(name), cursor.at, False)


def _name(cursor: Cursor) -> str | None:
    """Read a name, perhaps in quotes or with hyphens; return it as a name of the language."""
    parts = [cursor.token.text]
    cursor.at += 1
    while cursor.token.text == "-" and cursor.peek(1).type in ("NAME", "NUMBER"):
        parts.append(cursor.peek(1).text)
        cursor.at += 2
    name = name_for("_".join(parts))
    return f"{name}_" if name in load().words else name
