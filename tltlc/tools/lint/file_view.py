"""What rules see of a file: its syntax tree, its names, its specs and their automata, each made once for all rules."""

from __future__ import annotations

from collections.abc import Container, Iterator

from tltlc.automaton.finite.contradiction import Decision, unsatisfiable
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.grammar.tree import Binary, Call, Clause, Expr, Group, Module, Name, Quantified, SpecDecl
from tltlc.grammar.walk import children
from tltlc.logic.formula import Formula
from tltlc.logic.text.phrases import is_state
from tltlc.resolve import formulas
from tltlc.resolve.imports import Loaded
from tltlc.resolve.kinds import entity
from tltlc.resolve.problem import ResolutionError
from tltlc.resolve.spec import Program, Spec
from tltlc.resolve.values import Env
from tltlc.tools.lint.names import Mentioned, mentions

_COMPARISONS = ("<", "<=", ">", ">=")


@record
class Expression:
    """An expression of a clause, and what its names stand for there: the variables of quantifiers have values."""

    tree: Expr
    env: Env

    @property
    def source(self) -> SourceFile:
        """The text that the expression stands in."""
        return self.env.scope.source

    @property
    def text(self) -> str:
        """The expression as it is written, on one line, without brackets around it."""
        return " ".join(self.source.slice(inner(self.tree).span).split())

    def at(self, tree: Expr) -> Expression:
        """A part of this expression that lies in no quantifier of it."""
        return Expression(tree, self.env)

    def formula(self) -> Formula | None:
        """The formula that it stands for, None where it stands for none."""
        try:
            return formulas.formula(self.tree, self.env)
        except ResolutionError:
            return None

    def is_of_one_step(self) -> bool:
        """Whether it asks something of the step that it is about and of no other: atoms without a temporal operator."""
        formula = self.formula()
        return formula is not None and is_state(formula) and bool(formula.atoms())

    def parts(self) -> Iterator[Expression]:
        """The expression and everything in it, outer before inner; the body of a quantifier once for each entity."""
        waiting = [self]
        while waiting:
            part = waiting.pop()
            yield part
            waiting += reversed(part.children())

    def children(self) -> list[Expression]:
        """The operands, in order."""
        if isinstance(self.tree, Quantified):
            variable, body = self.tree.variable, self.tree.body
            return [Expression(body, self.env.also(variable, entity(name, self.env))) for name in self.tree.entities]
        return [self.at(child) for child in children(self.tree)]


@record
class SpecView:
    """A spec as it is written, resolved and compiled."""

    declaration: SpecDecl
    spec: Spec
    fspa: Fspa
    env: Env

    @property
    def decision(self) -> Decision:
        """What decides whether no trace satisfies parts of the spec together, over the traces that it is about."""
        if self.spec.semantics == "finite":
            return unsatisfiable
        from tltlc.automaton.infinite import contradiction as over_infinite_traces

        return over_infinite_traces.unsatisfiable

    @property
    def is_settled(self) -> bool:
        """Whether every trace satisfies it, or none does."""
        return self.fspa.states[0].verdict in ("satisfied", "violated")

    def clauses(self, *kinds: str) -> Iterator[tuple[Clause, Expression]]:
        """The clauses of these kinds (``reach keep avoid require``) that hold a formula, in order."""
        for clause in self.declaration.clauses:
            if clause.kind in kinds and not isinstance(clause.value, tuple):
                yield clause, Expression(clause.value, self.env)

    def formulas(self) -> Iterator[Expression]:
        """The formulas of all clauses, in order."""
        yield from (value for _, value in self.clauses("reach", "keep", "avoid", "require"))

    def name_label(self, message: str = "") -> Label:
        """The place of the spec's name."""
        return Label(self.spec.source, self.spec.name_span, message)

    def atom_label(self, name: str, message: str = "") -> Label:
        """The place where an atom of the spec is first used; the spec's name where that is not found."""
        for formula in self.formulas():
            for part in formula.parts():
                if isinstance(part.tree, (Name, Call)) or _is_comparison(part.tree):
                    found = part.formula()
                    if found is not None and name in found.atoms():
                        return Label(part.source, part.tree.span, message)
        return self.name_label(message)


@record
class View:
    """A file without errors.

    ``said`` is what the compiler has to say of it; ``modules`` are those that it imports and itself, last;
    ``elsewhere`` are names that other files may use of it; ``program`` has its tests.
    """

    module: Module
    env: Env
    modules: tuple[Loaded, ...]
    specs: tuple[SpecView, ...]
    said: tuple[Diagnostic, ...]
    elsewhere: Container[str] = frozenset()
    program: Program = Program((), ())

    @property
    def source(self) -> SourceFile:
        """The text of the file."""
        return self.module.source

    @property
    def used(self) -> Mentioned:
        """The names that the file itself uses, or others use of it."""
        return Mentioned(mentions(self.module), self.elsewhere)

    def label(self, span: Span, message: str = "") -> Label:
        """A place in the file."""
        return Label(self.source, span, message)


def operand(part: Expression) -> str:
    """The text of an expression as an operand of ``and`` or of a word like ``eventually``, in brackets where needed."""
    tree = inner(part.tree)
    return f"({part.text})" if isinstance(tree, (Binary, Quantified)) and not _is_comparison(tree) else part.text


def _is_comparison(tree: Expr) -> bool:
    return isinstance(tree, Binary) and tree.op in _COMPARISONS


def inner(tree: Expr) -> Expr:
    """An expression without the brackets around it."""
    while isinstance(tree, Group):
        tree = tree.inner
    return tree
