"""Interpret programs directly, so that the peculiarities of no target language hide a mistake in a program."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping

from tltlc.program.build import Program
from tltlc.program.shapes import StateTables
from tltlc.program.states import FIRST_EDGE
from tltlc.program.tree import (
    All,
    Any,
    Assign,
    BinaryNumber,
    Bool,
    Choice,
    CommentLine,
    Compare,
    Declare,
    If,
    Int,
    Negate,
    Not,
    NumericCall,
    ProgramExpression,
    ProgramVariable,
    Real,
    Statement,
    TableEntry,
)

Value = float | int | bool


class NoValueError(Exception):
    """An operation has no value."""


class Scope:
    """Variables; each is declared once, and assigned before it is read. ``look_ups`` counts entries of tables read."""

    def __init__(self, values: Mapping[str, Value], tables: StateTables | None = None) -> None:
        self.values = dict(values)
        self.look_ups = 0
        self._tables = tables
        self._constant: set[str] = set()
        self.changing: set[str] = set(values)

    def run(self, statements: Iterable[Statement]) -> None:
        for statement in statements:
            match statement:
                case CommentLine():
                    pass
                case Declare(name, _, value, changes):
                    assert name not in self.values
                    if changes:
                        self.changing.add(name)
                    if value is not None:
                        self._assign(name, self.value(value))
                case Assign(name, value):
                    self._assign(name, self.value(value))
                case If(cases, otherwise):
                    self.run(next((body for test, body in cases if self.value(test)), otherwise))

    def _assign(self, name: str, value: Value) -> None:
        assert name in self.changing or name not in self.values, f"{name} changes, and does not say so"
        self.values[name] = value

    def value(self, node: ProgramExpression) -> Value:
        match node:
            case Real(value) | Int(value) | Bool(value):
                return value
            case ProgramVariable(name):
                return self.values[name]
            case Negate(operand):
                return -self.value(operand)
            case BinaryNumber(op, left, right):
                return _OPERATIONS[op](self.value(left), self.value(right))
            case NumericCall(function, args):
                return _call(function, [self.value(argument) for argument in args])
            case Compare(op, left, right):
                return _COMPARISONS[op](self.value(left), self.value(right))
            case Not(operand):
                return not self.value(operand)
            case All(args):
                return all(self.value(argument) for argument in args)
            case Choice(test, value, otherwise):
                return self.value(value if self.value(test) else otherwise)
            case TableEntry(table, index):
                place = self.value(index)
                assert isinstance(place, int) and place >= 0
                self.look_ups += 1
                entry: float = getattr(self._tables, table)[place]
                return entry
            case Any(args):
                return any(self.value(argument) for argument in args)
        raise TypeError(node)


def step(
    program: Program, state: int, steps: int, best: float, done: bool, atoms: Mapping[str, float]
) -> dict[str, Value]:
    """Return the variables after a step on the values of the atoms; ``steps`` is the number of this step."""
    tables = program.tables
    scope = Scope(atoms, tables)
    scope.changing |= {"target", "robustness", "progress", "limiting", "failure", "best", "reward", "done"}
    if tables is not None:
        scope.values[FIRST_EDGE] = tables.first_edges[state]
    scope.run(program.cases[state if tables is None else tables.state_shapes[state]].statements)
    target = program.fspa.states[int(scope.values["target"])]
    ends = target.verdict in ("satisfied", "violated") or (program.fspa.judge == "goal" and target.accepting)
    scope.values |= {"steps": steps, "steps_real": float(steps), "best": best, "done": done, "ends": ends}
    scope.values |= {"violated": target.verdict == "violated", "satisfied": target.verdict == "satisfied"}
    scope.run(program.reward_statements)
    return scope.values


def failure_names(program: Program, outcome: Mapping[str, Value]) -> tuple[str | None, str | None]:
    """Return the clause and the atom that a step fails at, as the program finds them; None where it finds none."""
    if "failure" not in outcome:
        return None, None
    clause, atom = program.failures[int(outcome["failure"])]
    fspa = program.fspa
    return None if clause is None else fspa.clauses[clause], None if atom is None else fspa.atoms[atom].name


def _call(function: str, args: list[Value]) -> float:
    try:
        match function:
            case "divide":
                return args[0] / args[1]
            case "power":
                return math.pow(*args)
            case "min":
                return args[1] if args[1] < args[0] else args[0]
            case "max":
                return args[1] if args[1] > args[0] else args[0]
            case "abs":
                return abs(args[0])
        return float({"sqrt": math.sqrt, "exp": math.exp, "tanh": math.tanh}[function](*args))
    except (ZeroDivisionError, OverflowError, ValueError) as error:
        raise NoValueError(type(error).__name__) from None


_OPERATIONS: dict[str, Callable[[Value, Value], float]] = {
    "+": lambda x, y: x + y,
    "-": lambda x, y: x - y,
    "*": lambda x, y: x * y,
    "/": lambda x, y: x / y,
}
_COMPARISONS: dict[str, Callable[[Value, Value], bool]] = {
    "<": lambda x, y: x < y,
    "<=": lambda x, y: x <= y,
    ">": lambda x, y: x > y,
    ">=": lambda x, y: x >= y,
    "==": lambda x, y: x == y,
    "!=": lambda x, y: x != y,
}
