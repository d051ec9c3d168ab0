"""Describe the words about the trace so far under the mouse pointer: what they mean, and where a value stops."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.source import Span
from tltlc.grammar import past_words
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import expressions, parts
from tltlc.interfaces.lsp.document import Document
from tltlc.resolve.memory import is_memory, recall
from tltlc.resolve.problem import ResolutionError


def past_word(document: Document, offset: int) -> tuple[str, Span] | None:
    """Describe the operator or function about the past at an offset; return None at any other place.

    Return the description and the span of the word.
    """
    token = document.token_at(offset)
    if token is None:
        return None
    for part in _parts(document):
        if isinstance(part, (Unary, BinaryExpr)) and part.op_span == token.span and part.op in past_words.OPERATORS:
            return _text(past_words.OPERATORS[part.op]), token.span
        if isinstance(part, CallExpr) and part.span.start == token.start and is_memory(part, document.resolution.env):
            lines = [_text(past_words.FUNCTIONS[part.name]), *_maxima(document, part)]
            return "\n\n".join(lines), token.span
    return None


def _text(word: past_words.PastWord) -> str:
    return f"{' or '.join(f'`{form}`' for form in word.forms)}\n\n{word.meaning}"


def _parts(document: Document) -> Iterator[Expr]:
    for declaration in document.module.declarations:
        for expression in expressions(declaration):
            yield from parts(expression)


def _maxima(document: Document, call: CallExpr) -> Iterator[str]:
    """Yield a sentence for each spec of the document that says where the value of a call stops."""
    try:
        read = recall(call, document.resolution.env, 0).recall
    except ResolutionError:
        return
    if read is None:
        return
    for spec in document.resolution.program.specs:
        for register in spec.registers:
            if register.name == read.register and register.high is not None:
                yield f"In `{spec.name}`, it stops at {register.high:g}{f' {register.unit}' if register.unit else ''}."
