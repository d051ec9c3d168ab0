"""Find the variables and functions that statements use.

The backends declare only what is used, since some compilers warn about unused variables and
functions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tltlc.program.tree import (
    Assign,
    Declare,
    If,
    NumericCall,
    NumericFunction,
    ProgramExpression,
    ProgramVariable,
    Statement,
    operands,
)


def variables_read(statements: Iterable[Statement]) -> frozenset[str]:
    """Return the names of the variables that the statements read."""
    return names_in(_values(statements))


def names_in(expressions: Iterable[ProgramExpression]) -> frozenset[str]:
    """Return the names of the variables in expressions."""
    return frozenset(node.name for node in parts(expressions) if isinstance(node, ProgramVariable))


def functions_called(statements: Iterable[Statement]) -> frozenset[NumericFunction]:
    """Return the functions that the statements call."""
    return functions_in(_values(statements))


def functions_in(expressions: Iterable[ProgramExpression]) -> frozenset[NumericFunction]:
    """Return the functions that the expressions call."""
    return frozenset(node.function for node in parts(expressions) if isinstance(node, NumericCall))


def parts(expressions: Iterable[ProgramExpression]) -> Iterator[ProgramExpression]:
    """Yield the expressions and all their subexpressions, in no particular order.

    The function uses a stack instead of recursion, so that deeply nested predicates cause no
    RecursionError.
    """
    stack = list(expressions)
    while stack:
        node = stack.pop()
        yield node
        stack += operands(node)


def assigned_in(statements: Iterable[Statement]) -> frozenset[str]:
    """Return the names of the variables to which the statements assign, also inside the cases of an ``if``."""
    names: set[str] = set()
    for statement in statements:
        match statement:
            case Assign(name, _):
                names.add(name)
            case If(cases, otherwise):
                names = names.union(*(assigned_in(body) for _, body in cases), assigned_in(otherwise))
    return frozenset(names)


def _values(statements: Iterable[Statement]) -> Iterator[ProgramExpression]:
    """Yield the expressions that statements compute or test, also inside the cases of an ``if``."""
    for statement in statements:
        match statement:
            case Declare(_, _, value):
                if value is not None:
                    yield value
            case Assign(_, value):
                yield value
            case If(cases, otherwise):
                for test, body in cases:
                    yield test
                    yield from _values(body)
                yield from _values(otherwise)
