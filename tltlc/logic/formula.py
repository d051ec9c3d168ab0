"""Immutable, hash-consed formulas of truncated linear temporal logic.

Equal formulas are one object, so ``is`` compares, and a table may be keyed by formula.  The
constructors below keep what was written: they do not simplify (that is :mod:`tltlc.logic.rewrite`)
and ``&`` and ``|`` keep the order of their operands.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import Final, Literal
from weakref import WeakValueDictionary

Op = Literal["true", "false", "atom", "not", "and", "or", "implies", "iff", "X", "N", "F", "G", "U", "W", "R", "M"]

UNARY_TEMPORAL: Final = ("X", "N", "F", "G")
BINARY_TEMPORAL: Final = ("U", "W", "R", "M")


class Formula:
    """A node: ``op``, its ``args`` (formulas), and for an atom its ``name``.

    Never constructed directly: use the functions of this module.  ``and`` and ``or`` hold two or
    more operands, none of the same operator.
    """

    __slots__ = ("__weakref__", "args", "name", "op")
    op: Op
    args: tuple[Formula, ...]
    name: str

    def __repr__(self) -> str:
        from tltlc.logic.text.printer import ascii_text

        return f"<Formula {ascii_text(self)}>"

    def __str__(self) -> str:
        from tltlc.logic.text.printer import ascii_text

        return ascii_text(self)

    def __reduce__(self) -> tuple[object, ...]:
        return (_intern, (self.op, self.args, self.name))

    def walk(self) -> Iterator[Formula]:
        """Every distinct subformula, this one first, left before right, without recursion."""
        seen: set[Formula] = set()
        stack = [self]
        while stack:
            node = stack.pop()
            if node not in seen:
                seen.add(node)
                yield node
                stack.extend(reversed(node.args))

    def bottom_up(self, known: Container[Formula] = ()) -> Iterator[Formula]:
        """Every distinct subformula, each after its operands, this one last, without recursion.

        Subformulas in ``known`` are left out, and so is what stands only in them.
        """
        seen: set[Formula] = set()
        stack = [(self, False)]
        while stack:
            node, operands_done = stack.pop()
            if operands_done:
                yield node
            elif node not in seen and node not in known:
                seen.add(node)
                stack.append((node, True))
                stack.extend((argument, False) for argument in reversed(node.args))

    def atoms(self) -> tuple[str, ...]:
        """The names of the atoms, in the order in which they stand in the formula."""
        return tuple(node.name for node in self.walk() if node.op == "atom")

    @property
    def is_temporal(self) -> bool:
        """Whether the outermost operator is a temporal one."""
        return self.op in UNARY_TEMPORAL or self.op in BINARY_TEMPORAL


_table: WeakValueDictionary[tuple[object, ...], Formula] = WeakValueDictionary()


def _intern(op: Op, args: tuple[Formula, ...] = (), name: str = "") -> Formula:
    key = (op, name, *map(id, args))
    node = _table.get(key)
    if node is None:
        node = Formula.__new__(Formula)
        node.op, node.args, node.name = op, args, name
        _table[key] = node
    return node


TRUE: Final = _intern("true")
FALSE: Final = _intern("false")


def atom(name: str) -> Formula:
    """The atom of that name."""
    return _intern("atom", (), name)


def not_(operand: Formula) -> Formula:
    """Negation."""
    return _intern("not", (operand,))


def and_(*operands: Formula) -> Formula:
    """Conjunction in the order given, nested ones flattened; of none, ``true``."""
    return _nary("and", operands, TRUE)


def or_(*operands: Formula) -> Formula:
    """Disjunction in the order given, nested ones flattened; of none, ``false``."""
    return _nary("or", operands, FALSE)


def _nary(op: Literal["and", "or"], operands: Iterable[Formula], neutral: Formula) -> Formula:
    flat: list[Formula] = []
    for operand in operands:
        if operand.op == op:
            flat.extend(operand.args)
        else:
            flat.append(operand)
    if not flat:
        return neutral
    return flat[0] if len(flat) == 1 else _intern(op, tuple(flat))


def implies(left: Formula, right: Formula) -> Formula:
    """``left -> right``."""
    return _intern("implies", (left, right))


def iff(left: Formula, right: Formula) -> Formula:
    """``left <-> right``."""
    return _intern("iff", (left, right))


def next_(operand: Formula) -> Formula:
    """Strong next ``X``: there is a next sample and the operand holds from it on."""
    return _intern("X", (operand,))


def weak_next(operand: Formula) -> Formula:
    """Weak next ``N``: if there is a next sample, the operand holds from it on."""
    return _intern("N", (operand,))


def eventually(operand: Formula) -> Formula:
    """``F``: now or at some later sample of the trace."""
    return _intern("F", (operand,))


def always(operand: Formula) -> Formula:
    """``G``: now and at every later sample of the trace."""
    return _intern("G", (operand,))


def until(left: Formula, right: Formula) -> Formula:
    """``left U right``: right at some sample, left at all before it."""
    return _intern("U", (left, right))


def weak_until(left: Formula, right: Formula) -> Formula:
    """``left W right``: ``left U right`` or always left."""
    return _intern("W", (left, right))


def release(left: Formula, right: Formula) -> Formula:
    """``left R right``: right up to and including the first sample with left, or always."""
    return _intern("R", (left, right))


def strong_release(left: Formula, right: Formula) -> Formula:
    """``left M right``: right up to and including the first sample with left, which comes."""
    return _intern("M", (left, right))


def then(left: Formula, right: Formula) -> Formula:
    """``left then right`` = ``F(left & X F right)`` (semantics, section 2); a right operand that is a ``then`` nests.

    ``right`` that already begins with ``F`` is not given a second one.
    """
    rest = right if right.op == "F" else eventually(right)
    return eventually(and_(left, next_(rest)))


def temporal(op: Op, operands: tuple[Formula, ...]) -> Formula:
    """The temporal operator ``op`` over its one or two operands."""
    return _intern(op, operands)


def rebuild(formula: Formula, args: tuple[Formula, ...]) -> Formula:
    """The same operator over other operands; ``and`` and ``or`` flatten again."""
    if formula.op == "and":
        return and_(*args)
    if formula.op == "or":
        return or_(*args)
    return formula if args == formula.args else _intern(formula.op, args, formula.name)
