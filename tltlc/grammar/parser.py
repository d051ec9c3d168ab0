"""Parse a .tltl text into its syntax tree."""

from __future__ import annotations

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar import lalr
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.tables import load
from tltlc.grammar.tree import Expr, Module
from tltlc.source import SourceFile


def parse(source: SourceFile) -> tuple[Module, tuple[Diagnostic, ...]]:
    """The declarations of a file that could be read, and everything wrong with its syntax; never raises."""
    lexed = tokenize(source.text)
    builder = Builder(source, lexed.docs)
    declarations = lalr.run(load(), "module", lexed.tokens, builder)
    return Module(source, declarations, tuple(lexed.comments)), tuple(builder.diagnostics)


def parse_formula(source: SourceFile) -> tuple[Expr | None, tuple[Diagnostic, ...]]:
    """One formula, or None where it cannot be read, and everything wrong with its syntax; never raises."""
    lexed = tokenize(source.text)
    builder = Builder(source, lexed.docs)
    return lalr.run(load(), "expression", lexed.tokens, builder), tuple(builder.diagnostics)
