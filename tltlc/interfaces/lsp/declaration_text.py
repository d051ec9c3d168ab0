"""Short descriptions of declarations: their text, meaning, range and unit."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from textwrap import dedent
from typing import Final, Union

from tltlc.core.source import SourceFile, Span
from tltlc.grammar.tree import (
    Declaration,
    LetDecl,
    NameExpr,
    ParamDecl,
    Parameter,
    PredicateDecl,
    Quantified,
    SignalDecl,
    SpecDecl,
)
from tltlc.interfaces.lsp.occurrences import Symbol
from tltlc.logic.text.english import english_text
from tltlc.resolve import formulas, units
from tltlc.resolve.context import Context
from tltlc.resolve.spec import Spec
from tltlc.resolve.values import Env, number_text, range_text

_LONGEST: Final = 600
"""The most characters of a declaration that is shown as written. A longer one is shown by its head."""

_SUPPLIED_AS: Final = {
    "length": "metres",
    "time": "seconds",
    "speed": "metres per second",
    "angle": "radians",
    "int": "a whole number",
    "bool": "true or false",
}


def declaration_text(
    declaration: Union[Declaration, NameExpr, Parameter, Quantified], source: SourceFile, *, head: bool = False
) -> str:
    """Return a declaration as written, or its head if ``head`` is set or the declaration is longer than 600 characters.

    The head of a spec is ``spec NAME``; the head of a predicate or ``let`` is the part before
    ``=``. For other declarations, it is the whole declaration on one line. An entity and a
    quantifier are always one line, such as ``entity key`` and ``all x in (key, door)``.
    """
    if isinstance(declaration, NameExpr):
        return f"entity {declaration.name}"
    if isinstance(declaration, Quantified):
        names = ", ".join(entity.name for entity in declaration.entities)
        listed = f"({names})" if declaration.brackets else names
        return f"{'all' if declaration.all else 'any'} {declaration.variable} in {listed}"
    span = declaration.span
    text = dedent(source.slice(span))
    if not head and len(text) <= _LONGEST:
        return text
    if isinstance(declaration, SpecDecl):
        return f"spec {declaration.name}"
    if isinstance(declaration, (PredicateDecl, LetDecl)):
        text = source.slice(Span(span.start, declaration.body.span.start)).rstrip().removesuffix("=")
    return " ".join(text.split())


def symbol_markdown(symbol: Symbol, env: Env, via: str | None) -> str:
    """Describe in Markdown the declaration of a name that is not a spec: its text, documentation and meaning.

    ``env`` contains the resolved meanings of visible names. ``via`` is the name of the imported file
    that declares the name; None if the document itself declares it.
    """
    declaration = symbol.declaration
    lines = [_code(declaration_text(declaration, symbol.source))]
    doc = getattr(declaration, "doc", "")
    lines += [doc] if doc else []
    lines += _facts(symbol, env)
    lines += [f"From `{via}`."] if via else []
    return "\n\n".join(lines)


def spec_markdown(declaration: SpecDecl, spec: Spec | None, source: SourceFile, figures: str | None) -> str:
    """Describe a spec in Markdown: its meaning in English, its settings, and the size of its automaton.

    ``figures`` is a text about the size, such as ``7 states, distance 3.``; None if the size is not
    known. ``spec`` is the resolved spec. If it is None because the spec has errors, meaning and
    settings are left out.
    """
    lines = [_code(declaration_text(declaration, source, head=True))]
    lines += [declaration.doc] if declaration.doc else []
    if spec is not None:
        lines.append(english_text(spec.formula, endless=spec.semantics == "infinite"))
        settings = [f"limit {spec.limit_steps} steps"] if spec.limit_steps else []
        settings += [f"level {spec.level}"] if spec.level else []
        settings += [f"tags {', '.join(spec.tags)}"] if spec.tags else []
        lines += [", ".join(settings)] if settings else []
    lines += [figures] if figures else []
    return "\n\n".join(lines)


def _code(text: str) -> str:
    return f"```tltl\n{text}\n```"


def _facts(symbol: Symbol, env: Env) -> Iterator[str]:
    """Yield sentences about a name: its type, range, unit and value; for a ``let``, its meaning."""
    declaration, context = symbol.declaration, env.context
    if isinstance(declaration, SignalDecl):
        yield from _signal(declaration, context)
    elif isinstance(declaration, ParamDecl):
        param = context.params.get(declaration.name)
        if param is not None:
            dimension = units.TYPES[param.type]
            unit = units.si_unit(dimension)
            value = number_text(param.value) + (f" {unit}" if unit else "")
            yield f"{_article(param.type)} constant, {value}{_range(param.low, param.high, param.type)}."
    elif isinstance(declaration, PredicateDecl):
        low, high = (declaration.interval.low, declaration.interval.high) if declaration.interval else (None, None)
        interval_text = (
            f"[{symbol.source.slice(low.span)}, {symbol.source.slice(high.span)}]" if low and high else "[-1, 1]"
        )
        yield f"An atom, with values in {interval_text}: it holds where the value is above 0."
    elif isinstance(declaration, LetDecl) and not declaration.parameters:
        sentence = _english(declaration, env)
        if sentence:
            yield sentence
    elif isinstance(declaration, NameExpr):
        yield "An object of the level."


def _signal(declaration: SignalDecl, context: Context) -> Iterator[str]:
    info = context.signal_infos.get(declaration.name)
    if info is None:
        return
    if info.values:
        numbers = ", ".join(f"{number} for {name}" for number, name in enumerate(info.values))
        yield f"An enum, supplied by the game as the name of a value, or as its number: {numbers}."
        return
    text = f"{_article(info.type)} signal, supplied by the game as {_SUPPLIED_AS.get(info.type, 'a plain number')}"
    yield f"{text}{_range(info.low, info.high, info.type)}."


def _english(declaration: LetDecl, env: Env) -> str | None:
    binding = env.scope.names.get(declaration.name)
    if binding is None:
        return None
    formula = formulas.known_formula(declaration.body, env.inside(binding.scope, {}))
    return None if formula is None else english_text(formula)


def _article(type_: str) -> str:
    return f"{'An' if type_[0] in 'aeiou' else 'A'} {type_}"


def _range(low: float | None, high: float | None, type_: str) -> str:
    """Return the text about the range of a signal or param; empty if it has none."""
    if type_ == "bool" or (low is None and high is None):
        return ""
    ends = -inf if low is None else low, inf if high is None else high
    return "; its range is " + range_text(*ends, units.TYPES[units.value_type(type_) or "number"])
