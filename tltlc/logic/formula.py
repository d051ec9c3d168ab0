"""Immutable, hash-consed formulas of truncated linear temporal logic.

Equal formulas are one object, so you can compare them with ``is`` and use them as keys. The
constructors below keep formulas as written: they do not simplify (see :mod:`tltlc.logic.rewrite`),
and ``&`` and ``|`` keep the order of their operands.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator
from typing import Final, Literal
from weakref import WeakValueDictionary

from tltlc.core.names import ComparisonName, SpokenName

FormulaOp = Literal[
    "true", "false", "atom", "not", "and", "or", "implies", "iff", "X", "N", "F", "G", "U", "W", "R", "M", "F[]", "G[]"
]
"""The operators. Those with a bound, ``F[]`` and ``G[]``, stand only in formulas that are still being resolved."""

UNARY_TEMPORAL: Final = ("X", "N", "F", "G", "F[]", "G[]")
BINARY_TEMPORAL: Final = ("U", "W", "R", "M")


class BoundName(str):
    """The name of a bounded operator: its bound, from ``low`` to ``high`` steps."""

    __slots__ = ("high", "low")
    low: int
    high: int

    def __new__(cls, low: int, high: int) -> BoundName:
        """Make the name of the bound [low, high]."""
        name = super().__new__(cls, f"[{low},{high}]")
        name.low, name.high = low, high
        return name

    def __getnewargs__(self) -> tuple[int, int]:  # type: ignore[override]
        return self.low, self.high


class TimeBound(str):
    """The name of an operator that is bounded by a time: it ends ``seconds`` after its first sample.

    ``F`` includes the end, and ``G`` does not. If ``later``, the first sample itself is left out.
    """

    __slots__ = ("later", "seconds")
    later: bool
    seconds: float

    def __new__(cls, seconds: float, later: bool = False) -> TimeBound:
        """Make the name of the bound of this many seconds."""
        name = super().__new__(cls, f"[{seconds!r} s{', later' * later}]")
        name.seconds, name.later = seconds, later
        return name

    def __getnewargs__(self) -> tuple[float, bool]:  # type: ignore[override]
        return self.seconds, self.later


class Formula:
    """A formula: its outermost operator ``op``, its operands ``args``, and the ``name`` of an atom.

    Use the functions of this module to make formulas. The name of a bounded operator is its bound. All
    other formulas but atoms have an empty name.
    An ``and`` has two or more operands, none of which is an ``and`` again; the same is true of
    ``or``.
    """

    __slots__ = ("__weakref__", "args", "name", "op")
    op: FormulaOp
    args: tuple[Formula, ...]
    name: str

    def __repr__(self) -> str:
        from tltlc.logic.text.printer import ascii_text

        return f"<Formula {ascii_text(self)}>"

    def __str__(self) -> str:
        from tltlc.logic.text.printer import ascii_text

        return ascii_text(self)

    @property
    def ascii(self) -> str:
        """The formula in letters and ASCII symbols, as :func:`~tltlc.logic.text.printer.ascii_text` prints it."""
        return str(self)

    @property
    def unicode(self) -> str:
        """The formula in symbols, as :func:`~tltlc.logic.text.printer.unicode_text` prints it."""
        from tltlc.logic.text.printer import unicode_text

        return unicode_text(self)

    @property
    def english(self) -> str:
        """The formula as a sentence about finite traces, as :func:`~tltlc.logic.text.printer.english_text` gives it.

        For the formula and the labels of an automaton, use ``tltlc.api.formula_text`` and
        ``tltlc.api.label_text``. They also know the sentences for infinite traces, and for states
        in which the trace must end or go on.
        """
        from tltlc.logic.text.printer import english_text

        return english_text(self)

    def __reduce__(self) -> tuple[object, ...]:
        # Pickle a flat list: pickling nested operands recurses, and bounds nest deep.
        return _unpickle, (flatten([self])[0],)

    def walk(self) -> Iterator[Formula]:
        """Yield every distinct subformula, without recursion: the formula itself first, operands from left to right."""
        seen: set[Formula] = set()
        stack = [self]
        while stack:
            node = stack.pop()
            if node not in seen:
                seen.add(node)
                yield node
                stack.extend(reversed(node.args))

    def bottom_up(self, known: Container[Formula] = ()) -> Iterator[Formula]:
        """Yield every distinct subformula after its operands, the formula itself last, without recursion.

        Does not look into the subformulas in ``known``: these and their operands are skipped,
        unless an operand also occurs elsewhere.
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
        """Return the names of the atoms in order of appearance."""
        return tuple(node.name for node in self.walk() if node.op == "atom")

    @property
    def is_temporal(self) -> bool:
        """Whether the outermost operator is temporal."""
        return self.op in UNARY_TEMPORAL or self.op in BINARY_TEMPORAL


_table: WeakValueDictionary[tuple[object, ...], Formula] = WeakValueDictionary()


def _intern(op: FormulaOp, args: tuple[Formula, ...] = (), name: str = "") -> Formula:
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
    """Return the atom called ``name``.

    If this is a :class:`~tltlc.core.names.ComparisonName`, the negation of the atom is printed as a
    comparison; a :class:`~tltlc.core.names.SpokenName` may have its own verb.
    """
    node = _intern("atom", (), name)
    if isinstance(name, (ComparisonName, SpokenName)):
        node.name = name  # The atom may exist already, under a plain text.
    return node


