"""The view of a file that rules get: its syntax tree, names, specs and automata.

Everything in it is computed once for all rules.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

from tltlc.automaton.finite.contradiction import Decision, unsatisfiable
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, GroupExpr, Module, NameExpr, Quantified, SpecDecl
from tltlc.grammar.walk import children
from tltlc.logic.formula import Formula
from tltlc.logic.text.phrases import is_state
from tltlc.resolve import formulas
from tltlc.resolve.imports import LoadedModule
from tltlc.resolve.kinds import entity
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.spec import ResolvedFile, Spec
from tltlc.resolve.values import Env
from tltlc.tools.lint.names import Mentioned, mentions

_COMPARISONS = ("<", "<=", ">", ">=")


@record
class Expression:
    """An expression of a clause, with the environment that resolves its names.

    The environment also has the values of the variables of enclosing quantifiers.
    """

    tree: Expr
    env: Env

    @property
    def source(self) -> SourceFile:
        """The source file that contains the expression."""
        return self.env.scope.source

    @property
    def text(self) -> str:
        """The source text of the expression on one line, without brackets around it."""
        return " ".join(self.source.slice(inner(self.tree).span).split())

    def at(self, tree: Expr) -> Expression:
        """Return a part of this expression that is not inside one of its quantifiers."""
        return Expression(tree, self.env)

    def formula(self) -> Formula | None:
        """Return the formula that the expression stands for, or None if it stands for none."""
        try:
            return formulas.formula(self.tree, self.env)
        except ResolutionError:
            return None

    def is_of_one_step(self) -> bool:
        """Whether the expression depends on one step alone.

        It does if it has atoms and no temporal operator.
        """
        formula = self.formula()
        return formula is not None and is_state(formula) and bool(formula.atoms())

    def parts(self) -> Iterator[Expression]:
        """Yield the expression and everything in it, outer before inner.

        The body of a quantifier comes once for each entity.
        """
        waiting = [self]
        while waiting:
            part = waiting.pop()
            yield part
            waiting += reversed(part.children())

    def children(self) -> list[Expression]:
        """Return the operands, in order."""
        if isinstance(self.tree, Quantified):
            variable, body = self.tree.variable, self.tree.body
            return [
                Expression(body, self.env.with_local(variable, entity(name, self.env))) for name in self.tree.entities
            ]
        return [self.at(child) for child in children(self.tree)]


@record
class SpecView:
    """A spec with its declaration, its resolved form and its automaton."""

    declaration: SpecDecl
    spec: Spec
    fspa: Fspa
    env: Env

    @property
    def decision(self) -> Decision:
        """The function that decides whether some parts of the spec are unsatisfiable together.

        It decides over finite or infinite traces, depending on the semantics of the spec.
        """
        if self.spec.semantics == "finite":
            return unsatisfiable
        from tltlc.automaton.infinite import contradiction as over_infinite_traces

        return over_infinite_traces.unsatisfiable

    @property
    def is_settled(self) -> bool:
        """Whether every trace satisfies the spec, or none does."""
        return self.fspa.states[0].verdict in ("satisfied", "violated")

    def clauses(self, *kinds: str) -> Iterator[tuple[Clause, Expression]]:
        """Yield the clauses of these kinds that have a formula, in order.

        The kinds with formulas are ``reach keep avoid require``.
        """
        for clause in self.declaration.clauses:
            if clause.kind in kinds and not isinstance(clause.value, tuple):
                yield clause, Expression(clause.value, self.env)

    def formulas(self) -> Iterator[Expression]:
        """Yield the formulas of all clauses, in order."""
        yield from (value for _, value in self.clauses("reach", "keep", "avoid", "require"))

    def name_label(self, message: str = "") -> Label:
        """Return a label on the name of the spec."""
        return Label(self.spec.source, self.spec.name_span, message)

    def atom_label(self, name: str, message: str = "") -> Label:
        """Return a label on the first use of an atom in the spec.

        The label is on the spec's name if no use is found.
        """
        for formula in self.formulas():
            for part in formula.parts():
                if isinstance(part.tree, (NameExpr, CallExpr)) or _is_comparison(part.tree):
                    part_formula = part.formula()
                    if part_formula is not None and name in part_formula.atoms():
                        return Label(part.source, part.tree.span, message)
        return self.name_label(message)


@record
class View:
    """A file that compiles without errors.

    ``said`` holds the diagnostics of the compiler. ``modules`` are the imported modules, and last
    the file's own. ``elsewhere`` has the names that other files may use from this one. ``program``
    has its tests.
    """

    module: Module
    env: Env
    modules: tuple[LoadedModule, ...]
    specs: tuple[SpecView, ...]
    said: tuple[Diagnostic, ...]
    elsewhere: Container[str] = frozenset()
    program: ResolvedFile = ResolvedFile((), ())

    @property
    def source(self) -> SourceFile:
        """The source file."""
        return self.module.source

    @property
    def used(self) -> Mentioned:
        """The names that are used by the file itself or, from this file, by others."""
        return Mentioned(mentions(self.module), self.elsewhere)

    def label(self, span: Span, message: str = "") -> Label:
        """Return a label on a place in the file."""
        return Label(self.source, span, message)


def operand(part: Expression) -> str:
    """Return the text of an expression as an operand of ``and`` or of a word like ``eventually``.

    It has brackets if it needs them.
    """
    tree = inner(part.tree)
    return f"({part.text})" if isinstance(tree, (BinaryExpr, Quantified)) and not _is_comparison(tree) else part.text


def _is_comparison(tree: Expr) -> bool:
    return isinstance(tree, BinaryExpr) and tree.op in _COMPARISONS


def inner(tree: Expr) -> Expr:
    """Return an expression without the brackets around it."""
    while isinstance(tree, GroupExpr):
        tree = tree.inner
    return tree
