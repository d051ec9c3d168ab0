"""Find every name in a module and the declaration that it refers to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import Literal, Union

from tltlc.core.record import EMPTY, record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar import tree
from tltlc.grammar.lexer import Token
from tltlc.grammar.parser import parse_formula
from tltlc.grammar.walk import children
from tltlc.resolve.scope import Binding, NamedDeclaration, Scope

SymbolKind = Literal["signal", "param", "predicate", "let", "entity", "group", "spec", "parameter", "variable"]
MERGED: tuple[SymbolKind, ...] = ("signal", "param", "entity")
"""The kinds of symbols that several files of a program may declare: equal names are then one symbol.

A program is a file with all files that it imports.
"""

_FORMULA_CLAUSES = ("reach", "keep", "avoid", "require")


@record
class Symbol:
    """A declared name, such as a signal, with its declaration; ``span`` is the place of the name in ``source``."""

    kind: SymbolKind
    name: str
    declaration: Union[NamedDeclaration, tree.SpecDecl, tree.Parameter, tree.Quantified]
    source: SourceFile
    span: Span

    @property
    def key(self) -> tuple[str, str, int]:
        """A key that identifies the declaration."""
        return self.kind, self.source.name, self.span.start

    def is_same(self, other: Symbol) -> bool:
        """Whether both are the same symbol in a program that contains the files of both.

        A program is a file with all files that it imports. In a program, signals of the same name
        are one symbol, and so are params and entities.
        """
        if self.kind in MERGED:
            return (self.kind, self.name) == (other.kind, other.name)
        return self.key == other.key


@record
class Occurrence:
    """A place in a module where a name stands: in its declaration, or where it is used.

    ``span`` covers the name alone: of ``lib.near``, where ``lib`` is an import, it covers ``near``.
    """

    span: Span
    symbol: Symbol
    declares: bool = False


def occurrences(scope: Scope, tokens: Sequence[Token]) -> tuple[Occurrence, ...]:
    """Return every place in a module where a declared name stands, in the order of the text.

    ``scope`` has the module and its visible names, and ``tokens`` are the tokens of its text.
    """
    walk = _Walk(scope, tokens)
    for declaration in scope.module.declarations:
        walk.declaration(declaration)
    return tuple(sorted(walk.occurrences, key=lambda occurrence: occurrence.span.start))


def symbol_of(binding: Binding) -> Symbol:
    """Return the symbol that a visible name refers to."""
    return Symbol(binding.kind, binding.name, binding.declaration, binding.scope.source, binding.span)


_Locals = Mapping[str, Symbol]


class _Walk:
    """Collects the occurrences of names in a module."""

    def __init__(self, scope: Scope, tokens: Sequence[Token]) -> None:
        self.occurrences: list[Occurrence] = []
        self._scope = scope
        self._starts = {token.start: index for index, token in enumerate(tokens)}
        self._tokens = tokens
        self._visible: Mapping[str, Binding] = scope.names
        self._unaliased = {binding.name: binding for binding in scope.names.values()}
        self._label_start: int | None = None
        """The offset at which the current label starts; None outside labels.

        The spans in the formula of the label count from this offset.
        """
        self._specs: dict[str, Symbol] = {}
        for declaration in scope.module.declarations:
            if isinstance(declaration, tree.SpecDecl):
                self._specs.setdefault(
                    declaration.name, Symbol("spec", declaration.name, declaration, scope.source, declaration.name_span)
                )

    def declaration(self, declaration: tree.Declaration) -> None:
        """Collect the declared names and the used names in a declaration."""
        match declaration:
            case tree.Import():
                for name in declaration.names or ():
                    binding = self._scope.names.get(name.name)
                    if binding is not None and binding.scope is not self._scope:
                        self._note(name.span, symbol_of(binding))
            case tree.SignalDecl() | tree.ParamDecl() | tree.PredicateDecl() | tree.LetDecl():
                self._note_declaration(declaration.name, declaration.name_span)
                self._head(declaration)
            case tree.EntityDecl():
                for name in declaration.names:
                    self._note_declaration(name.name, name.span)
            case tree.GroupDecl():
                self._note_declaration(declaration.name, declaration.name_span)
                for member in declaration.members:
                    self._note_member(member)
            case tree.ExclusiveDecl():
                self._expressions(declaration.atoms)
            case tree.SpecDecl():
                self._note(declaration.name_span, self._specs[declaration.name], declares=True)
                for clause in declaration.clauses:
                    if clause.kind in _FORMULA_CLAUSES and not isinstance(clause.value, tuple):
                        self._expressions([clause.value])
            case tree.TestDecl():
                if declaration.spec.name in self._specs:
                    self._note(declaration.spec.span, self._specs[declaration.spec.name])
                for item in declaration.items:
                    if isinstance(item, tree.TestStep):
                        self._expressions(item.atoms)
                    elif item.kind == "state":
                        self._label(item)

    def _head(self, declaration: tree.SignalDecl | tree.ParamDecl | tree.PredicateDecl | tree.LetDecl) -> None:
        """Collect names in the parameters, the range, and the value or body of a declaration."""
        local: dict[str, Symbol] = {}
        for parameter in () if isinstance(declaration, tree.ParamDecl) else declaration.parameters:
            if parameter.default is not None:
                self._expressions([parameter.default], dict(local))
            symbol = Symbol("parameter", parameter.name, parameter, self._scope.source, parameter.name_span)
            self._note(parameter.name_span, symbol, declares=True)
            local[parameter.name] = symbol
        interval = None if isinstance(declaration, tree.LetDecl) else declaration.interval
        if interval is not None:
            self._expressions([interval.low, interval.high])
        if isinstance(declaration, tree.ParamDecl):
            self._expressions([declaration.value])
        elif isinstance(declaration, (tree.PredicateDecl, tree.LetDecl)):
            self._expressions([declaration.body], local)

    def _label(self, item: tree.TestExpect) -> None:
        """Collect the names in a state label of a test, if the label is a formula and not English.

        Names in labels never begin with the alias of an import.
        """
        text = self._tokens[self._starts[item.span.start] + 2]
        formula, _ = parse_formula(self._scope.source.with_text(text.text[1:-1]))
        if formula is not None:
            aliased, self._visible, self._label_start = self._visible, self._unaliased, text.start + 1
            self._expressions([formula])
            self._visible, self._label_start = aliased, None

    def _expressions(self, expressions: Iterable[tree.Expr], local: _Locals = EMPTY) -> None:
        waiting = [(expression, local) for expression in expressions]
        while waiting:
            part, visible = waiting.pop()
            if isinstance(part, tree.NameExpr):
                self._note_use(part.name, part.span, visible)
            elif isinstance(part, tree.CallExpr):
                self._note_use(part.name, part.name_span, visible)
                self._keywords(part)
            elif isinstance(part, tree.Quantified):
                for name in part.entities:
                    self._note_use(name.name, name.span, visible)
                visible = self._with_variable(part, visible)
            # The value that a step of a test sets has no names of declarations, but perhaps that of an enum's value.
            is_setting = isinstance(part, tree.BinaryExpr) and part.op == "="
            waiting += [(child, visible) for child in islice(children(part), 1 if is_setting else None)]

    def _with_variable(self, part: tree.Quantified, local: _Locals) -> _Locals:
        """Return the local names that are visible in the body of the quantifier ``part``.

        These are the names in ``local`` and the variable of the quantifier. Also collect the
        variable, which is the second token of the quantifier. In a state label, whose tokens are
        not known, return ``local`` unchanged.
        """
        index = self._starts.get(part.span.start) if self._label_start is None else None
        if index is None or index + 1 >= len(self._tokens):
            return local
        span = self._tokens[index + 1].span
        symbol = Symbol("variable", part.variable, part, self._scope.source, span)
        self._note(span, symbol, declares=True)
        return {**local, part.variable: symbol}

    def _keywords(self, call: tree.CallExpr) -> None:
        binding = self._visible.get(call.name)
        declaration = binding.declaration if binding else None
        if binding is None or not isinstance(declaration, (tree.SignalDecl, tree.PredicateDecl, tree.LetDecl)):
            return
        parameters = {parameter.name: parameter for parameter in declaration.parameters}
        for argument in call.arguments:
            parameter = parameters.get(argument.name or "")
            if parameter is not None:
                start = argument.span.start
                symbol = Symbol("parameter", parameter.name, parameter, binding.scope.source, parameter.name_span)
                self._note(Span(start, start + len(parameter.name)), symbol)

    def _note_declaration(self, name: str, span: Span) -> None:
        binding = self._scope.names.get(name)
        if binding is not None:
            self._note(span, symbol_of(binding), declares=True)

    def _note_member(self, member: tree.NameExpr) -> None:
        """Collect a member of a group; the group declares it if nothing else does."""
        binding = self._scope.names.get(member.name)
        if binding is not None and binding.declaration is member:
            self._note_declaration(member.name, member.span)
        else:
            self._note_use(member.name, member.span, EMPTY)

    def _note_use(self, name: str, span: Span, local: _Locals) -> None:
        if name in local:
            self._note(span, local[name])
            return
        binding = self._visible.get(name)
        if binding is not None:
            self._note(Span(span.end - len(binding.name), span.end), symbol_of(binding))

    def _note(self, span: Span, symbol: Symbol, *, declares: bool = False) -> None:
        if self._label_start is not None:
            span = Span(self._label_start + span.start, self._label_start + span.end)
        self.occurrences.append(Occurrence(span, symbol, declares))
