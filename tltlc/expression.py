"""Arithmetic over signals and params: what an atom's robustness is computed from.

The nodes mirror the artefact's JSON one to one (design: ``expression`` of an atom).  They are
frozen, know nothing of the surface language and hold no units: every number is in SI units.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Union

ArithmeticOp = Literal["+", "-", "*", "/", "^", "neg", "min", "max", "abs", "clamp", "sqrt", "exp", "tanh"]
ConditionOp = Literal["<", "<=", ">", ">=", "and", "or", "not"]


@dataclass(frozen=True, slots=True)
class Const:
    """A finite number."""

    value: float


@dataclass(frozen=True, slots=True)
class Signal:
    """The present value of a signal, by its full name, e.g. ``distance(s1)``; a bool counts as 0 or 1."""

    name: str


@dataclass(frozen=True, slots=True)
class Param:
    """The value of a param, by name."""

    name: str


@dataclass(frozen=True, slots=True)
class Op:
    """An operator or function over expressions; ``clamp`` takes (x, low, high), ``min`` and ``max`` two or more."""

    op: ArithmeticOp
    args: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Condition:
    """A comparison of two expressions, or ``and``, ``or``, ``not`` over conditions."""

    op: ConditionOp
    args: tuple[Union[Expression, Condition], ...]


@dataclass(frozen=True, slots=True)
class When:
    """The first case whose condition holds, else ``otherwise``."""

    cases: tuple[tuple[Condition, Expression], ...]
    otherwise: Expression


Expression = Union[Const, Signal, Param, Op, When]
