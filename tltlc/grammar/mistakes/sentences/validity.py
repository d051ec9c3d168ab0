"""Parse the clauses that a help suggests."""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.core.source import SourceFile
from tltlc.grammar import lalr, tree_checks
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.tables import load
from tltlc.grammar.tree import Clause


def is_valid(clauses: Sequence[str]) -> bool:
    """Whether clauses can be parsed."""
    return all(parsed_clause(clause) is not None for clause in clauses)


def parsed_clause(text: str) -> Clause | None:
    """Return the tree of a clause; None if it cannot be parsed."""
    source, lexed = SourceFile("", text, "text"), tokenize(text)
    builder = Builder(source, lexed.docs)
    try:
        clause: Clause = lalr.run(load(), "clause", lexed.tokens, builder)
    except lalr.UnexpectedTokenError:
        return None
    return None if [*builder.diagnostics, *tree_checks.check_clause(source, clause)] else clause
