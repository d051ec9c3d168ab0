"""Say what suggested clauses ask for where a reader may expect something else: counts, times, and `until`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, floor
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.grammar import lalr
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.tables import load
from tltlc.grammar.tree import BinaryExpr, CallExpr, Declaration, Expr, NumberExpr
from tltlc.grammar.walk import expressions, parts

_SECONDS: Final = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}
_MOST_STEPS: Final = 100
"""With more steps, one more or less is hardly noticed."""


def notes(clauses: str, names: DeclaredNames, typed: str) -> tuple[str, ...]:
    """Return what to know of clauses that stand for ``typed``: nothing of what stands there already."""
    source = SourceFile("", f"spec s {{ {clauses} }}", "text")
    lexed = tokenize(source.text)
    try:
        declarations: Sequence[Declaration] = lalr.run(load(), "module", lexed.tokens, Builder(source, lexed.docs))
    except lalr.UnexpectedTokenError:
        return ()
    written = (part for spec in declarations for part in expressions(spec))
    all_notes = (note for part in written for note in _notes(part, source, names.step_s))
    return tuple(dict.fromkeys(note for note, word in all_notes if word not in typed))


def _notes(expression: Expr, source: SourceFile, step_s: float) -> Iterator[tuple[str, str]]:
    """Yield each note of an expression, and the word or function that it is about."""
    for part in parts(expression):
        if isinstance(part, CallExpr) and part.name == "times":
            inner = source.slice(part.arguments[0].span)
            yield f"`{source.slice(part.span)}` counts how often `{inner}` begins: steps in a row count once", "times("
        elif isinstance(part, BinaryExpr) and part.op == "U":
            end = source.slice(part.right.span)
            yield f"write `weak_until` for `until` if play may end before `{end}`", "weak_until"
        elif isinstance(part, BinaryExpr) and part.op in (">", ">=") and _is_held(part.left):
            note = _of_time(part, source, step_s)
            if note:
                yield note, "time_holding"


def _is_held(expression: Expr) -> bool:
    return isinstance(expression, CallExpr) and expression.name == "time_holding"


def _of_time(comparison: BinaryExpr, source: SourceFile, step_s: float) -> str:
    """Return how many steps in a row take a time, which is 0 s at the first of them."""
    limit = comparison.right
    if not isinstance(limit, NumberExpr) or limit.unit not in _SECONDS or not step_s:
        return ""
    steps = round(limit.value * _SECONDS[limit.unit] / step_s, 6)
    number = (ceil(steps) if comparison.op == ">=" else floor(steps) + 1) + 1
    if number > _MOST_STEPS:
        return ""
    return f"the time is 0 s at the first step, so `{source.slice(comparison.span)}` needs {number} steps in a row"
