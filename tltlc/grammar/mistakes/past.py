"""Explain English about the trace so far: `was seen`, `seen at most 3 times`, `seen in the last 5 s`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import END
from tltlc.grammar.mistakes.counts_in_words import count_in_words
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK
from tltlc.grammar.mistakes.english_times import time_at
from tltlc.grammar.mistakes.parse_failure import ARITHMETIC, CLOSING, INFIX, ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    operand_end,
    operand_start,
    suggest_rewrite,
    text_of,
)

_LETTERS: Final = {"Y": "previously", "O": "once", "H": "historically"}
"""The letters of past operators in the literature."""
_HAS_HELD: Final = ("was", "were", "had", "has", "have", "been", "ever", "already")
_AUXILIARIES: Final = ("had", "has", "have")
"""Words that mean `once` only before `been` or with `before`: a predicate may be called `has`."""
_AT_THE_END: Final = (
    "write `keep {p}` if it must hold at every step, `require eventually always {held}` if it must have held for that "
    "time when the play ends"
)
"""The readings of `keep seen for the last 5 s`."""


def past_in_english(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for an English phrase about the trace so far, else None."""
    if not failure.wants_operator or failure.previous_token is None or failure.tokens[0].type == "PREDICATE":
        return None
    return count_in_words(failure) or _recent(failure) or _prefix(failure) or _postfix(failure)


# --- times ------------------------------------------------------------------------------------------


def _recent(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a formula such as ``seen in the last 5 s``, else None."""
    at, tokens = failure.stop.index, failure.tokens
    words = [token.text for token in tokens[at : at + 3]]
    if words[:1] not in (["in"], ["within"], ["during"], ["for"]) or words[1:] not in (
        ["the", "last"],
        ["the", "past"],
    ):
        return None
    time, start = time_at(tokens, at + 3), operand_start(tokens, at)
    if time is None or start is None:
        return None
    length, end = time
    if failure.lacks_fixed_clock(length.text):
        return failure.error("TLT0101", failure.misplaced(failure.token), FIXED_CLOCK)
    operand = text_of(failure, start, at)
    text = f"once within {length.text} {operand}"
    title, before = failure.misplaced(failure.token), tokens[start - 1].type
    if words[0] == "for":
        window = f"historically for {length.text} {operand}"
        text = f"time_holding({operand}) >= {length.text}" if length.is_real else window
        if tokens[0].text in ("keep", "require"):
            if _is_whole_clause(failure, start, end):
                return failure.error("TLT0101", title, _AT_THE_END.format(p=operand, held=text))
            # At the first steps, nothing can have held for that time.
            text = text if before == "NOT" else window
    # After `and`, the time may be that of both; `not a for …` may be that of `not a`.
    if start == formula_start(failure) or before == "IMPLIES" or (before == "NOT" and words[0] != "for"):
        return suggest_rewrite(failure, start, end, text, title)
    return failure.error("TLT0101", title, f"if the time is that of `{operand}` alone, write `{text}`")


def _is_whole_clause(failure: ParseFailure, start: int, end: int) -> bool:
    """Whether the tokens from one index to another are all that stands behind the keyword, perhaps in brackets."""
    around = (*failure.tokens[1:start], *failure.tokens[end:-1])
    return failure.start == "clause" and all(token.type in ("LPAR", "RPAR") for token in around)


# --- words ------------------------------------------------------------------------------------------


def _prefix(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a word before its formula, such as ``was seen`` and ``Y seen``, else None."""
    at, tokens, declared = failure.stop.index - 1, failure.tokens, declared_names(failure.source)
    word = tokens[at].text
    end = operand_end(tokens, at + 1)
    if tokens[at].type != "NAME" or end is None:
        return None
    if word in _AUXILIARIES and _is_before(failure, end):
        operand = text_of(failure, at + 1, end)
        if word in declared.names:
            operand = f"{word}({operand})"
        return _before_error(failure, end, "p" if declared.has_imports else operand)
    if word in declared.names:
        return None
    operand, title = text_of(failure, at + 1, end), failure.misplaced(tokens[at])
    if word in _LETTERS and not declared.has_imports:
        return suggest_rewrite(failure, at, end, f"{_LETTERS[word]} {operand}", title)
    if word == "previous":
        around = {tokens[end].type, tokens[at - 1].type if at else ""}
        text = f"previous({operand})" if around & ARITHMETIC else f"previously {operand}"
        return suggest_rewrite(failure, at, end, text, "`previous` takes brackets" if around & ARITHMETIC else title)
    if word in _HAS_HELD and (word not in _AUXILIARIES or tokens[at + 1].text == "been"):
        first = next(index for index in range(at, len(tokens)) if tokens[index].text not in _HAS_HELD)
        if (end := operand_end(tokens, first)) is not None:
            return failure.error("TLT0101", title, _once_help(text_of(failure, first, end)), span=tokens[at].span)
    return None


def _once_help(operand: str) -> str:
    return f"write `once {operand}`, which is true from the first step with `{operand}` on"


def _postfix(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a word after its formula, such as ``seen S alarm``, ``seen begins`` and ``seen before``."""
    at, tokens = failure.stop.index, failure.tokens
    start, word = operand_start(tokens, at), failure.token.text
    if start is None:
        return None
    title, declared = failure.misplaced(failure.token), declared_names(failure.source)
    may_be_name = word in declared.names or declared.has_imports
    if word == "S" and not may_be_name and (end := operand_end(tokens, at + 1)) is not None:
        text = f"{text_of(failure, start, at)} since {text_of(failure, at + 1, end)}"
        return suggest_rewrite(failure, start, end, text, title)
    if word in ("begins", "ends") and operand_end(tokens, at + 1) is None:
        title = f"{quote_token(failure.token)} stands before its formula"
        name = text_of(failure, start, at)
        known = declared_names(failure.source).names.get(name)
        if known is not None and known.type == "int":
            return suggest_rewrite(failure, start, at + 1, f"{name} != previous({name})", title)
        return suggest_rewrite(failure, start, at + 1, f"{word} {text_of(failure, start, at)}", title)
    if _is_before(failure, at):
        return _before_error(failure, at, text_of(failure, start, at))
    if word == "already":
        return failure.error("TLT0101", title, _once_help(text_of(failure, start, at)))
    return None


def _is_before(failure: ParseFailure, at: int) -> bool:
    """Whether the word `before` stands at an index, and nothing after it that it could come before."""
    tokens = failure.tokens
    return tokens[at].text == "before" and tokens[at + 1].type in {END, *CLOSING, *INFIX}


def _before_error(failure: ParseFailure, at: int, operand: str) -> Diagnostic:
    """Return the error for the word `before` at an index, which follows ``operand``."""
    help_ = (
        f"write `once {operand}` if it may hold now or have held at any step before, `previously {operand}` if it must "
        "have held at the step right before this one"
    )
    word = failure.tokens[at]
    return failure.error("TLT0101", failure.misplaced(word), help_, span=word.span)
