"""Limits on how deep a text may nest, so that every later stage can walk the tree by recursion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar import tree
from tltlc.grammar.lexer import Token
from tltlc.grammar.tree import Declaration, Expr
from tltlc.grammar.walk import children, expressions

MAX_BRACKETS: Final = 200
"""How many brackets may be open at once."""

MAX_DEPTH: Final = 1000
"""How many nodes may stand on a way through an expression's tree: chains of operators count, brackets or not."""

_OPENING = {"LPAR", "LSQB", "LBRACE"}
_CLOSING = {"RPAR", "RSQB", "RBRACE"}


def deep_brackets(source: SourceFile, tokens: Sequence[Token]) -> Diagnostic | None:
    """An error for the first bracket that nests too deep."""
    depth = 0
    for token in tokens:
        if token.type in _OPENING:
            depth += 1
            if depth > MAX_BRACKETS:
                title = f"brackets nest deeper than {MAX_BRACKETS}"
                return _error(source, title, token.span)
        elif token.type in _CLOSING:
            depth = max(0, depth - 1)
    return None


def deep_expression(source: SourceFile, expression: Expr) -> Diagnostic | None:
    """An error where operators chain too deep; takes no recursion."""
    level: list[Expr] = [expression]
    for _ in range(MAX_DEPTH):
        level = [child for parent in level for child in children(parent)]
        if not level:
            return None
    start = expression.span.start
    title = f"more than {MAX_DEPTH} operators in one chain"
    return _error(source, title, Span(start, start + 1))


def drop_deep(
    source: SourceFile, declarations: Iterable[Declaration]
) -> tuple[tuple[Declaration, ...], list[Diagnostic]]:
    """The declarations without those, or those of their clauses, that nest too deep, and an error for each."""
    kept: list[Declaration] = []
    found: list[Diagnostic] = []
    for declaration in declarations:
        # Each level takes a character: short declarations, so nearly all, need no look.
        if declaration.span.end - declaration.span.start <= MAX_DEPTH:
            kept.append(declaration)
        elif isinstance(declaration, tree.SpecDecl):
            clauses, errors = drop_deep_clauses(source, declaration.clauses)
            found += errors
            if clauses:
                kept.append(replace(declaration, clauses=clauses))
        else:
            errors = [error for part in expressions(declaration) if (error := deep_expression(source, part))]
            found += errors[:1]
            if not errors:
                kept.append(declaration)
    return tuple(kept), found


def drop_deep_clauses(
    source: SourceFile, clauses: Iterable[tree.Clause]
) -> tuple[tuple[tree.Clause, ...], list[Diagnostic]]:
    """The clauses without those that nest too deep, and an error for each of these."""
    kept: list[tree.Clause] = []
    found: list[Diagnostic] = []
    for clause in clauses:
        error = None if isinstance(clause.value, tuple) else deep_expression(source, clause.value)
        if error:
            found.append(error)
        else:
            kept.append(clause)
    return tuple(kept), found


def _error(source: SourceFile, title: str, span: Span) -> Diagnostic:
    help_ = "name a part of it with `let` and use the name"
    return Diagnostic("TLT0103", title, (Label(source, span),), help_)