def not_(operand: Formula) -> Formula:
    """Return ``not operand``, the negation."""
    return _intern("not", (operand,))


def and_(*operands: Formula) -> Formula:
    """Return the conjunction in the given order, flattened; ``true`` without operands."""
    return _nary("and", operands, TRUE)


def or_(*operands: Formula) -> Formula:
    """Return the disjunction in the given order, flattened; ``false`` without operands."""
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
    """Return ``left -> right``."""
    return _intern("implies", (left, right))


def iff(left: Formula, right: Formula) -> Formula:
    """Return ``left <-> right``."""
    return _intern("iff", (left, right))


def next_(operand: Formula) -> Formula:
    """Return the strong next ``X``: there is a next sample, and the operand holds there."""
    return _intern("X", (operand,))


def weak_next(operand: Formula) -> Formula:
    """Return the weak next ``N``: if there is a next sample, the operand holds there."""
    return _intern("N", (operand,))


def eventually(operand: Formula) -> Formula:
    """Return ``F operand``: the operand holds now or at some later sample of the trace."""
    return _intern("F", (operand,))


def always(operand: Formula) -> Formula:
    """Return ``G operand``: the operand holds now and at every later sample of the trace."""
    return _intern("G", (operand,))


def bounded(op: Literal["F[]", "G[]"], low: int, high: int, operand: Formula) -> Formula:
    """Return ``F[low,high] operand`` or ``G[low,high] operand``, as one node.

    Automata are built from formulas without such nodes: :func:`tltlc.resolve.unfolding.unfold`.
    """
    return _intern(op, (operand,), BoundName(low, high))


def timed(op: Literal["F[]", "G[]"], seconds: float, operand: Formula, *, later: bool = False) -> Formula:
    """Return a node like that of :func:`bounded` with a bound in seconds, for a clock that varies.

    Timers replace all of these nodes, since a time is no number of samples (:class:`TimeBound`).
    """
    return _intern(op, (operand,), TimeBound(seconds, later))


def bound_of(node: Formula) -> BoundName | None:
    """Return the bound of an operator that is bounded by a number of steps, None for any other formula."""
    return node.name if isinstance(node.name, BoundName) else None


def time_bound_of(node: Formula) -> TimeBound | None:
    """Return the bound of an operator that is bounded by a time, None for any other formula."""
    return node.name if isinstance(node.name, TimeBound) else None


def until(left: Formula, right: Formula) -> Formula:
    """Return ``left U right``: ``right`` holds now or at a later sample, and ``left`` at all samples before that."""
    return _intern("U", (left, right))


def weak_until(left: Formula, right: Formula) -> Formula:
    """Return ``left W right``: ``left U right`` holds, or ``left`` holds now and at every later sample."""
    return _intern("W", (left, right))


def release(left: Formula, right: Formula) -> Formula:
    """Return ``left R right``: ``right`` holds up to and including the first sample with ``left``.

    If there is no such sample, ``right`` holds at every sample from now on.
    """
    return _intern("R", (left, right))


def strong_release(left: Formula, right: Formula) -> Formula:
    """Return ``left M right``: ``right`` holds up to and including the first sample with ``left``.

    A sample with ``left`` must exist.
    """
    return _intern("M", (left, right))


def then(left: Formula, right: Formula) -> Formula:
    """Return ``left then right`` = ``F(left & X F right)`` (``docs/semantics.md``, "Traces").

    If ``right`` already begins with ``F``, as another ``then`` does, no second ``F`` is added.
    """
    rest = right if right.op == "F" else eventually(right)
    return eventually(and_(left, next_(rest)))


FlatNodes = list[tuple[FormulaOp, tuple[int, ...], str]]
"""Formulas as plain data: a tuple for each subformula, operands before the formulas that use them.

A tuple contains the operator, the indices of the operands in this list, and the name of an atom.
"""


def flatten(formulas: Iterable[Formula]) -> tuple[FlatNodes, list[int]]:
    """Return the distinct subformulas of some formulas as plain data, and the index of each formula in this list."""
    nodes: FlatNodes = []
    index: dict[Formula, int] = {}
    places = []
    for formula in formulas:
        for node in formula.bottom_up(known=index):
            index[node] = len(nodes)
            nodes.append((node.op, tuple(index[argument] for argument in node.args), node.name))
        places.append(index[formula])
    return nodes, places


def unflatten(nodes: FlatNodes) -> list[Formula]:
    """Return a formula for each entry of a list that :func:`flatten` made, in the same order."""
    formulas: list[Formula] = []
    for op, args, name in nodes:
        formulas.append(atom(name) if op == "atom" else _intern(op, tuple(formulas[argument] for argument in args)))
    return formulas


def _unpickle(nodes: FlatNodes) -> Formula:
    return unflatten(nodes)[-1]


def temporal(op: FormulaOp, operands: tuple[Formula, ...]) -> Formula:
    """Return the formula with the temporal operator ``op`` and these one or two operands."""
    return _intern(op, operands)


def rebuild(formula: Formula, args: tuple[Formula, ...]) -> Formula:
    """Return a formula with the operator of ``formula`` and the operands ``args``.

    Nested operands of ``and`` and ``or`` are flattened.
    """
    if formula.op == "and":
        return and_(*args)
    if formula.op == "or":
        return or_(*args)
    return formula if args == formula.args else _intern(formula.op, args, formula.name)
