"""What the names in a formula stand for: local names, ``let`` definitions, predicates, groups and signals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

from tltlc.grammar import tree
from tltlc.grammar.module import Module
from tltlc.grammar.tree import CallExpr, Expr, GroupExpr, NameExpr, Quantified

COUNTS: Final = ("times", "times_since", "times_within")
TIMES: Final = ("time_since", "time_holding", "total_time", "total_time_since", "total_time_within")
WITH_EVENT: Final = ("times_since", "total_time_since", "highest_since", "lowest_since", "value_at")
MEMORY: Final = (
    *COUNTS,
    *TIMES,
    "previous",
    "initial",
    "highest",
    "lowest",
    "highest_since",
    "lowest_since",
    "highest_within",
    "lowest_within",
    "value_at",
)
"""The functions of the trace so far."""


class Closure(NamedTuple):
    """An argument: an expression, with what the names in it mean."""

    expr: Expr
    scope: Scope


class Scope(NamedTuple):
    """What local names mean: an entity by its name, or an expression."""

    names: Mapping[str, str | Closure]

    def entity(self, expr: Expr) -> str:
        """Return the name of the entity that an expression names."""
        assert isinstance(expr, NameExpr)
        local = self.names.get(expr.name, expr.name)
        return local if isinstance(local, str) else local.scope.entity(local.expr)


NOWHERE: Final = Scope({})


class Names:
    """The declarations of a module, and the local names of the expressions in it."""

    def __init__(self, module: Module) -> None:
        self.declared: dict[str, tree.Declaration] = {
            declaration.name: declaration
            for declaration in module.declarations
            if isinstance(
                declaration, (tree.SignalDecl, tree.ParamDecl, tree.PredicateDecl, tree.LetDecl, tree.GroupDecl)
            )
        }
        self._scopes: dict[Any, Scope] = {}

    def expanded(self, expr: Expr, scope: Scope, *, predicates: bool = True) -> tuple[Expr, Scope]:
        """Replace a local name, a ``let``, or a predicate by what it stands for, as often as possible."""
        while True:
            if isinstance(expr, GroupExpr):
                expr = expr.inner
                continue
            if not isinstance(expr, (NameExpr, CallExpr)):
                return expr, scope
            local = scope.names.get(expr.name)
            if isinstance(local, Closure):
                expr, scope = local
                continue
            declared = self.declared.get(expr.name)
            if not isinstance(declared, (tree.LetDecl, tree.PredicateDecl)):
                return expr, scope
            if isinstance(declared, tree.PredicateDecl) and not predicates:
                return expr, scope
            inside = self._inside(expr, declared, scope)
            expr, scope = declared.body, inside

    def _inside(self, use: NameExpr | CallExpr, declared: tree.LetDecl | tree.PredicateDecl, scope: Scope) -> Scope:
        key = (id(use), id(scope))
        if key not in self._scopes:
            given = list(use.arguments) if isinstance(use, CallExpr) else []
            names: dict[str, str | Closure] = {}
            inside = Scope(names)
            for place, parameter in enumerate(declared.parameters):
                chosen = next((argument.value for argument in given if argument.name == parameter.name), None)
                if chosen is None and place < len(given) and given[place].name is None:
                    chosen = given[place].value
                if chosen is None:
                    assert parameter.default is not None
                    names[parameter.name] = Closure(parameter.default, inside)
                elif parameter.type == "entity":
                    names[parameter.name] = scope.entity(chosen)
                else:
                    names[parameter.name] = Closure(chosen, scope)
            self._scopes[key] = inside
        return self._scopes[key]

    def each(self, expr: Quantified, scope: Scope) -> Iterator[Scope]:
        members: list[str] = []
        for name in expr.entities:
            declared = self.declared.get(name.name)
            if isinstance(declared, tree.GroupDecl):
                members += (member.name for member in declared.members)
            else:
                members.append(name.name)
        for member in members:
            key = (id(expr), id(scope), member)
            if key not in self._scopes:
                self._scopes[key] = Scope({**scope.names, expr.variable: member})
            yield self._scopes[key]

    def signal(self, expr: NameExpr | CallExpr, scope: Scope) -> str:
        if isinstance(expr, NameExpr):
            return expr.name
        return f"{expr.name}({', '.join(scope.entity(argument.value) for argument in expr.arguments)})"

    def is_bool(self, expr: Expr, scope: Scope) -> bool:
        expr, scope = self.expanded(expr, scope, predicates=False)
        if isinstance(expr, CallExpr) and expr.name in MEMORY:
            return self.is_bool(expr.arguments[0].value, scope)
        declared = self.declared.get(expr.name) if isinstance(expr, (NameExpr, CallExpr)) else None
        return isinstance(declared, tree.SignalDecl) and declared.type == "bool"
