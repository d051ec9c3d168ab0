"""The values that expressions have during resolution, and the environment in which names get these values."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import isinf
from typing import Union

from tltlc.core.record import EMPTY, record, replace
from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import Const, Expression, Op
from tltlc.logic.formula import Formula
from tltlc.resolve.context import Context
from tltlc.resolve.counts_within import Window
from tltlc.resolve.ranges import overflows, range_of
from tltlc.resolve.scope import Scope
from tltlc.resolve.units import Dimension, si_unit

LOOSEST, SUM, PRODUCT, SIGN, POWER, CLOSED = range(6)
"""How tightly the outermost operator in the text of a quantity binds, from loosest to tightest.

The text of a quantity without an operator, such as a name or a call, is CLOSED.
"""


@record
class Entity:
    """An entity: an object of the level, which predicates and signals can have as an argument."""

    name: str


@record
class Recall:
    """That a quantity is the count or time in a register which saturates, with no maximum yet or a written one.

    ``unit`` is the size of one unit of the register: the seconds of a step, or 1. ``is_count`` marks a
    count, and ``is_whole`` a register that has whole numbers only. ``limit`` is the place where the
    maximum is written; None if the quantity has no maximum yet. ``window`` is the time in which a count
    looks back; None for one of all the trace so far.
    """

    register: str
    unit: Fraction
    is_count: bool
    is_whole: bool = True
    limit: Label | None = None
    most: float | None = None
    window: Window | None = None


@record
class Quantity:
    """A number that depends on signals and params.

    - ``dimension`` is None if it fits any dimension, as for 0 and inf.
    - ``low`` and ``high`` bound the value, in SI units.
    - ``text`` is the unique spelling of the quantity in the names of atoms.
    - ``binding`` says how tightly the outermost operator of ``text`` binds.
    - ``depth`` is the depth of the expression.
    - ``is_bool`` marks a value that is 0 or 1 by type.
    - ``is_whole`` marks a value that is a whole number by type, for ``==``.
    - ``overflows`` marks a value whose arithmetic may overflow although all its inputs have finite
      ranges.
    - ``recall`` marks a count or time of the trace so far whose maximum is not yet found, or is written.
    - ``call`` is the base and the arguments of a signal or a predicate, None for other quantities.
    """

    expression: Expression
    dimension: Dimension | None
    low: float
    high: float
    text: str
    binding: int = CLOSED
    depth: int = 1
    is_bool: bool = False
    overflows: bool = False
    is_whole: bool = False
    call: tuple[str, tuple[str, ...]] | None = None
    recall: Recall | None = None

    @property
    def is_constant(self) -> bool:
        """Whether the quantity is a plain number."""
        return isinstance(self.expression, Const)

    def operand_text(self, binding: int) -> str:
        """Return the text, in brackets if its operator binds more loosely than ``binding``."""
        return self.text if self.binding >= binding else f"({self.text})"


@record
class Unknown:
    """A placeholder for an argument of unknown kind, for the check of a definition that nothing uses."""

    name: str


ResolvedValue = Union[Entity, Quantity, Formula, Unknown]


@record
class Env:
    """What the names in an expression mean: the names visible in its module, and its local names.

    ``local`` has the values of parameters and quantified variables. ``symbolic`` is true while a
    definition is checked with placeholders as its arguments. ``constant`` forbids signals and params.
    ``is_event`` says that a comparison stands in the condition of a rule, as before `implies`.
    ``unbounded`` makes ``F[0,3] p`` mean ``F p``, and ``G[0,3] p`` mean ``G p``. It is set only for
    text that has already been resolved with its bounds, so no size is checked and nothing is counted
    again.
    """

    context: Context
    scope: Scope
    local: Mapping[str, ResolvedValue] = EMPTY
    symbolic: bool = False
    constant: bool = False
    unbounded: bool = False
    is_event: bool = False

    def inside(self, scope: Scope, local: Mapping[str, ResolvedValue]) -> Env:
        """Return the environment inside a declaration of ``scope``, with these local names."""
        return replace(self, scope=scope, local=local)

    def with_local(self, name: str, value: ResolvedValue) -> Env:
        """Return a copy of the environment with one more local name."""
        return replace(self, local={**self.local, name: value})


def number_text(value: float) -> str:
    """Return the shortest text that reads back as the same number; whole numbers have no point."""
    is_whole = not isinf(value) and abs(value) < 1e15 and value == int(value)
    return str(int(value)) if is_whole else repr(value)


def range_text(low: float, high: float, dimension: Dimension | None) -> str:
    """Return a range as messages show it, in SI units: ``[2 m, inf]``."""
    unit = si_unit(dimension) if dimension else None
    ends = (number_text(end) + (f" {unit}" if unit and not isinf(end) else "") for end in (low, high))
    return f"[{', '.join(ends)}]"


def constant(value: float, dimension: Dimension | None) -> Quantity:
    """Return a plain number as a quantity."""
    return Quantity(
        Const(value),
        dimension,
        value,
        value,
        number_text(value),
        SIGN if value < 0 else CLOSED,
        is_whole=value.is_integer(),
    )


_INFIX = {
    "+": (SUM, SUM, PRODUCT),
    "-": (SUM, SUM, PRODUCT),
    "*": (PRODUCT, PRODUCT, SIGN),
    "/": (PRODUCT, PRODUCT, SIGN),
}


_WHOLE = frozenset({"+", "-", "*", "neg", "min", "max", "abs", "clamp"})
"""The operators whose result is a whole number if all arguments are."""


def apply(op: str, args: tuple[Quantity, ...], dimension: Dimension | None) -> Quantity | None:
    """Return the quantity ``op`` applied to ``args``; ``dimension`` is the dimension of the result.

    If all arguments are constant, so is the result. Return None if its value is infinite or
    undefined, as for ``1 / 0``.
    """
    ranges = tuple((arg.low, arg.high) for arg in args)
    low, high = range_of(op, ranges)
    if all(arg.is_constant for arg in args):
        return constant(low, dimension) if low == high and not isinf(low) else None
    if op in _INFIX:
        binding, left, right = _INFIX[op]
        text = f"{args[0].operand_text(left)} {op} {args[1].operand_text(right)}"
    elif op == "^":
        binding, text = POWER, f"{args[0].operand_text(CLOSED)}^{args[1].operand_text(CLOSED)}"
    elif op == "neg":
        binding, text = SIGN, f"-{args[0].operand_text(POWER)}"
    else:
        binding, text = CLOSED, f"{op}({', '.join(arg.text for arg in args)})"
    expression = Op(op, tuple(arg.expression for arg in args))  # type: ignore[arg-type]
    too_large = any(arg.overflows for arg in args) or overflows(op, ranges)
    whole = op in _WHOLE and all(arg.is_whole for arg in args)
    depth = 1 + max(arg.depth for arg in args)
    return Quantity(expression, dimension, low, high, text, binding, depth, overflows=too_large, is_whole=whole)
