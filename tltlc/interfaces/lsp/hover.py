"""Describe the word under the mouse pointer of the editor."""

from __future__ import annotations

from pathlib import PurePath
from typing import Final

from lsprotocol import types

from tltlc.core.source import Span
from tltlc.grammar.keywords import CLAUSES, DECLARATIONS, TEST_ITEMS
from tltlc.grammar.tree import BinaryExpr, Clause, Expr, SpecDecl, Unary
from tltlc.grammar.walk import parts
from tltlc.interfaces.lsp.declaration_text import spec_markdown, symbol_markdown
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.durations import durations, steps_text
from tltlc.interfaces.lsp.lenses import figures_text
from tltlc.interfaces.lsp.past_hover import past_word
from tltlc.interfaces.lsp.positions import range_of
from tltlc.interfaces.lsp.slow_analysis import DocumentAnalysis
from tltlc.logic import formula as build
from tltlc.logic.text.english import english_text
from tltlc.resolve import formulas

_FORMS: Final = {**DECLARATIONS, **CLAUSES, **TEST_ITEMS}
_FORMULA_CLAUSES: Final = ("reach", "keep", "avoid", "require")
_LARGEST: Final = 2000
"""Formulas with more subformulas get no English sentence."""


def hover(document: Document, offset: int, analysis: DocumentAnalysis | None, encoding: str) -> types.Hover | None:
    """Describe the name, operator, duration or keyword at a character offset; return None at any other place.

    ``analysis`` has the size of each spec's automaton; None if it is not known. Columns are counted
    in units of ``encoding``, such as ``utf-16``.
    """
    description = (
        _name(document, offset, analysis)
        or past_word(document, offset)
        or _operator(document, offset)
        or _duration(document, offset)
        or _keyword(document, offset)
    )
    if description is None:
        return None
    text, span = description
    content = types.MarkupContent(types.MarkupKind.Markdown, text)
    return types.Hover(content, range_of(document.source, span, encoding))


def _name(document: Document, offset: int, analysis: DocumentAnalysis | None) -> tuple[str, Span] | None:
    name = document.name_at(offset)
    if name is None:
        return None
    symbol = name.symbol
    if isinstance(symbol.declaration, SpecDecl):
        spec = next(
            (candidate for candidate in document.resolution.program.specs if candidate.name == symbol.name), None
        )
        figures = next((entry for entry in analysis.figures if entry.spec == symbol.name), None) if analysis else None
        size_text = f"{figures_text(figures)}." if figures else None
        return spec_markdown(symbol.declaration, spec, document.source, size_text), name.span
    via = None if symbol.source.name == document.source.name else PurePath(symbol.source.location).name
    return symbol_markdown(symbol, document.resolution.env, via), name.span


def _keyword(document: Document, offset: int) -> tuple[str, Span] | None:
    """Describe the keyword at an offset: its syntax and, for a clause, the meaning of the clause.

    Return the description and the span of the keyword; None if there is no keyword.
    """
    token = document.token_at(offset)
    if token is None or token.text not in _FORMS:
        return None
    clause = _clause_at(document, token.span)
    lines = [_FORMS[token.text]]
    meaning = _meaning_of_clause(document, clause) if clause else None
    return "\n\n".join([*lines, *([meaning] if meaning else [])]), token.span


def _duration(document: Document, offset: int) -> tuple[str, Span] | None:
    period = document.resolution.env.context.clock_s
    for number, steps in durations(document):
        if number.span.start <= offset < number.span.end:
            return f"{steps_text(steps)} of {period:g} s.", number.span
    return None


def _operator(document: Document, offset: int) -> tuple[str, Span] | None:
    """Describe the meaning of the subformula whose operator is at an offset.

    Return the description and the span of the operator. Return None if there is no operator, or if
    the subformula has errors or is too large.
    """
    for declaration in document.module.declarations:
        if not isinstance(declaration, SpecDecl) or not declaration.span.start <= offset < declaration.span.end:
            continue
        for clause in declaration.clauses:
            if clause.kind in _FORMULA_CLAUSES and clause.span.start <= offset < clause.span.end:
                return _part(document, clause, offset)
    return None


def _part(document: Document, clause: Clause, offset: int) -> tuple[str, Span] | None:
    assert not isinstance(clause.value, tuple)
    for part in parts(clause.value):
        if isinstance(part, (Unary, BinaryExpr)) and part.op_span.start <= offset < part.op_span.end:
            if part.op == "then" and clause.kind == "reach":
                meaning = _meaning_of_clause(document, clause)
            else:
                meaning = _meaning(document, part)
            return (meaning, part.op_span) if meaning else None
    return None


def _meaning(document: Document, part: Expr) -> str | None:
    formula = formulas.known_formula(part, document.resolution.env)
    return None if formula is None else _sentence(formula)


def _meaning_of_clause(document: Document, clause: Clause) -> str | None:
    for spec in document.resolution.program.specs:
        clause_formulas = [part.formula for part in spec.parts if clause.span.covers(part.span)]
        if clause_formulas and spec.source.name == document.source.name:
            return _sentence(build.and_(*clause_formulas), endless=spec.semantics == "infinite")
    return None


def _sentence(formula: build.Formula, *, endless: bool = False) -> str | None:
    large = sum(1 for _ in formula.walk()) > _LARGEST
    return None if large else english_text(formula, endless=endless)


def _clause_at(document: Document, span: Span) -> Clause | None:
    for declaration in document.module.declarations:
        if isinstance(declaration, SpecDecl) and declaration.span.covers(span):
            return next((clause for clause in declaration.clauses if clause.keyword_span == span), None)
    return None
