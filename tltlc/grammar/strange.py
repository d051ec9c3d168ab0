"""Signs and words that the language does not know, many of them from a word processor."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.habits import equality
from tltlc.grammar.lexer import BAD
from tltlc.grammar.place import Place, shown
from tltlc.grammar.punctuation import left_out
from tltlc.grammar.rewording import reworded
from tltlc.grammar.tables import load
from tltlc.grammar.words import CASES
from tltlc.source import Span

_QUOTES: Final = frozenset("\"'`´‘’‚“”„«»")
_SIGNS: Final = {"−": "-", "×": "*", "÷": "/", "≔": "=", "°": "deg"}
"""What stands for a sign from elsewhere, beside what Unicode knows of its form."""
_HELPS: Final = {
    "#": "comments begin with `//`",
    "~": "for `not` write `not` or `!`",
    "%": "a percentage follows a number, as in `50%`",
    "≠": "write `a < b or a > b`; a `bool` signal is an atom by itself",
}


def strange(place: Place) -> Diagnostic | None:
    """A sign or word that the language does not know."""
    token = place.found
    if token.type != BAD:
        return None
    text = token.text
    if text in ("==", "!="):
        return equality(place)
    if text.startswith('"'):
        return place.error("TLT0114", "this text in quotes never ends", 'write the missing `"` on the same line')
    if text.startswith("/*"):
        span = Span(token.start, token.start + 2)
        help_ = "comments begin with `//` and end with the line"
        return place.error("TLT0104", "`/*` means nothing here", help_, span=span)
    if len(text) > 1 or text.isalnum():
        return _name(place)
    if text in _QUOTES:
        return _quotes(place)
    if text == "?" and place.tokens[0].type == "PREDICATE":
        return place.error("TLT0104", "`?` means nothing here", CASES)
    if text == ".":
        after = place.tokens[place.stop.index + 1]
        number = after.type == "NUMBER" and after.start == token.end
        help_ = f"write `0.{after.text}`" if number else left_out(place)
        span = Span(token.start, after.end) if number else token.span
        return place.error("TLT0104", "`.` means nothing here", help_, span=span)
    if text == ";":
        after = place.tokens[place.stop.index + 1]
        listed = "COMMA" in place.allowed and after.type == "NAME"
        return place.error("TLT0104", "`;` means nothing here", "write `,`" if listed else left_out(place))
    return place.error("TLT0104", f"{_sign(text)} means nothing here", _HELPS.get(text) or _like(text))


def _name(place: Place) -> Diagnostic:
    """``café``."""
    from unicodedata import normalize

    text = place.found.text
    plain = "".join(sign for sign in normalize("NFKD", text) if sign.isascii())
    close = f": write `{plain}`" if plain.isidentifier() and len(plain) == len(text) else ""
    help_ = f"names are ASCII letters, digits and `_`{close}"
    return place.error("TLT0104", f"{shown(place.found)} is no name", help_)


def _quotes(place: Place) -> Diagnostic:
    """``near('door')`` and typographic quotes."""
    at, tokens = place.stop.index, place.tokens
    last = next((index for index in range(at + 1, len(tokens)) if tokens[index].text in _QUOTES), None)
    title = f"{_sign(place.found.text)} means nothing here"
    if last is not None:
        inner = place.source.slice(Span(place.found.end, tokens[last].start)).strip()
        for text, reason in ((inner, ": no quotes around names and formulas"), (f'"{inner}"', "")):
            found = reworded(place, at, last + 1, text, title, reason, "TLT0104") if inner else None
            if found:
                return found
    return place.error("TLT0104", title, 'texts stand in straight double quotes: "…"')


def _sign(text: str) -> str:
    """A sign, by its number and name where it cannot be seen."""
    if text.isprintable() and not text.isspace():
        return f"`{text}`"
    from unicodedata import name

    said = name(text, "").lower()
    return f"`U+{ord(text):04X}`" + (f" ({said})" if said else "")


def _like(text: str) -> str:
    """What the language has instead of a sign that looks like one of its own."""
    from unicodedata import category, normalize

    plain = _SIGNS.get(text) or normalize("NFKC", text)
    if plain in load().signs or plain in load().units:
        return f"write `{plain}`"
    return "write `-` for a difference, `_` in a name" if category(text) == "Pd" else "leave it out"
