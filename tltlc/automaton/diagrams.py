"""Hash-consed decision diagrams: functions of Boolean variables, from which all automata are built.

A function maps each assignment of the variables to a value. Its diagram is a directed acyclic
graph: an inner node tests a variable, a leaf holds a value. A node is an int. Equal functions are
the same node, so ``==`` compares functions.

The constructions over finite and over infinite traces store these functions as diagrams:

- *obligations* (:class:`~tltlc.automaton.transitions.ObligationDiagrams`): Boolean functions over
  temporal subformulas;
- *transitions* (:class:`~tltlc.automaton.transitions.TransitionDiagrams`) and guards: functions
  from a letter (the atoms that hold at a sample) to what remains to be done and whether the trace
  may end here;
- *steps* of automata over infinite traces: functions from a letter to any hashable value, such as
  the next state and the marks of the edge.

No operation enumerates letters, of which there are 2^n for n atoms. All operations cache their
results.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final, Generic, TypeVar

from tltlc.automaton.work import Work

DiagramLeaf = TypeVar("DiagramLeaf", bound=Hashable)

LEAF: Final = 1 << 40
"""The entry in ``variable`` for a leaf: a number greater than every variable."""

_NO_NODE: Final = -1


class OutOfSteps(Exception):
    """Raised when an operation takes more steps than its limit, because the diagrams of a formula become too large."""


class StepLimit:
    """The most steps that each operation may take, over all its calls.

    Several tables of diagrams may share a limit. An operation takes a step for each pair of nodes
    that it combines, and caches the result, so the limit bounds memory too.
    """

    __slots__ = ("_memos", "steps")

    def __init__(self, steps: int = 2_000_000) -> None:
        self.steps = steps
        self._memos: list[dict[tuple[int, int], int]] = []

    def memo(self) -> dict[tuple[int, int], int]:
        """Return an empty cache for a new operation.

        The number of its entries is the number of steps taken.
        """
        self._memos.append({})
        return self._memos[-1]

    @contextmanager
    def at_most(self, steps: int) -> Iterator[None]:
        """Inside the ``with`` block, lower the limit to ``steps`` more than the busiest operation has taken so far.

        A limit that is lower already does not change.
        """
        before = self.steps
        self.steps = min(before, max(map(len, self._memos)) + steps)
        try:
            yield
        finally:
            self.steps = before


class Diagrams(Generic[DiagramLeaf]):
    """A table of decision diagrams, which are functions of Boolean variables, and the operations on them.

    A function is a node, and a node is an int. Equal functions are the same node. Inner node ``n``
    tests the variable ``variable[n]``: it is the function ``high[n]`` where the variable is
    true, and ``low[n]`` where it is false. Variables are ints and are tested in ascending order.
    Leaf ``n`` has the value ``value[n]``, and its ``variable`` is :data:`LEAF`.

    If a budget ``work`` is given, each new inner node costs one step, and so does each new pair of
    nodes that :meth:`apply` visits, unless both are leaves. If no step is left, the methods raise
    :class:`~tltlc.automaton.work.OutOfWork`.
    """

    __slots__ = ("_leaves", "_nodes", "_work", "high", "low", "node", "value", "variable")

    def __init__(self, work: Work | None = None) -> None:
        self.variable: list[int] = []
        self.low: list[int] = []
        self.high: list[int] = []
        self.value: list[Any] = []
        self._nodes: dict[tuple[int, int, int], int] = {}
        self._leaves: dict[DiagramLeaf, int] = {}
        self._work = work
        self.node: Callable[[int, int, int], int] = self._node_maker()

    @property
    def work(self) -> Work:
        """The work budget of the table; raises ValueError if the table has none."""
        if self._work is None:
            raise ValueError("this table of diagrams counts no work")
        return self._work

    # --- making nodes -------------------------------------------------------------------------

    def leaf(self, value: DiagramLeaf) -> int:
        """Return the leaf with this value: the function that has this value everywhere."""
        number = self._leaves.get(value)
        if number is None:
            number = self._leaves[value] = self._add(LEAF, _NO_NODE, _NO_NODE, value)
        return number

    def _add_inner(self, key: tuple[int, int, int]) -> int:
        """Add an inner node that is not in the table yet, and return its number.

        ``key`` is the variable that the node tests, its low node and its high node.
        """
        if self._work is not None:
            self._work.spend()
        number = self._nodes[key] = self._add(*key, None)
        return number

    def _add(self, variable: int, low: int, high: int, value: DiagramLeaf | None) -> int:
        self.variable.append(variable)
        self.low.append(low)
        self.high.append(high)
        self.value.append(value)
        return len(self.variable) - 1

    # --- operations ---------------------------------------------------------------------------
    # Most operations are closures over the tables: attribute look-ups would cost a third of the run time.

    def _node_maker(self) -> Callable[[int, int, int], int]:
        nodes, inner = self._nodes, self._add_inner

        def node(variable: int, low: int, high: int) -> int:
            """Return the function that is ``high`` where ``variable`` is true, and ``low`` elsewhere."""
            if low == high:
                return low
            key = (variable, low, high)
            number = nodes.get(key)
            return inner(key) if number is None else number

        return node

    def lattice_operation(
        self,
        combine: Callable[[Any, Any], DiagramLeaf],
        limit: StepLimit,
        *,
        absorbing: int,
        neutral: int,
        undefined: int = _NO_NODE,
    ) -> Callable[[int, int], int]:
        """Return an operation that combines two functions by applying ``combine`` to their values.

        ``combine`` must be commutative, associative and idempotent. ``absorbing`` and ``neutral``
        are the leaves of its absorbing and its neutral value: for ``and``, the leaves of False and
        True. The leaf ``undefined``, combined with any function except ``absorbing``, gives
        ``undefined``. The operation raises :class:`OutOfSteps` after ``limit.steps`` steps in
        total.
        """
        variable, low, high, value = self.variable, self.low, self.high, self.value
        nodes, inner, leaf = self._nodes, self._add_inner, self.leaf
        memo = limit.memo()

        def operate(x: int, y: int) -> int:
            if x == y or y == neutral:
                return x
            if x == neutral:
                return y
            if x == absorbing or y == absorbing:
                return absorbing
            key = (x, y) if x < y else (y, x)
            result = memo.get(key)
            if result is not None:
                return result
            if x == undefined or y == undefined:
                return undefined
            if len(memo) >= limit.steps:
                raise OutOfSteps
            vx, vy = variable[x], variable[y]
            if vx == vy:
                if vx == LEAF:
                    memo[key] = result = leaf(combine(value[x], value[y]))
                    return result
                below, above = operate(low[x], low[y]), operate(high[x], high[y])
            elif vx < vy:
                below, above = operate(low[x], y), operate(high[x], y)
            else:
                vx = vy
                below, above = operate(x, low[y]), operate(x, high[y])
            if below == above:
                result = below
            else:
                triple = (vx, below, above)
                result = nodes.get(triple)
                if result is None:
                    result = inner(triple)
            memo[key] = result
            return result

        return operate

    def apply(
        self, combine: Callable[[Any, Any], DiagramLeaf], x: int, y: int, memo: dict[tuple[int, int], int]
    ) -> int:
        """Return the function that applies ``combine`` to the values of the functions ``x`` and ``y``.

        ``combine`` may be any function of two values. ``memo`` caches results; pass the same dict
        only to calls with the same ``combine``. Raises :class:`~tltlc.automaton.work.OutOfWork` if
        the work budget of the table is used up.
        """
        result = memo.get((x, y))
        if result is not None:
            return result
        vx, vy = self.variable[x], self.variable[y]
        if vx == vy == LEAF:
            result = self.leaf(combine(self.value[x], self.value[y]))
        else:
            if self._work is not None:
                self._work.spend()
            first = min(vx, vy)
            low_x, high_x = (self.low[x], self.high[x]) if vx == first else (x, x)
            low_y, high_y = (self.low[y], self.high[y]) if vy == first else (y, y)
            low, high = self.apply(combine, low_x, low_y, memo), self.apply(combine, high_x, high_y, memo)
            result = self.node(first, low, high)
        memo[x, y] = result
        return result

    def map_leaves(self, change: Callable[[Any], DiagramLeaf], x: int, memo: dict[int, int]) -> int:
        """Return the function ``x`` with ``change`` applied to each of its values.

        ``memo`` maps nodes to their results; pass the same dict only to calls with the same
        ``change``. To give a leaf another result, put it into ``memo`` before the first call.
        """
        variable, low, high, value, node, leaf = self.variable, self.low, self.high, self.value, self.node, self.leaf

        def rebuild(n: int) -> int:
            result = memo.get(n)
            if result is None:
                tested = variable[n]
                result = leaf(change(value[n])) if tested == LEAF else node(tested, rebuild(low[n]), rebuild(high[n]))
                memo[n] = result
            return result

        return rebuild(x)

    # --- reading ------------------------------------------------------------------------------

    def leaves(self, *functions: int) -> list[int]:
        """Return the distinct leaves of the functions; equal functions give the same order."""
        variable, low, high = self.variable, self.low, self.high
        leaves: list[int] = []
        stack = list(dict.fromkeys(reversed(functions)))
        seen = set(stack)
        while stack:
            n = stack.pop()
            if variable[n] == LEAF:
                leaves.append(n)
                continue
            for child in (high[n], low[n]):
                if child not in seen:
                    seen.add(child)
                    stack.append(child)
        return leaves

    def values(self, x: int) -> list[Any]:
        """Return the distinct values of function ``x``, in the order of :meth:`leaves`."""
        return [self.value[leaf] for leaf in self.leaves(x)]

    def assignment_with(self, x: int, value: DiagramLeaf) -> frozenset[int]:
        """Return the true variables of an assignment on which function ``x`` has the given value.

        Raises ValueError if the function has this value on no assignment.
        """
        stack: list[tuple[int, tuple[int, ...]]] = [(x, ())]
        seen = {x}
        while stack:
            n, holding = stack.pop()
            if self.variable[n] == LEAF:
                if self.value[n] == value:
                    return frozenset(holding)
                continue
            for child, extended in ((self.high[n], (*holding, self.variable[n])), (self.low[n], holding)):
                if child not in seen:
                    seen.add(child)
                    stack.append((child, extended))
        raise ValueError(f"no assignment has the value {value!r}")

    def at(self, x: int, holds: Callable[[int], bool]) -> Any:
        """Return the value of function ``x`` on the assignment in which variable ``v`` is ``holds(v)``."""
        while self.variable[x] != LEAF:
            x = self.high[x] if holds(self.variable[x]) else self.low[x]
        return self.value[x]


def at_most_one(
    diagrams: Diagrams[Any],
    groups: Iterable[Sequence[int]],
    yes: Hashable,
    no: Hashable,
    conjoin: Callable[[int, int], int] | None = None,
) -> int:
    """Return the function that is ``yes`` where at most one variable of each group is true, ``no`` elsewhere.

    ``conjoin`` must return the conjunction of two functions whose values are ``yes`` and ``no``.
    Pass an existing operation of ``diagrams`` to reuse its cache; by default, this function makes
    an operation of its own.
    """

    def conjunction(x: int, y: int) -> int:
        return diagrams.apply(lambda left, right: right if left == yes else no, x, y, {})

    always, never = diagrams.leaf(yes), diagrams.leaf(no)
    join, allowed = conjoin or conjunction, always
    for group in groups:
        if_none, if_one = always, always
        for variable in sorted(set(group), reverse=True):
            if_none = diagrams.node(variable, if_none, if_one)
            if_one = diagrams.node(variable, if_one, never)
        allowed = join(allowed, if_none)
    return allowed
