"""What to say where a text cannot be read on: what was expected, in plain words, and how to mend it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar import lalr
from tltlc.grammar.habits import HABITS, SYNONYMS
from tltlc.grammar.lexer import BAD, Token
from tltlc.grammar.place import COMPARISONS, INFIX, KEYWORDS, NOUNS, OPENING, UNTILS, Place, shown
from tltlc.grammar.tables import load
from tltlc.grammar.words import CLAUSES, DECLARATIONS, TEST_ITEMS, closest
from tltlc.source import SourceFile

_NEXTS: Final = {"X", "N", "next", "weak_next", "○"}
_BOUNDED: Final = {"F", "G", "eventually", "always", "<>", "[]", "◇", "□", *_NEXTS}
_EQUAL: Final = "write `a >= b and a <= b`; a bool signal is an atom by itself"


def unexpected(source: SourceFile, tokens: Sequence[Token], error: lalr.UnexpectedTokenError, start: str) -> Diagnostic:
    """The error for a token that fits nowhere; ``tokens`` are those of one piece, read as a ``start``."""
    place = Place(source, tokens, error, start)
    for rule in _RULES:
        diagnostic = rule(place)
        if diagnostic:
            return diagnostic
    return place.error("TLT0101", place.expectation(), place.form())


def never_closed(source: SourceFile, opening: Token) -> Diagnostic:
    """The error for a bracket without its partner."""
    closing = {"(": ")", "[": "]", "{": "}"}[opening.text]
    title = f"this `{opening.text}` is never closed"
    return Diagnostic("TLT0105", title, (Label(source, opening.span),), f"write the missing `{closing}`")


def _strange(place: Place) -> Diagnostic | None:
    """A sign or word that the language does not know."""
    token = place.found
    if token.type != BAD:
        return None
    text = token.text
    if text in ("==", "!="):
        help_ = _EQUAL if text == "==" else "write `a < b or a > b`; a bool signal is an atom by itself"
        return place.error("TLT0110", f"`{text}` does not compare here", help_)
    if text.startswith('"'):
        return place.error("TLT0114", "this text in quotes never ends", 'write the missing `"` on the same line')
    if text == "/*":
        return place.error("TLT0104", "`/*` means nothing here", "comments begin with `//` and end with the line")
    if text[0].isalpha():
        return place.error("TLT0104", f"{shown(token)} is no name", "names are ASCII letters, digits and `_`")
    helps = {
        ";": "leave it out: nothing is needed between clauses",
        "'": 'texts stand in double quotes: "…"',
        "“": 'texts stand in straight double quotes: "…"',
        "”": 'texts stand in straight double quotes: "…"',
        "#": "comments begin with `//`",
        "~": "for `not` write `not` or `!`",
        ".": "a number has a digit on both sides of its point, as in `0.5`",
        "%": "a percentage follows a number, as in `50%`",
    }
    sign = text if text.isprintable() else f"U+{ord(text):04X}"
    return place.error("TLT0104", f"`{sign}` means nothing here", helps.get(text, "leave it out"))


def _equality(place: Place) -> Diagnostic | None:
    """A single ``=`` where a comparison was meant."""
    expectation = place.tokens[0].text == "expect"
    if place.found.type != "EQUAL" or not (place.wants_operator or expectation):
        return None
    help_ = "compare with `<`, `<=`, `>` or `>=`" if expectation else _EQUAL
    return place.error("TLT0110", "`=` does not compare", help_)


def _chained(place: Place) -> Diagnostic | None:
    """``a < b < c``."""
    if place.found.type not in COMPARISONS or not place.wants_operator:
        return None
    return place.error("TLT0110", "comparisons cannot be chained", "write `a < b and b < c`")


def _unknown_keyword(place: Place) -> Diagnostic | None:
    """A piece that begins with no keyword of its kind."""
    keywords = KEYWORDS.get(place.start)
    if place.stop.index or not keywords or place.at_end:
        return None
    token, noun = place.found, NOUNS[place.start]
    if token.type in OPENING.values():
        return None
    if place.start == "declaration" and token.text in CLAUSES:
        help_ = f"put it into one: `spec NAME {{ {token.text} … }}`"
        return place.error("TLT0107", f"`{token.text}` stands only inside a spec", help_)
    if place.start == "declaration" and token.text in TEST_ITEMS:
        help_ = f"put it into one: {DECLARATIONS['test']}"
        return place.error("TLT0107", f"`{token.text}` stands only inside a test", help_)
    near = SYNONYMS[place.start].get(token.text.lower())
    if near is None and token.type == "NAME":
        near = closest(token.text, tuple(keywords))
    message = f"did you mean `{near}`?" if near else ""
    listed = ", ".join(f"`{word}`" for word in keywords)
    title = f"no {noun} begins with {shown(token)}"
    return place.error("TLT0107", title, None if near else f"one of {listed}", message)


def _brackets(place: Place) -> Diagnostic | None:
    """A bracket without its partner."""
    token = place.found
    if token.type in OPENING.values():
        opening = place.open_brackets[-1] if place.open_brackets else None
        if opening is None:
            return place.error("TLT0105", f"this `{token.text}` closes nothing", "leave it out")
        if OPENING[opening.type] != token.type and OPENING[opening.type] in place.allowed:
            return never_closed(place.source, opening)
        return None
    if place.at_end and place.open_brackets and OPENING[place.open_brackets[-1].type] in place.allowed:
        return never_closed(place.source, place.open_brackets[-1])
    return None


def _bounds(place: Place) -> Diagnostic | None:
    """A bound without a unit, with a name for a number, or behind an operator that takes none."""
    before = place.before
    if place.found.type == "NAME" and before and _is_bound(place):
        example = "F[0, 20]" if before.text in ("[", ",") else f"{before.text} 20 steps"
        title = f"a bound is a number, and {shown(place.found)} is a name"
        return place.error("TLT0111", title, f"write the number, e.g. `{example}`")
    if before and before.text in ("[", ",") and "NUMBER" in place.allowed and _is_bound(place):
        return _no_number(place)
    if place.allowed == {"UNIT"} and before:
        return place.error(
            "TLT0111", f"expected a unit after {shown(before)}", f"`{before.text} steps` or `{before.text} s`"
        )
    if place.found.type == "RSQB" and before and "COMMA" in place.allowed and _is_bound(place):
        return _one_end(place, before.text)
    if place.found.type == "LSQB" and before and before.type in UNTILS:
        help_ = "bound an `F` beside it: `(a U b) & F[0,20] b`"
        return place.error("TLT0111", f"`{before.text}` takes no bound", help_)
    return None


def _no_number(place: Place) -> Diagnostic:
    """``F[-1,2] p`` and ``X[!] p``."""
    operator = place.tokens[_opening(place) - 1].text
    if operator in _NEXTS:
        return place.error(
            "TLT0111",
            f"`{operator}` takes no bound in brackets",
            "leave the brackets out; `X` is false at the last step, `N` true",
        )
    return place.error("TLT0111", place.expectation(), f"count the steps from now on, e.g. `{operator}[0,20] p`")


def _one_end(place: Place, number: str) -> Diagnostic:
    """``F[20] p`` and ``next[20] p``."""
    operator = place.tokens[_opening(place) - 1].text
    if operator in _NEXTS:
        return place.error("TLT0111", f"`{operator}` takes no bound in brackets", f"`next after {number} steps p`")
    return place.error("TLT0111", "a bound has two ends", f"write `{operator}[0,{number}] p` for the time from now on")


def _opening(place: Place) -> int:
    """Where the innermost open bracket stands among the tokens."""
    opening = place.open_brackets[-1]
    return next(index for index, token in enumerate(place.tokens) if token is opening)


def _is_bound(place: Place) -> bool:
    """Whether a number of a bound should stand here, as in ``F[0,`` or ``eventually within``."""
    index = place.stop.index - 1
    if place.open_brackets and place.open_brackets[-1].text == "[":
        index = _opening(place)
    elif place.tokens[index].text not in ("within", "for", "after"):
        return False
    return index > 0 and place.tokens[index - 1].text in _BOUNDED


def _reserved(place: Place) -> Diagnostic | None:
    """A reserved word where a name should stand."""
    token = place.found
    if "NAME" not in place.allowed or token.text not in load().words:
        return None
    keyword = token.text in DECLARATIONS or token.text in CLAUSES
    if (place.wants_operand and not keyword) or (place.before and place.before.text == "expect"):
        return None
    help_ = f"choose another name, for example `{token.text.lower()}_`"
    if place.before and place.before.type == "IMPORT":
        help_ = f'name the file: `import "{token.text}.tltl"`'
    return place.error("TLT0106", f"`{token.text}` is a reserved word, not a name", help_)


def _missing_type(place: Place) -> Diagnostic | None:
    """``signal a: in [0, 1]``, where `in` was taken for the type."""
    before = place.before
    if place.found.type != "LSQB" or before is None or before.text != "in" or "LSQB" in place.allowed:
        return None
    return place.error("TLT0101", "expected a type after `:`", place.form(), span=before.span)


def _quantified_over(place: Place) -> Diagnostic | None:
    """``all x in a: p``, without brackets around the entities."""
    if place.allowed != {"LPAR"} or place.before is None or place.before.type != "IN":
        return None
    return place.error("TLT0101", place.expectation(), "the form is `all x in (a, b): p` or `any x in (a, b): p`")


def _misspelt_operator(place: Place) -> Diagnostic | None:
    """A name where an operator should stand."""
    before, token = place.before, place.found
    if token.type != "NAME" or not place.wants_operator or before is None:
        return None
    if re.fullmatch("[FGXN]{2,}", before.text):
        letters = " ".join(before.text)
        return place.error("TLT0101", f"`{before.text}` is read as one name", f"write `{letters}`", span=before.span)
    words = tuple(word for word, terminal in load().words.items() if terminal in INFIX and len(word) > 1)
    near = closest(token.text, words)
    if near is None:
        temporal = closest(before.text, tuple(word for word in load().words if len(word) > 3))
        if temporal and before.type == "NAME":
            message = f"did you mean `{temporal}`?"
            return place.error("TLT0101", f"`{before.text}` is no operator", None, message, before.span)
        return None
    return place.error("TLT0101", place.expectation(), None, f"did you mean `{near}`?")


_RULES: Final = (
    _strange,
    *HABITS,
    _equality,
    _chained,
    _unknown_keyword,
    _brackets,
    _bounds,
    _reserved,
    _missing_type,
    _quantified_over,
    _misspelt_operator,
)
