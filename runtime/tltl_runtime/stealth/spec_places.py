"""Where a spec speaks of an entity, a signal, its level or its clock: what messages about the spec point at."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.expression import Signal, nodes
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Call, ClockDecl, Declaration, EntityDecl, Expr, Name, SignalDecl, SpecDecl
from tltlc.grammar.walk import expressions, parts
from tltlc.resolve.spec import Spec
from tltlc.source import Span


class SpecPlaces:
    """The places in the source text of a spec; nothing has a place in an artefact, whose ``spec`` is None."""

    def __init__(self, spec: Spec | None) -> None:
        self._spec = spec
        self._all: tuple[Declaration, ...] = parse(spec.source)[0].declarations if spec else ()
        self._own = [each for each in self._all if isinstance(each, SpecDecl) and spec and each.name == spec.name]

    def entity(self, name: str) -> tuple[Label, ...]:
        """Where the spec uses an entity first; where only a definition does, there; else where it is declared."""
        return self._label(
            self._use(self._own, name)
            or self._use(self._all, name)
            or self._first(each.span for each in self._names() if each.name == name)
        )

    def signal(self, name: str) -> tuple[Label, ...]:
        """Where the spec uses a signal first, itself or by an atom; else where it is declared."""
        base = name.partition("(")[0]
        used_by = [base]
        if self._spec:
            used_by += [
                atom.name.partition("(")[0]
                for atom in self._spec.atoms
                if any(isinstance(node, Signal) and node.name == name for node in nodes(atom.expression))
            ]
        declared = (each.name_span for each in self._all if isinstance(each, SignalDecl) and each.name == base)
        return self._label(
            self._written(self._own, name)
            or next((place for each in used_by if (place := self._use(self._own, each))), None)
            or self._first(declared)
        )

    def declaration(self, signal: str) -> tuple[Label, ...]:
        """Where a signal is declared, if that is in the spec's own file, else where it is used."""
        base = signal.partition("(")[0]
        found = self._first(each.name_span for each in self._all if isinstance(each, SignalDecl) and each.name == base)
        return self._label(found) if found else self.signal(signal)

    def level(self) -> tuple[Label, ...]:
        """Where the spec names its level."""
        clauses = (clause for each in self._own if isinstance(each, SpecDecl) for clause in each.clauses)
        return self._label(self._first(clause.span for clause in clauses if clause.kind == "level"))

    def clock(self) -> tuple[Label, ...]:
        """Where the clock is declared."""
        return self._label(self._first(each.span for each in self._all if isinstance(each, ClockDecl)))

    def name(self) -> tuple[Label, ...]:
        """Where the spec's name stands."""
        return self._label(None)

    def _names(self) -> Iterator[Name]:
        for each in self._all:
            if isinstance(each, EntityDecl):
                yield from each.names

    def _use(self, declarations: tuple[Declaration, ...] | list[SpecDecl], name: str) -> Span | None:
        """The first name, or call, of that name in the expressions of some declarations."""
        for part in _parts(declarations):
            if isinstance(part, (Name, Call)) and part.name == name:
                return part.name_span if isinstance(part, Call) else part.span
        return None

    def _written(self, declarations: list[SpecDecl], name: str) -> Span | None:
        """The first part of an expression that is written exactly so, but for blanks."""
        assert self._spec or not declarations
        for part in _parts(declarations):
            if self._spec and "".join(self._spec.source.slice(part.span).split()) == "".join(name.split()):
                return part.span
        return None

    def _first(self, spans: Iterator[Span]) -> Span | None:
        return next(iter(spans), None)

    def _label(self, span: Span | None) -> tuple[Label, ...]:
        """The place, or that of the spec's name where it is unknown."""
        return (Label(self._spec.source, span or self._spec.name_span),) if self._spec else ()


def _parts(declarations: tuple[Declaration, ...] | list[SpecDecl]) -> Iterator[Expr]:
    for declaration in declarations:
        for expression in expressions(declaration):
            yield from parts(expression)
