"""Limit how deep the expressions of a text may nest, so that all later stages can walk them recursively."""

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
"""The most brackets that may be open at once."""

MAX_DEPTH: Final = 1000
"""The greatest depth of an expression's tree, in nodes.

A chain such as ``a & b & c`` is nested, too.
"""

_OPENING = {"LPAR", "LSQB", "LBRACE"}
_CLOSING = {"RPAR", "RSQB", "RBRACE"}


def bracket_depth_error(source: SourceFile, tokens: Sequence[Token]) -> Diagnostic | None:
    """Return an error for the first bracket that makes more than MAX_BRACKETS open at once, or None."""
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


def expression_depth_error(source: SourceFile, expression: Expr) -> Diagnostic | None:
    """Return an error if the tree of an expression is deeper than MAX_DEPTH, else None; does not recurse."""
    level: list[Expr] = [expression]
    for _ in range(MAX_DEPTH):
        level = [child for parent in level for child in children(parent)]
        if not level:
            return None
    start = expression.span.start
    title = f"more than {MAX_DEPTH} operators in one chain"
    return _error(source, title, Span(start, start + 1))


def drop_deep_declarations(
    source: SourceFile, declarations: Iterable[Declaration]
) -> tuple[tuple[Declaration, ...], list[Diagnostic]]:
    """Drop the declarations, and the clauses of specs, with an expression that nests too deep.

    Return the other declarations, and an error for each declaration or clause that was dropped. If all
    clauses of a spec are dropped, so is the spec; a spec that has none is kept.
    """
    kept: list[Declaration] = []
    diagnostics: list[Diagnostic] = []
    for declaration in declarations:
        # Each level takes at least one character, so a short declaration needs no check. Nearly all are short.
        if declaration.span.end - declaration.span.start <= MAX_DEPTH:
            kept.append(declaration)
        elif isinstance(declaration, tree.SpecDecl):
            clauses, errors = drop_deep_clauses(source, declaration.clauses)
            diagnostics += errors
            if clauses or not declaration.clauses:
                kept.append(replace(declaration, clauses=clauses))
        else:
            errors = [error for part in expressions(declaration) if (error := expression_depth_error(source, part))]
            diagnostics += errors[:1]
            if not errors:
                kept.append(declaration)
    return tuple(kept), diagnostics


def drop_deep_clauses(
    source: SourceFile, clauses: Iterable[tree.Clause]
) -> tuple[tuple[tree.Clause, ...], list[Diagnostic]]:
    """Drop the clauses whose formulas nest too deep; return the other clauses, and an error for each dropped clause."""
    kept: list[tree.Clause] = []
    diagnostics: list[Diagnostic] = []
    for clause in clauses:
        error = None if isinstance(clause.value, tuple) else expression_depth_error(source, clause.value)
        if error:
            diagnostics.append(error)
        else:
            kept.append(clause)
    return tuple(kept), diagnostics


def _error(source: SourceFile, title: str, span: Span) -> Diagnostic:
    help_ = "give a part of it a name with `let`, and use the name"
    return Diagnostic("TLT0103", title, (Label(source, span),), help_)
