"""Explain characters and words that the language does not know, such as typographic quotes and ``café``."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CASES
from tltlc.grammar.lexer import BAD
from tltlc.grammar.mistakes.equalities import equality
from tltlc.grammar.mistakes.parse_failure import ParseFailure
from tltlc.grammar.mistakes.punctuation import leave_out_help, text_without_quotes
from tltlc.grammar.mistakes.rephrasing import suggest_rewrite
from tltlc.grammar.tables import load

_QUOTES: Final = frozenset("\"'`´‘’‚“”„«»")
_SIGNS: Final = {"−": "-", "×": "*", "÷": "/", "≔": "=", "°": "deg"}
"""Maps foreign characters to their equivalents in the language. Unicode normalization finds more of them."""
_SUPERSCRIPTS: Final = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_NO_REMAINDER: Final = (
    "there is no remainder: name the numbers, as in `times(a) == 3 or times(a) == 6`, or let the game record it as a "
    "signal"
)
_HELPS: Final = {
    "#": "comments begin with `//`",
    "%": "write a number before `%`, as in `50%`",
}


def unknown_sign(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if parsing failed at a character or word that the language does not know, else None."""
    token = failure.token
    if token.type != BAD:
        return None
    text = token.text
    if text in ("==", "!=", "≠"):
        return equality(failure)
    if text.startswith('"'):
        return failure.error("TLT0114", "this text in quotes never ends", 'write the missing `"` on the same line')
    if text.startswith("/*"):
        span = Span(token.start, token.start + 2)
        help_ = "comments begin with `//` and end with the line"
        return failure.error("TLT0104", "`/*` means nothing here", help_, span=span)
    if len(text) > 1 or text.isalnum():
        return _invalid_word(failure)
    if text in _QUOTES:
        return _foreign_quotes(failure)
    if text == "?" and failure.tokens[0].type == "PREDICATE":
        return failure.error("TLT0104", "`?` means nothing here", CASES)
    if text == ".":
        after = failure.tokens[failure.stop.index + 1]
        is_fraction = after.type == "NUMBER" and after.start == token.end
        write = f"0.{after.text}" if is_fraction else None
        span = Span(token.start, after.end) if is_fraction else token.span
        help_ = f"write `{write}`" if write else leave_out_help(failure)
        return failure.error("TLT0104", "`.` means nothing here", help_, span=span, write=write)
    if text == ";":
        after = failure.tokens[failure.stop.index + 1]
        is_separator = "COMMA" in failure.allowed_terminals and after.type == "NAME"
        help_ = "write `,`" if is_separator else leave_out_help(failure)
        return failure.error("TLT0104", "`;` means nothing here", help_, write="," if is_separator else None)
    title = f"{_quote_sign(text)} means nothing here"
    if text == "%" and failure.tokens[failure.stop.index + 1].type == "NUMBER":
        return failure.error("TLT0104", title, _NO_REMAINDER)
    if text == "~":
        return failure.error("TLT0104", title, "for `not` write `not` or `!`", write="not")
    equivalent = _equivalent_of(text)
    if text in _HELPS or equivalent is None:
        return failure.error("TLT0104", title, _HELPS.get(text) or _no_equivalent_help(text))
    return failure.error("TLT0104", title, f"write `{equivalent}`", write=equivalent)


def _invalid_word(failure: ParseFailure) -> Diagnostic:
    """Return the error for a word with characters that no name has, such as ``café`` and ``coins²``."""
    from unicodedata import normalize

    text = failure.token.text
    base = text.rstrip(_SUPERSCRIPTS)
    if base != text and (not base or (base.isascii() and base.isidentifier())):
        power = f"{base}^{normalize('NFKC', text[len(base) :])}"
        title = f"a name cannot contain `{text[len(base) :]}`" if base else f"`{text}` means nothing here"
        return failure.error("TLT0104", title, f"for a power write `{power}`", write=power)
    plain = "".join(character for character in normalize("NFKD", text) if character.isascii())
    write = plain if plain.isidentifier() and len(plain) == len(text) else None
    help_ = "names consist of ASCII letters, digits and `_`" + (f": write `{write}`" if write else "")
    foreign = next((character for character in text if not character.isascii()), text)
    return failure.error("TLT0104", f"a name cannot contain `{foreign}`", help_, write=write)


def _foreign_quotes(failure: ParseFailure) -> Diagnostic:
    """Return the error for quotes other than ``"``, as in ``near('door')``."""
    at, tokens = failure.stop.index, failure.tokens
    last = next((index for index in range(at + 1, len(tokens)) if tokens[index].text in _QUOTES), None)
    title = f"{_quote_sign(failure.token.text)} means nothing here"
    if last is not None:
        inner = failure.source.slice(Span(failure.token.end, tokens[last].start)).strip()
        for text, reason in (
            (text_without_quotes(failure, at, last + 1, inner), ": no quotes around names and formulas"),
            (f'"{inner}"', ""),
        ):
            diagnostic = suggest_rewrite(failure, at, last + 1, text, title, reason, "TLT0104") if inner else None
            if diagnostic:
                return diagnostic
    return failure.error("TLT0104", title, 'put texts in straight double quotes: "…"')


def _quote_sign(text: str) -> str:
    """Return a character in backticks; for an invisible one, its code point and name: "`U+00A0` (no-break space)"."""
    if text.isprintable() and not text.isspace():
        return f"`{text}`"
    from unicodedata import name

    description = name(text, "").lower()
    return f"`U+{ord(text):04X}`" + (f" ({description})" if description else "")


def _equivalent_of(text: str) -> str | None:
    """Return the sign or unit of the language that a character stands for, or None."""
    from unicodedata import normalize

    normalized = _SIGNS.get(text) or normalize("NFKC", text)
    return normalized if normalized in load().signs or normalized in load().units else None


def _no_equivalent_help(text: str) -> str:
    """Return the help for a character without an equivalent in the language."""
    from unicodedata import category

    return "write `-` for a difference, `_` in a name" if category(text) == "Pd" else "leave it out"
