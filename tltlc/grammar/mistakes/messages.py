"""The message for a token that fits nowhere: what was expected, in plain words, and how to fix it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar import lalr
from tltlc.grammar.keywords import CASES, CLAUSES, DECLARATIONS, closest
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.clauses import CLAUSE_RULES
from tltlc.grammar.mistakes.english import compared, filler, plain_english
from tltlc.grammar.mistakes.fragments import is_first_on_line
from tltlc.grammar.mistakes.habits import HABITS, comment, side
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has
from tltlc.grammar.mistakes.place import BEFORE_ONE, INFIX, OPENING, OPERAND, UNTILS, Place, declares_clock, shown
from tltlc.grammar.mistakes.punctuation import PUNCTUATION, missing_comma
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop, reworded, span_of, written
from tltlc.grammar.mistakes.unknown_signs import strange
from tltlc.grammar.tables import load

_NEXTS: Final = {"NEXT", "WEAK_NEXT"}
_BOUNDED: Final = BEFORE_ONE - {"NOT"}


def unexpected(source: SourceFile, tokens: Sequence[Token], error: lalr.UnexpectedTokenError, start: str) -> Diagnostic:
    """Return the error for a token that fits nowhere; ``tokens`` are one piece, parsed as a ``start``."""
    place = Place(source, tokens, error, start)
    for rule in _RULES:
        diagnostic = rule(place)
        if diagnostic:
            return diagnostic
    return place.error("TLT0101", place.expectation(), place.form())


def never_closed(source: SourceFile, opening: Token) -> Diagnostic:
    """Return the error for a bracket that is never closed."""
    closing = {"(": ")", "[": "]", "{": "}"}[opening.text]
    title = f"this `{opening.text}` is never closed"
    return Diagnostic("TLT0105", title, (Label(source, opening.span),), f"write the missing `{closing}`")


def _brackets(place: Place) -> Diagnostic | None:
    """Report a bracket without its partner."""
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
    """Report a bound without a unit, with a name for a number, or after an operator that takes none."""
    before = place.before
    if place.found.type == "NAME" and before and _is_bound(place):
        example = "F[0, 20]" if before.text in ("[", ",") else f"{before.text} 20 steps"
        title = f"a bound is a number, and {shown(place.found)} is a name"
        return place.error("TLT0111", title, f"write the number, e.g. `{example}`")
    if before and before.text in ("[", ",") and "NUMBER" in place.allowed and _is_bound(place):
        return _no_number(place)
    if place.allowed == {"UNIT"} and before:
        help_ = f"write `{before.text} steps` or, with a clock, `{before.text} s`"
        title = f"expected a unit after {shown(before)}"
        write = None if declares_clock(place.source) else f"{before.text} steps"
        return place.error("TLT0111", title, help_, span=before.span, write=write)
    if place.found.type == "RSQB" and before and "COMMA" in place.allowed and _is_bound(place):
        return _one_end(place, before.text)
    if place.found.type == "LSQB" and before and before.type in UNTILS:
        help_ = "bound an `F` beside it: `(a U b) & F[0,20] b`"
        return place.error("TLT0111", f"`{before.text}` takes no bound", help_)
    return None


def _no_number(place: Place) -> Diagnostic:
    """Report ``F[-1,2] p`` and ``X[!] p``."""
    operator = place.tokens[_opening(place) - 1]
    if operator.type in _NEXTS:
        return place.error(
            "TLT0111",
            f"`{operator.text}` takes no bound in brackets",
            "leave the brackets out; `X` is false at the last step, `N` true",
        )
    return place.error("TLT0111", place.expectation(), f"count the steps from now on, e.g. `{operator.text}[0,20] p`")


def _one_end(place: Place, number: str) -> Diagnostic:
    """Report ``F[20] p`` and ``next[20] p``."""
    operator = place.tokens[_opening(place) - 1]
    if operator.type in _NEXTS:
        return place.error("TLT0111", f"`{operator.text}` takes no bound in brackets", f"`next after {number} steps p`")
    return place.error(
        "TLT0111", "a bound has two ends", f"write `{operator.text}[0,{number}] p` for the time from now on"
    )


def _opening(place: Place) -> int:
    """Return the index of the innermost open bracket among the tokens."""
    opening = place.open_brackets[-1]
    return next(index for index, token in enumerate(place.tokens) if token is opening)


def _is_bound(place: Place) -> bool:
    """Whether a number of a bound is expected here, as in ``F[0,`` or ``eventually within``."""
    index = place.stop.index - 1
    if place.open_brackets and place.open_brackets[-1].text == "[":
        index = _opening(place)
    elif place.tokens[index].text not in ("within", "for", "after"):
        return False
    return index > 0 and place.tokens[index - 1].type in _BOUNDED


def _reserved(place: Place) -> Diagnostic | None:
    """Report a reserved word where a name is expected."""
    token = place.found
    if "NAME" not in place.allowed or token.text not in load().words:
        return None
    is_keyword = token.text in DECLARATIONS or token.text in CLAUSES
    if (place.wants_operand and not is_keyword) or (place.before and place.before.text == "expect"):
        return None
    help_ = f"choose another name, for example `{token.text.lower()}_`"
    if place.before and place.before.type == "IMPORT":
        help_ = f'name the file: `import "{token.text}.tltl"`'
    return place.error("TLT0106", f"`{token.text}` is a reserved word, not a name", help_)


def _missing_type(place: Place) -> Diagnostic | None:
    """Report ``signal a: in [0, 1]``, where `in` was read as the type."""
    before = place.before
    if place.found.type != "LSQB" or before is None or before.text != "in" or "LSQB" in place.allowed:
        return None
    return place.error("TLT0101", "expected a type after `:`", place.form(), span=before.span)


def _quantified(place: Place) -> Diagnostic | None:
    """Report ``all x in a: p`` and ``all(p, q)``: an error in the head of a quantifier."""
    heads = [token for token in place.tokens[: place.stop.index] if token.type in ("ALL", "ANY", "COLON")]
    if not heads or heads[-1].type == "COLON":
        return None
    word, joined = heads[-1].text, "and" if heads[-1].type == "ALL" else "or"
    help_ = f"the form is `{word} x in (a, b): near(x)`; formulas are joined by `{joined}`"
    return place.error("TLT0101", place.expectation(), help_)


def _misspelt_operator(place: Place) -> Diagnostic | None:
    """Report a name where an operator is expected."""
    before, token = place.before, place.found
    if before is None or not place.wants_operator:
        return None
    if re.fullmatch("[FGXN]{2,}", before.text):
        letters = " ".join(before.text)
        title = f"`{before.text}` is read as one name"
        return place.error("TLT0101", title, f"write `{letters}`", span=before.span, write=letters)
    if token.text.lower() == "else":
        help_ = "`a or b` asks for one of both; of conditions, one follows the other in `when x > 3: 1 otherwise: -1`"
        return place.error("TLT0101", "`else` is no operator", help_)
    words = tuple(word for word, terminal in load().words.items() if terminal in INFIX and len(word) > 1)
    near = closest(token.text, words) if token.type == "NAME" else None
    if near and _is_before_operand(place):
        return place.error("TLT0101", place.expectation(), None, f"did you mean `{near}`?", write=near)
    operator = before.text.lower()
    if operator not in load().words and operator != "no":
        prefixes = (word for word, terminal in load().words.items() if terminal in {*BEFORE_ONE, "WHEN"})
        known = tuple(word for word in prefixes if len(word) > 3) if token.type == "NAME" else ()
        operator = closest(before.text, known) or ""
        # `exit` resembles `next` as much as a typo of it does, but begins with another letter.
        operator = operator if before.text[:1].lower() == operator[:1] or before.text.lower() == operator[1:] else ""
    if not operator or before.type != "NAME":
        return None
    title = f"`{before.text}` is no operator"
    if operator == "no" and has(place, place.stop.index, formula_stop(place), INFIX):
        return place.error("TLT0101", title, "`(not a) or b` is about one, `not (a or b)` about both")
    operator = "not" if operator == "no" else operator
    return place.error("TLT0101", title, None, f"did you mean `{operator}`?", before.span, write=operator)


def _is_before_operand(place: Place) -> bool:
    """Whether an operand, or an operator before one, comes after the token that fits nowhere."""
    after = place.tokens[place.stop.index + 1]
    return after.type in OPERAND | BEFORE_ONE


def _is(place: Place) -> Diagnostic | None:
    """Report ``seen is true`` and ``coins is more than 3``."""
    at, after = place.stop.index, [token.text for token in place.tokens[place.stop.index + 1 :]]
    if place.found.text not in ("is", "are") or not place.wants_operator or place.before is None or not after:
        return None
    title = f"{shown(place.found)} is no operator"
    start = side(place.tokens, at, -1)
    value = written(place, start, at)
    words = {"true": "{}", "false": "not {}", "not": "not {}"}
    diagnostic: Diagnostic | None = None
    if after[0] in words:
        stop = at + 2 + (after[0] == "not" and after[1:2] in (["true"], ["false"]))
        text = words[after[0]].format(value)
        # `a or b is false` and `always a is false` may mean all that stands before.
        is_clear = text == value or not has(place, formula_start(place), start, INFIX | BEFORE_ONE | QUANTIFIERS)
        if is_clear:
            diagnostic = reworded(place, start, stop, text, title, ": a `bool` signal is an atom by itself")
    help_ = f"`{value}` by itself says that it is true, `not {value}` that it is not; numbers compare by `<` and `>`"
    return diagnostic or place.error("TLT0101", title, help_)


def _otherwise(place: Place) -> Diagnostic | None:
    """Report ``when a: 1 else: 0``."""
    if place.found.text not in ("else", "default") or "OTHERWISE" not in place.allowed:
        return None
    return place.error("TLT0101", f"{shown(place.found)} begins no case", "write `otherwise`", write="otherwise")


def _cases(place: Place) -> Diagnostic | None:
    """Report ``when a then 1``, and ``when a: 1`` without the remaining cases."""
    if not any(token.type == "WHEN" for token in place.tokens[: place.stop.index]):
        return None
    return place.error("TLT0101", place.expectation(), CASES)


def _side_by_side(place: Place) -> Diagnostic | None:
    """Report ``near s1``."""
    before, token = place.before, place.found
    if before is None or token.type != "NAME" or not place.wants_operator or before.type not in ("NAME", "RPAR"):
        return None
    if is_first_on_line(place.source, place.tokens, place.stop.index):
        return None
    if before.type == "RPAR" or place.tokens[place.stop.index + 1].type == "LPAR":
        title = f"no operator between {shown(before)} and {shown(token)}"
        return place.error("TLT0101", title, "formulas are joined by `and`, `or` or `then`")
    if _is_before_operand(place):
        return place.error("TLT0101", f"{shown(token)} is no operator", "formulas are joined by `and`, `or` or `then`")
    text = f"{before.text}({token.text})"
    help_ = f"write `{text}` where the one is said of the other; else join them by `and` or `then`"
    title = f"{shown(before)} and {shown(token)} are not joined"
    return place.error("TLT0101", title, help_, span=span_of([before, token]), write=text)


def _operator_for_name(place: Place) -> Diagnostic | None:
    """Report ``keep next``."""
    if not place.wants_operand:
        return None
    for word, kinds, where in (
        (place.found, INFIX, "between two formulas"),
        (place.before, BEFORE_ONE, "before a formula"),
    ):
        if word and word.type in kinds and word.text.isalpha():
            help_ = f"{shown(word)} is an operator and stands {where}; it cannot be a name"
            return place.error("TLT0101", place.expectation(), help_)
    return None


_RULES: Final = (
    comment,
    strange,
    plain_english,
    compared,
    filler,
    _otherwise,
    *HABITS,
    *PUNCTUATION,
    *CLAUSE_RULES,
    _brackets,
    _bounds,
    _reserved,
    _missing_type,
    _quantified,
    _is,
    _misspelt_operator,
    missing_comma,
    _side_by_side,
    _operator_for_name,
    _cases,
)
