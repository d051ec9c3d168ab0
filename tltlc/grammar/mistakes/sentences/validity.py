"""Say whether clauses that a help suggests can be parsed."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.source import SourceFile
from tltlc.grammar import lalr, tree_checks
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.tables import load


def is_valid(clauses: Sequence[str]) -> bool:
    """Whether clauses can be parsed."""
    for clause in clauses:
        source = SourceFile("", clause, "text")
        lexed = tokenize(clause)
        builder = Builder(source, lexed.docs)
        try:
            node = lalr.run(load(), "clause", lexed.tokens, builder)
        except lalr.UnexpectedTokenError:
            return False
        if [*builder.diagnostics, *tree_checks.check_clause(source, node)]:
            return False
    return True
