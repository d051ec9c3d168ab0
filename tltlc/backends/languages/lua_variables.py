"""The variables of a monitor in Lua: local variables or, if there are too many, fields of tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from tltlc.backends.languages.lua_syntax import DEEPEST_BLOCK, key_access
from tltlc.program.build import DT, Program
from tltlc.program.tree import Declare, If, Statement
from tltlc.resolve.spec import Atom, Param, Register, Signal

_MOST_LOCALS: Final = 150
"""The most local variables and arguments for the signals, params and atoms of a spec.

The step function has more local variables, and Lua allows 200 in all.
"""

TABLES: Final = ("signal", "param", "value", "register", "registers")
"""The tables of variables: signals, params, atoms, and the registers after and before the sample."""


def needs_fields(program_: Program) -> bool:
    """Whether a program has too many variables, or too deep blocks, for local variables."""
    variables = (*program_.signals, *program_.params, *program_.atoms, *program_.registers)
    # Each variable counts twice, because it is also an argument of the functions of states.
    if 2 * len(variables) + len(_temporaries(program_)) > _MOST_LOCALS:
        return True
    return max(map(_nesting, _computations(program_)), default=0) >= DEEPEST_BLOCK


def variable_fields(program_: Program) -> dict[str, str]:
    """Map each variable of a program to the text that accesses its field, such as ``signal.health``."""
    fspa = program_.fspa
    temporaries = [*_temporaries(program_), *([DT] if fspa.clock_varies else [])]
    return {
        **_fields("signal", fspa.signals, program_.signals),
        **_fields("param", fspa.params, program_.params),
        **_fields("value", fspa.atoms, program_.atoms),
        **{name: f"part.{name}" for name in temporaries},
        **_fields("register", fspa.registers, program_.registers),
    }


def register_fields(program_: Program) -> dict[str, str]:
    """Map the variable of each register before the sample, which is always a field, to the text that accesses it."""
    return _fields("registers", program_.fspa.registers, program_.before)


def _fields(
    table: str, declared: Sequence[Signal | Param | Atom | Register], variables: Sequence[str]
) -> dict[str, str]:
    return {variable: f"{table}{key_access(part.name)}" for part, variable in zip(declared, variables, strict=True)}


def _computations(program_: Program) -> tuple[tuple[Statement, ...], ...]:
    return (*program_.values, *program_.updates)


def _temporaries(program_: Program) -> list[str]:
    """Return the names of the variables that the computations of atoms and registers declare."""
    return [declaration.name for statements in _computations(program_) for declaration in _declarations(statements)]


def _declarations(statements: Iterable[Statement]) -> Iterator[Declare]:
    """Yield every declaration among the statements, including those in branches."""
    for statement in statements:
        if isinstance(statement, Declare):
            yield statement
        elif isinstance(statement, If):
            for body in _bodies(statement):
                yield from _declarations(body)


def _nesting(statements: Iterable[Statement]) -> int:
    """Return how deep ``if`` statements are nested; 0 if there are none."""
    bodies = [body for statement in statements if isinstance(statement, If) for body in _bodies(statement)]
    return 1 + max(map(_nesting, bodies)) if bodies else 0


def _bodies(statement: If) -> tuple[tuple[Statement, ...], ...]:
    return (*(body for _, body in statement.cases), statement.otherwise)
