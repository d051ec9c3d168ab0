"""Split deeply nested expressions, for languages whose parsers or compilers limit nesting.

The robustness of a guard with many literals is such an expression: nested calls of ``min`` and
``max``.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import count
from typing import Final

from tltlc.program.tree import (
    Assign,
    Choice,
    Declare,
    If,
    Negate,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Statement,
)

PART: Final = "part"
"""The prefix of the variables that :func:`split_deep_values` adds, which are numbered from 1."""

_DEEPEST: Final = 30
"""The greatest depth of an expression, the same as for predicates (:mod:`tltlc.program.arithmetic`)."""


def split_deep_values(statements: Sequence[Statement], taken: Collection[str] = ()) -> tuple[Statement, ...]:
    """Return the statements, with parts of deeply nested expressions moved to new variables.

    ``statements`` compute the transition from one state of an automaton. The new variables are
    called ``part1``, ``part2``, and so on. If a name in ``taken`` begins with ``part``, they are
    called ``part_1``, ``part_2``, and so on, with further underscores if needed.
    """
    prefix = PART
    while any(name.startswith(prefix) for name in taken):
        prefix += "_"
    return _split_statements(statements, (f"{prefix}{number}" for number in count(1)))


def _split_statements(statements: Sequence[Statement], names: Iterator[str]) -> tuple[Statement, ...]:
    lines: list[Statement] = []
    for statement in statements:
        if isinstance(statement, If):
            cases = tuple((test, _split_statements(body, names)) for test, body in statement.cases)
            lines.append(If(cases, _split_statements(statement.otherwise, names)))
        elif isinstance(statement, Assign):
            lines.append(Assign(statement.name, _cut(statement.value, lines, names)[0]))
        elif isinstance(statement, Declare) and statement.value is not None:
            value, _ = _cut(statement.value, lines, names)
            lines.append(Declare(statement.name, statement.type, value, statement.changes))
        else:
            lines.append(statement)
    return tuple(lines)


def _cut(value: ProgramExpression, lines: list[Statement], names: Iterator[str]) -> tuple[ProgramExpression, int]:
    """Return the expression with variables in place of its deep parts, and its new depth.

    Append the declarations of these variables to ``lines``, and take their names from ``names``.
    """
    if isinstance(value, Negate):
        operand, depth = _cut(value.operand, lines, names)
        return Negate(operand), depth
    if isinstance(value, Choice):
        chosen, chosen_depth = _cut(value.value, lines, names)
        otherwise, depth = _cut(value.otherwise, lines, names)
        return Choice(value.test, chosen, otherwise), max(chosen_depth, depth) + 1
    if not isinstance(value, NumericCall):
        return value, 0
    args, deepest = [], 0
    for argument in value.args:
        cut, depth = _cut(argument, lines, names)
        if depth >= _DEEPEST:
            name = next(names)
            lines.append(Declare(name, "real", cut))
            cut, depth = ProgramVariable(name), 0
        args.append(cut)
        deepest = max(deepest, depth)
    return NumericCall(value.function, tuple(args)), deepest + 1
