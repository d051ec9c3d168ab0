"""Types that the language does not have: their error, and the types that they are meant to be."""

from __future__ import annotations

from typing import Final, Union

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import replacement_fix
from tltlc.grammar import tree
from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.module import Module
from tltlc.grammar.typos import likely_name
from tltlc.resolve import units
from tltlc.resolve.problem import Log, ResolutionError, problem

_KNOWN: Final = (*units.TYPES, "entity")
_NO_RANGE: Final = ("bool", "ratio", "entity")
_ASSUMED: Final = 1e6
"""The ends of the range with which a text is checked if the author wrote none."""
Typed = Union[tree.Parameter, tree.SignalDecl, tree.ParamDecl]
"""What has a type."""

_TYPES_ELSEWHERE: Final = {
    **dict.fromkeys(("float", "double", "real"), "number"),
    "integer": "int",
    **dict.fromkeys(("boolean", "flag", "event", "trigger", "pulse"), "bool"),
    "distance": "length",
    "duration": "time",
    "velocity": "speed",
}
"""Maps names of types in other languages to the types of this language."""
_EVENTS: Final = ("event", "trigger", "pulse")
"""Names of types for what happens at single steps."""


def unknown_type_error(name: str, at: Typed, source: SourceFile) -> ResolutionError:
    """Return the error (TLT0211) for a type that the language does not have."""
    suggestion = _meant_type(name)
    advice = f"did you mean `{suggestion}`?" if suggestion else f"the types are {', '.join(_KNOWN)}"
    if name.lower() in _EVENTS:
        advice = "write `bool`: true at each step at which it happens"
    if suggestion is None and isinstance(at, tree.SignalDecl):
        advice += ", or a list of values: `(idle, alert)`"
    if name.lower() == "enum" and isinstance(at, tree.SignalDecl):
        suggestion, advice = None, f"list the values: `signal {at.name}: (idle, alert)`"
    start = source.text.find(name, at.name_span.end, at.span.end)
    span = Span(start, start + len(name)) if start >= 0 else at.span
    if suggestion and start >= 0 and _lacks_range(at, suggestion):
        si = units.si_unit(units.TYPES[suggestion])
        unit = f" {si}" if si else ""
        declared = f"{source.slice(Span(at.span.start, start))}{suggestion} in [LOW{unit}, HIGH{unit}]"
        advice = f"write `{declared}`, with its least value for LOW and its greatest for HIGH"
    fixes = (replacement_fix(source, span, suggestion),) if suggestion and start >= 0 else ()
    return problem("TLT0211", f"there is no type `{name}`", source, span, advice=advice, fixes=fixes)


def with_meant_types(module: Module, log: Log) -> Module:
    """Return a module whose signals and params have the types that their unknown types are meant to be.

    Each unknown type that can only be meant as one type is logged as an error. So the rest of the text is checked
    as if that type stood there. A signal without a range gets a wide one.
    """
    declarations = tuple(
        _with_meant_type(declaration, module.source, log)
        if isinstance(declaration, (tree.SignalDecl, tree.ParamDecl))
        else declaration
        for declaration in module.declarations
    )
    return module if declarations == module.declarations else replace(module, declarations=declarations)


def _with_meant_type(
    declaration: tree.SignalDecl | tree.ParamDecl, source: SourceFile, log: Log
) -> tree.SignalDecl | tree.ParamDecl:
    name = declaration.type
    meant = None if name is None or units.value_type(name) else _meant_type(name)
    if name is None or meant in (None, "entity"):
        return declaration
    log.add(unknown_type_error(name, declaration, source).diagnostic)
    if not _lacks_range(declaration, str(meant)):
        return replace(declaration, type=meant)
    low, high = (_end(end, str(meant), declaration.span) for end in (-_ASSUMED, _ASSUMED))
    return replace(declaration, type=meant, interval=tree.Interval(low, high, declaration.span))


def _end(value: float, type_: str, span: Span) -> tree.Expr:
    """Return the end of a range of a type, in its SI unit."""
    unit = units.si_unit(units.TYPES[type_])
    number = tree.NumberExpr(value, unit.numerator if unit else None, span)
    if unit is None or unit.denominator is None:
        return number
    return tree.BinaryExpr("/", number, tree.NumberExpr(1.0, unit.denominator, span), span, span)


def _meant_type(name: str) -> str | None:
    """Return the type that an unknown type is meant to be, or None if that is not clear."""
    elsewhere = units.type_of_unit(UNITS_ELSEWHERE.get(name.lower(), name)) or _TYPES_ELSEWHERE.get(name.lower())
    return elsewhere or likely_name(name, _KNOWN)


def _lacks_range(at: Typed, type_: str) -> bool:
    return isinstance(at, tree.SignalDecl) and at.interval is None and type_ not in _NO_RANGE
