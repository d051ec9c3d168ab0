"""The error for a name that has become a word of the language, with a fix that renames it in the whole file."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, Edit, Fix
from tltlc.grammar.lexer import Token, tokenize
from tltlc.grammar.mistakes.parse_failure import ParseFailure
from tltlc.grammar.tables import load

_OPERANDS: Final = frozenset(
    """
    NAME NUMBER NOT ALL ANY TRUE FALSE EVENTUALLY ALWAYS NEXT WEAK_NEXT ONCE HISTORICALLY PREVIOUSLY BEGINS ENDS
    """.split()
)
"""The terminals that follow an operator about the past, but no name."""
_WITH_PARAMETERS: Final = ("SIGNAL", "PREDICATE", "LET")


def word_of_the_past(failure: ParseFailure) -> Diagnostic:
    """Return the error for a word such as ``once`` where a name is expected.

    Older texts may use it as a name. If the file never uses it as an operator, the error has a fix that
    renames it everywhere in the file.
    """
    word = failure.token.text
    tokens = tokenize(failure.source.text).tokens
    new = _free_name(word, tokens)
    title = f"`{word}` is a word of the language now, not a name"
    help_ = f"rename it everywhere, for example to `{new}`"
    error = failure.error("TLT0106", title, help_)
    if _is_operator(word, tokens):
        return error
    edits = tuple(Edit(token.span, new) for token in tokens if token.text == word)
    return replace(error, fixes=(Fix(f"Rename `{word}` to `{new}` in this file", edits),))


def _is_operator(word: str, tokens: Sequence[Token]) -> bool:
    """Whether a file uses a word as an operator, at least in one place."""
    is_call = any(
        token.text == word and before.type in _WITH_PARAMETERS and after.type == "LPAR"
        for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False)
    )
    return any(
        token.text == word
        and (
            (first.type in _OPERANDS and first.text not in load().soft)
            or (first.type == "LPAR" and not is_call)
            or (first.text in ("within", "for") and second.type == "NUMBER")
        )
        for token, first, second in zip(tokens, tokens[1:], [*tokens[2:], tokens[-1]], strict=False)
    )


def _free_name(word: str, tokens: Sequence[Token]) -> str:
    taken = {token.text for token in tokens}
    return next(name for number in count(1) if (name := f"{word}_{number if number > 1 else ''}") not in taken)
