"""Find where a spec's source text mentions an entity, a signal, the spec's level or its clock."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tltlc.api import Label, Signal, Span, Spec, expressions, syntax


class SpecPlaces:
    """Finds places in the source text of a spec, for diagnostics that point to them.

    A label is a place in a source text. Each public method returns a tuple with one label. If the
    source does not contain what the method looks for, the label is the place of the spec's name. If
    ``spec`` is None, because an artefact has no source, all methods return an empty tuple.
    """

    def __init__(self, spec: Spec | None) -> None:
        self._spec = spec
        self._declarations: Sequence[syntax.Declaration] = syntax.parse(spec.source)[0].declarations if spec else ()
        self._declarations_of_spec = [
            declaration
            for declaration in self._declarations
            if isinstance(declaration, syntax.SpecDecl) and spec and declaration.name == spec.name
        ]

    def entity(self, name: str) -> tuple[Label, ...]:
        """Return the label of the first use of an entity in the spec, or else anywhere in the file.

        If nothing uses the entity, return the label of its declaration.
        """
        declared = (
            entity
            for declaration in self._declarations
            if isinstance(declaration, (syntax.EntityDecl, syntax.GroupDecl))
            for entity in (declaration.names if isinstance(declaration, syntax.EntityDecl) else declaration.members)
        )
        return self._label(
            _first_use(self._declarations_of_spec, name)
            or _first_use(self._declarations, name)
            or _first(entity.span for entity in declared if entity.name == name)
        )

    def signal(self, signal: Signal) -> tuple[Label, ...]:
        """Return the label of the first use of a signal in the spec, directly or through an atom.

        These uses are looked for in order: a use with the arguments of ``signal``; a use with other
        arguments; a use of an atom that is computed from the signal. If there is none, return the
        label of the signal's declaration.
        """
        exact = _first(part.span for part in _parts(self._declarations_of_spec) if _is_use(part, signal))
        users = [signal.base, *self._atoms_of(signal)]
        spans = (_first_use(self._declarations_of_spec, user) for user in users)
        return self._label(exact or next(filter(None, spans), None) or self._declaration_span(signal))

    def declaration(self, signal: Signal) -> tuple[Label, ...]:
        """Return the label of the declaration of a signal.

        If the declaration is in another file, return the label of the signal's first use instead.
        """
        place = self._declaration_span(signal)
        return self._label(place) if place else self.signal(signal)

    def param(self, name: str) -> tuple[Label, ...]:
        """Return the label of the first use of a param in the spec, or else of its declaration."""
        declared = (
            declaration.name_span
            for declaration in self._declarations
            if isinstance(declaration, syntax.ParamDecl) and declaration.name == name
        )
        return self._label(_first_use(self._declarations_of_spec, name) or _first(declared))

    def level(self) -> tuple[Label, ...]:
        """Return the label of the clause that names the spec's level."""
        clauses = (clause for declaration in self._declarations_of_spec for clause in declaration.clauses)
        return self._label(_first(clause.span for clause in clauses if clause.kind == "level"))

    def clock(self) -> tuple[Label, ...]:
        """Return the label of the declaration of the spec's clock."""
        return self._label(
            _first(declaration.span for declaration in self._declarations if isinstance(declaration, syntax.ClockDecl))
        )

    def _atoms_of(self, signal: Signal) -> list[str]:
        """Return the names, without arguments, of the atoms that are computed from a signal."""
        atoms = self._spec.atoms if self._spec else ()
        return [
            atom.base for atom in atoms if expressions.SignalValue(signal.name) in expressions.nodes(atom.expression)
        ]

    def _declaration_span(self, signal: Signal) -> Span | None:
        return _first(
            declaration.name_span
            for declaration in self._declarations
            if isinstance(declaration, syntax.SignalDecl) and declaration.name == signal.base
        )

    def _label(self, span: Span | None) -> tuple[Label, ...]:
        return (Label(self._spec.source, span or self._spec.name_span),) if self._spec else ()


def _is_use(part: syntax.Expr, signal: Signal) -> bool:
    """Whether an expression is the use of a signal with exactly the signal's arguments."""
    if isinstance(part, syntax.CallExpr):
        values = [argument.value for argument in part.arguments if argument.name is None]
        names = tuple(value.name for value in values if isinstance(value, syntax.NameExpr))
        return part.name == signal.base and len(names) == len(part.arguments) and names == signal.arguments
    return isinstance(part, syntax.NameExpr) and part.name == signal.base and not signal.arguments


def _first_use(declarations: Iterable[syntax.Declaration], name: str) -> Span | None:
    """Return the span of the first use of a name in ``declarations``; None if there is no use.

    The name may have arguments, as in ``near(exit)``; the span is that of the name alone.
    """
    for part in _parts(declarations):
        if isinstance(part, syntax.CallExpr) and part.name == name:
            return part.name_span
        if isinstance(part, syntax.NameExpr) and part.name == name:
            return part.span
    return None


def _first(spans: Iterable[Span]) -> Span | None:
    return next(iter(spans), None)


def _parts(declarations: Iterable[syntax.Declaration]) -> Iterator[syntax.Expr]:
    for declaration in declarations:
        for expression in syntax.expressions(declaration):
            yield from syntax.parts(expression)
