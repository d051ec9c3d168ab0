"""Statements without values that nest deep, for languages whose parsers or compilers have little room for these.

Guards of many literals make them: the robustness of an edge is the least or greatest of as many values.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import count
from typing import Final

from tltlc.program.tree import Assign, Call, Declare, Expression, If, Negate, Statement, Variable

PART: Final = "part"
"""What new variables begin with, which are numbered from 1."""

_DEEPEST: Final = 30
"""As predicates nest, see :mod:`tltlc.program.arithmetic`."""


def shallow(statements: Sequence[Statement], taken: Collection[str] = ()) -> tuple[Statement, ...]:
    """The same statements, of a state, with parts of deep values in variables of their own.

    New variables have different names, which do not begin as a name that is ``taken`` does.
    """
    prefix = PART
    while any(name.startswith(prefix) for name in taken):
        prefix += "_"
    return _shallow(statements, (f"{prefix}{number}" for number in count(1)))


def _shallow(statements: Sequence[Statement], names: Iterator[str]) -> tuple[Statement, ...]:
    lines: list[Statement] = []
    for statement in statements:
        if isinstance(statement, If):
            cases = tuple((test, _shallow(body, names)) for test, body in statement.cases)
            lines.append(If(cases, _shallow(statement.otherwise, names)))
        elif isinstance(statement, Assign):
            lines.append(Assign(statement.name, _cut(statement.value, lines, names)[0]))
        elif isinstance(statement, Declare) and statement.value is not None:
            value, _ = _cut(statement.value, lines, names)
            lines.append(Declare(statement.name, statement.type, value, statement.changes))
        else:
            lines.append(statement)
    return tuple(lines)


def _cut(value: Expression, lines: list[Statement], names: Iterator[str]) -> tuple[Expression, int]:
    """The value with what nests too deep in variables, and how deep it nests then."""
    if isinstance(value, Negate):
        operand, depth = _cut(value.operand, lines, names)
        return Negate(operand), depth
    if not isinstance(value, Call):
        return value, 0
    args, deepest = [], 0
    for argument in value.args:
        cut, depth = _cut(argument, lines, names)
        if depth >= _DEEPEST:
            name = next(names)
            lines.append(Declare(name, "real", cut))
            cut, depth = Variable(name), 0
        args.append(cut)
        deepest = max(deepest, depth)
    return Call(value.function, tuple(args)), deepest + 1
