"""Where a spec speaks of an entity, a signal, its level or its clock: what messages about the spec point at."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import Signal, nodes
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Call, ClockDecl, Declaration, EntityDecl, Expr, Name, SignalDecl, SpecDecl
from tltlc.grammar.walk import expressions, parts
from tltlc.resolve.spec import Spec


class SpecPlaces:
    """The places in the source text of a spec, one label each, by default that of the spec's name.

    Without a ``spec``, as for an artefact, nothing has a place, and there are no labels.
    """

    def __init__(self, spec: Spec | None) -> None:
        self._spec = spec
        self._all: Sequence[Declaration] = parse(spec.source)[0].declarations if spec else ()
        self._own = [each for each in self._all if isinstance(each, SpecDecl) and spec and each.name == spec.name]

    def entity(self, name: str) -> tuple[Label, ...]:
        """Where the spec uses an entity first; where only a definition does, there; else where it is declared."""
        names = (each for declared in self._all if isinstance(declared, EntityDecl) for each in declared.names)
        return self._label(
            _use(self._own, name) or _use(self._all, name) or _first(each.span for each in names if each.name == name)
        )

    def signal(self, name: str) -> tuple[Label, ...]:
        """Where the spec uses a signal first, itself or by an atom; else where it is declared."""
        users = [name, *self._atoms_of(name)]
        used = (_use(self._own, each.partition("(")[0]) for each in users)
        return self._label(self._written(name) or next(filter(None, used), None) or self._declared(name))

    def declaration(self, signal: str) -> tuple[Label, ...]:
        """Where a signal is declared, if that is in the spec's own file, else where it is used."""
        place = self._declared(signal)
        return self._label(place) if place else self.signal(signal)

    def level(self) -> tuple[Label, ...]:
        """Where the spec names its level."""
        clauses = (clause for each in self._own for clause in each.clauses)
        return self._label(_first(clause.span for clause in clauses if clause.kind == "level"))

    def clock(self) -> tuple[Label, ...]:
        """Where the clock is declared."""
        return self._label(_first(each.span for each in self._all if isinstance(each, ClockDecl)))

    def _atoms_of(self, signal: str) -> list[str]:
        """The atoms that are computed from a signal."""
        atoms = self._spec.atoms if self._spec else ()
        return [atom.name for atom in atoms if Signal(signal) in nodes(atom.expression)]

    def _declared(self, signal: str) -> Span | None:
        base = signal.partition("(")[0]
        return _first(each.name_span for each in self._all if isinstance(each, SignalDecl) and each.name == base)

    def _written(self, text: str) -> Span | None:
        """The first part of the spec's expressions that is written so, but for blanks."""
        if self._spec is None:
            return None
        source, bare = self._spec.source, "".join(text.split())
        return _first(part.span for part in _parts(self._own) if "".join(source.slice(part.span).split()) == bare)

    def _label(self, span: Span | None) -> tuple[Label, ...]:
        return (Label(self._spec.source, span or self._spec.name_span),) if self._spec else ()


def _use(declarations: Iterable[Declaration], name: str) -> Span | None:
    """The first name, or call, of that name in the expressions of some declarations."""
    for part in _parts(declarations):
        if isinstance(part, Call) and part.name == name:
            return part.name_span
        if isinstance(part, Name) and part.name == name:
            return part.span
    return None


def _first(spans: Iterable[Span]) -> Span | None:
    return next(iter(spans), None)


def _parts(declarations: Iterable[Declaration]) -> Iterator[Expr]:
    for declaration in declarations:
        for expression in expressions(declaration):
            yield from parts(expression)
