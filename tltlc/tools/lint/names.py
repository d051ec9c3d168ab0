"""Find the names that the declarations of a module mention."""

from __future__ import annotations

from collections.abc import Container, Iterator

from tltlc.core.record import record
from tltlc.grammar.module import Module
from tltlc.grammar.tree import (
    CallExpr,
    Declaration,
    Expr,
    GroupDecl,
    LetDecl,
    NameExpr,
    PredicateDecl,
    Quantified,
    SignalDecl,
    SpecDecl,
)
from tltlc.grammar.walk import expressions, parts
from tltlc.resolve.scope import Scope

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


def mentioned_signals(expression: Expr, scope: Scope) -> frozenset[str]:
    """Return the names of the signals that an expression reads, also those in its lets and predicates.

    ``hp`` for ``low``, after ``let low = hp < 20``. For a signal of entities, the name has no entity in it.
    """
    found: set[str] = set()
    known: set[int] = set()
    pending = [(expression, scope)]
    while pending:
        tree, visible = pending.pop()
        for part in parts(tree):
            binding = visible.names.get(part.name) if isinstance(part, (NameExpr, CallExpr)) else None
            if binding is None or id(binding.declaration) in known:
                continue
            known.add(id(binding.declaration))
            if isinstance(binding.declaration, SignalDecl):
                found.add(binding.name)
            elif isinstance(binding.declaration, (LetDecl, PredicateDecl)):
                pending.append((binding.declaration.body, binding.scope))
    return frozenset(found)


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
