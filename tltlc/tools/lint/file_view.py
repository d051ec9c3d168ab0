"""What a lint rule can read of a file: its syntax tree, names, specs and automata.

All of this is computed once and shared by all rules.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

from tltlc.automaton.finite.contradiction import Decision, unsatisfiable
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar.module import Module
from tltlc.grammar.tree import (
    BinaryExpr,
    CallExpr,
    Clause,
    Expr,
    GroupExpr,
    IsExpr,
    NameExpr,
    Quantified,
    SpecDecl,
    Unary,
)
from tltlc.grammar.walk import children
from tltlc.logic.formula import Formula
from tltlc.logic.text.phrases import is_state
from tltlc.resolve import formulas
from tltlc.resolve.groups import entities
from tltlc.resolve.imports import LoadedModule
from tltlc.resolve.spec import ResolvedFile, Spec
from tltlc.resolve.values import Env
from tltlc.tools.lint.names import MentionedNames, mentioned_names

_COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")


@record
class ScopedExpression:
    """An expression of a clause, with the environment in which its names are resolved.

    In the body of ``all x in (chest, door): …``, the environment also says which entity ``x`` is.
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
        return " ".join(self.source.slice(without_brackets(self.tree).span).split())

    def with_tree(self, tree: Expr) -> ScopedExpression:
        """Return ``tree``, a subexpression of this expression, with the same environment.

        ``tree`` must not be inside a quantifier, whose body needs another environment. For such
        subexpressions, use :meth:`parts`.
        """
        return ScopedExpression(tree, self.env)

    def formula(self) -> Formula | None:
        """Return the resolved formula without bounds.

        Return None if the expression is not a formula, or if it has a bound on a clock that varies,
        for which only a whole clause has a timer.
        """
        return formulas.known_formula(self.tree, self.env)

    def depends_on_one_step(self) -> bool:
        """Whether the expression is a formula with atoms, but without temporal operators.

        The truth of such a formula at a step depends on this step alone.
        """
        formula = self.formula()
        return formula is not None and is_state(formula) and bool(formula.atoms())

    def parts(self) -> Iterator[ScopedExpression]:
        """Yield the expression and all its subexpressions, outer before inner.

        The body of a quantifier is yielded once for each entity: for ``all x in (chest, door): near(x)``,
        once with ``x`` as ``chest``, and once with ``x`` as ``door``.
        """
        pending = [self]
        while pending:
            part = pending.pop()
            yield part
            pending += reversed(part.children())

    def children(self) -> list[ScopedExpression]:
        """Return the operands of the expression's outermost operator, in order.

        For a quantifier, return its body, once for each entity.
        """
        if isinstance(self.tree, Quantified):
            variable, body = self.tree.variable, self.tree.body
            members = entities(self.tree.entities, self.env)
            return [ScopedExpression(body, self.env.with_local(variable, member)) for member in members]
        return [self.with_tree(child) for child in children(self.tree)]


@record
class SpecView:
    """A spec: its syntax tree (``declaration``), the resolved ``spec``, its automaton and its environment."""

    declaration: SpecDecl
    spec: Spec
    fspa: Fspa
    env: Env

    @property
    def decision(self) -> Decision:
        """A function of clauses and a spec that says whether the clauses contradict each other.

        They do if no trace satisfies all of them. Traces are finite or infinite, as the ``semantics``
        of this spec says. False means only that no contradiction could be proved.
        """
        if self.spec.semantics == "finite":
            return unsatisfiable
        from tltlc.automaton.infinite import contradiction as over_infinite_traces

        return over_infinite_traces.unsatisfiable

    @property
    def is_settled(self) -> bool:
        """Whether every trace satisfies the spec, or no trace does."""
        return self.fspa.states[0].verdict in ("satisfied", "violated")

    def clauses(self, *kinds: str) -> Iterator[tuple[Clause, ScopedExpression]]:
        """Yield the clauses of these kinds, in order, each with its expression.

        The kinds whose expressions are formulas are ``reach``, ``keep``, ``avoid`` and ``require``.
        """
        for clause in self.declaration.clauses:
            if clause.kind in kinds and not isinstance(clause.value, tuple):
                yield clause, ScopedExpression(clause.value, self.env)

    def formulas(self) -> Iterator[ScopedExpression]:
        """Yield the formula of each ``reach``, ``keep``, ``avoid`` and ``require`` clause, in order."""
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
class FileView:
    """A file that compiles without errors.

    ``module`` is its syntax tree, and ``env`` the environment in which its names are resolved.
    ``modules`` are the imported modules, followed by the file's own module. ``diagnostics`` are the
    warnings and notes of the compiler. ``used_elsewhere`` contains the names of this file that other
    files may use. ``program`` has the file's tests.
    """

    module: Module
    env: Env
    modules: tuple[LoadedModule, ...]
    specs: tuple[SpecView, ...]
    diagnostics: tuple[Diagnostic, ...]
    used_elsewhere: Container[str] = frozenset()
    program: ResolvedFile = ResolvedFile((), ())

    @property
    def source(self) -> SourceFile:
        """The source file."""
        return self.module.source

    @property
    def used_names(self) -> MentionedNames:
        """The names that this file mentions, or that other files use from it."""
        return MentionedNames(mentioned_names(self.module), self.used_elsewhere)

    def label(self, span: Span, message: str = "") -> Label:
        """Return a label on a place in the file."""
        return Label(self.source, span, message)


def operand_text(part: ScopedExpression) -> str:
    """Return the text of an expression, in brackets if an operand of ``and`` or ``eventually`` needs them.

    For example, ``a or b`` becomes ``(a or b)``, but ``near(exit)`` stays ``near(exit)``.
    """
    tree = without_brackets(part.tree)
    return f"({part.text})" if isinstance(tree, (BinaryExpr, Quantified)) and not _is_comparison(tree) else part.text


def negated_text(part: ScopedExpression) -> str:
    """Return the text of the negation of an expression, as an operand of ``and``."""
    tree = part.tree
    if isinstance(tree, Unary) and tree.op == "not":
        return operand_text(part.with_tree(tree.operand))
    if isinstance(tree, IsExpr):
        return f"{part.with_tree(tree.operand).text} is {'' if tree.negated else 'not '}{tree.value}"
    return f"not {operand_text(part)}"


def edited_text(part: ScopedExpression, place: Span, text: str) -> str:
    """Return the text of an expression with another text in one place, on one line and without comments."""
    source, whole = part.source.text, without_brackets(part.tree).span
    lines = (source[whole.start : place.start] + text + source[place.end : whole.end]).splitlines()
    return " ".join(word for line in lines for word in line.partition("//")[0].split())


def _is_comparison(tree: Expr) -> bool:
    return isinstance(tree, BinaryExpr) and tree.op in _COMPARISONS


def without_brackets(tree: Expr) -> Expr:
    """Return an expression without the brackets around it."""
    while isinstance(tree, GroupExpr):
        tree = tree.inner
    return tree
