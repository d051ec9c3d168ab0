"""Find the names that the declarations of a module mention."""

from __future__ import annotations

from collections.abc import Container, Iterator

from tltlc.core.record import record
from tltlc.grammar.module import Module
from tltlc.grammar.tree import CallExpr, Declaration, Expr, GroupDecl, NameExpr, Quantified, SpecDecl
from tltlc.grammar.walk import expressions, parts

_FORMULAS = ("reach", "keep", "avoid", "require")


@record
class MentionedNames:
    """A container of the names that a file mentions itself (``here``), or that other files use from it."""

    here: frozenset[str]
    used_elsewhere: Container[str]

    def __contains__(self, name: object) -> bool:
        return name in self.here or name in self.used_elsewhere


def mentioned_names(module: Module) -> frozenset[str]:
    """Return every name in the expressions of a module, as written there: ``near`` and ``s1`` for ``near(s1)``."""
    return frozenset(name for declaration in module.declarations for name in _in_declaration(declaration))


def _in_declaration(declaration: Declaration) -> Iterator[str]:
    if isinstance(declaration, GroupDecl):
        yield from (member.name for member in declaration.members)
    for expression in _expressions(declaration):
        for part in parts(expression):
            if isinstance(part, (NameExpr, CallExpr)):
                yield part.name
            elif isinstance(part, Quantified):
                yield from (entity.name for entity in part.entities)


def _expressions(declaration: Declaration) -> Iterator[Expr]:
    if not isinstance(declaration, SpecDecl):
        yield from expressions(declaration)
        return
    # Names of levels and tags do not refer to declarations.
    for clause in declaration.clauses:
        if clause.kind in _FORMULAS and not isinstance(clause.value, tuple):
            yield clause.value
