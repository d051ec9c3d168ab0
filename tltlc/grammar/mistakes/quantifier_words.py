"""Explain quantifiers in other words: `for all g in guards: p`, `forall g in guards: p`, `p for each g in guards`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import END
from tltlc.grammar.mistakes.one_reading import has_token
from tltlc.grammar.mistakes.parse_failure import INFIX, ParseFailure
from tltlc.grammar.mistakes.rephrasing import formula_start, span_of, suggest_rewrite, text_of

_WORDS: Final[Mapping[tuple[str, ...], str]] = {
    **dict.fromkeys((("for", "all"), ("for", "each"), ("for", "every"), ("forall",), ("each",), ("every",)), "all"),
    **dict.fromkeys((("there", "exists"), ("exists",), ("for", "some"), ("some",)), "any"),
    ("for", "any"): "",
}
"""Maps words before a variable to the quantifier; "" for words that may mean either."""
_BOTH: Final = "write `all {head}` if it must hold for each of them, `any {head}` if for at least one"


def quantifier_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a quantifier in the words of English or of logic, else None."""
    tokens, at = failure.tokens, failure.stop.index
    for start in range(max(formula_start(failure), at - 2), at + 1):
        for phrase, word in _WORDS.items():
            variable = start + len(phrase)
            texts = tuple(token.text.lower() for token in tokens[start:variable])
            if texts != phrase or variable + 2 >= len(tokens) or tokens[variable + 1].text != "in":
                continue
            written = " ".join(phrase)
            title = f"the language has no words `{written}`"
            if start > formula_start(failure) and tokens[start - 1].type not in {*INFIX, "NOT", "LPAR"}:
                return _after_its_formula(failure, start, variable, word, title)
            head = text_of(failure, variable, variable + 3)
            if not word:
                return failure.error("TLT0101", title, _BOTH.format(head=head), span=span_of(tokens[start:variable]))
            diagnostic = suggest_rewrite(failure, start, variable, word, title)
            help_ = f"the form is `{word} {head}: p`"
            return diagnostic or failure.error("TLT0101", title, help_, span=span_of(tokens[start:variable]))
    return None


def _after_its_formula(failure: ParseFailure, start: int, variable: int, word: str, title: str) -> Diagnostic:
    """Return the error for a quantifier after its formula, as in ``p for all g in guards``."""
    tokens, first, stop = failure.tokens, formula_start(failure), len(failure.tokens) - 1
    head, span = text_of(failure, variable, stop), span_of(tokens[start:variable])
    is_whole = tokens[stop].type == END and not failure.open_brackets and not has_token(failure, first, stop, INFIX)
    if word and is_whole:
        text = f"{word} {head}: {text_of(failure, first, start)}"
        diagnostic = suggest_rewrite(failure, first, stop, text, title)
        if diagnostic is not None:
            return diagnostic
    help_ = f"a quantifier stands before its formula: `{word or 'all'} x in (a, b): p`"
    return failure.error("TLT0101", title, help_, span=span)
