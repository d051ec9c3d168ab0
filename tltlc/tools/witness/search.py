"""Search for points at which atoms have given truth values.

A point has a value for each signal. The search tries simple points, then points between the
borders of atoms, and then hill climbing. The border of an atom is where its truth value changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from math import ceil, copysign, floor, inf, isfinite, sqrt
from sys import float_info

from tltlc.automaton.fspa import Fspa, Implicant
from tltlc.expression.python import compile_expressions
from tltlc.expression.tree import Const, Expression, Op, nodes
from tltlc.expression.tree import SignalValue as Variable
from tltlc.resolve.range_proof.interval import Interval, midpoint
from tltlc.resolve.range_proof.region import Box
from tltlc.resolve.range_proof.region import Variable as AnyVariable
from tltlc.resolve.range_proof.witness import points
from tltlc.resolve.spec import Signal

SignalPoint = Mapping[str, float]

Candidate = tuple[SignalPoint, tuple[float, ...]]
"""A point, and the values of the atoms at this point."""

_CLEAR = 0.05
"""The search stops at the first point at which every literal is true by at least this much."""
_STARTS = 3
_ROUNDS = 100
_HALVINGS = 60
_FAR = tuple(
    sign * size for size in (1e9, 1e12, 1e20, 1e50, 1e100, 1e200, 1e300, 1e308, float_info.max) for sign in (1.0, -1.0)
)
"""The last values to try for a signal without a finite range."""
_LARGE = 1e6
"""For numbers above this, bisection uses geometric means: arithmetic ones would take too long."""
_UNDEFINED = (ZeroDivisionError, OverflowError, ValueError)


class AtomGroup:
    """Atoms that share signals, directly or through other atoms, so that they must be searched together.

    ``atoms`` has their indices in the automaton. Literals have the same indices.
    """

    def __init__(self, fspa: Fspa, atoms: Sequence[int], signals: Sequence[Signal]) -> None:
        self.atoms = tuple(atoms)
        self._place = {atom: place for place, atom in enumerate(self.atoms)}
        self._names = tuple(signal.name for signal in signals)
        self._ranges: dict[str, Interval] = {signal.name: _range(signal) for signal in signals}
        self._bools = frozenset(signal.name for signal in signals if signal.type == "bool")
        self._ints = frozenset(signal.name for signal in signals if signal.type == "int")
        self._params = {param.name: param.value for param in fspa.params}
        self._expressions = [fspa.atoms[atom].expression for atom in self.atoms]
        self._functions = compile_expressions(self._expressions, self._names, self._params)
        self._goals: dict[tuple[int, bool], list[tuple[Callable[[Sequence[float]], float], bool]]] = {}
        self._exclusive = [[self._place[atom] for atom in group if atom in self._place] for group in fspa.exclusive]
        self._cache: dict[Implicant, SignalPoint | None] = {}

    def find(self, literals: Implicant) -> SignalPoint | None:
        """Return a point at which the literals are true, or None if none is found.

        No two exclusive atoms of the group hold at the point.
        """
        if literals not in self._cache:
            self._cache[literals] = self._find(literals)
        return self._cache[literals]

    def _find(self, literals: Implicant) -> SignalPoint | None:
        """Return a point at which the literals are true, or None if none is found.

        Try the points in ``_candidates`` first, then hill climbing from the best of them, and then
        the points in ``_far_candidates``.
        """
        inside = self._best(self._candidates, literals)
        if inside is not None:
            return inside
        outside = [(self._margin(values, literals), point) for point, values in self._candidates]
        starts = sorted(outside, key=lambda candidate: -candidate[0])[:_STARTS]
        summit = next((end for _, start in starts if (end := self._climb(start, literals))), None)
        return summit or self._best(self._far_candidates, literals)

    def _best(self, candidates: Sequence[Candidate], literals: Implicant) -> SignalPoint | None:
        """Return the first candidate at which the literals are true with a margin of at least ``_CLEAR``.

        If there is none, return the candidate with the largest margin at which the literals are
        true, or None. :meth:`_margin` defines the margin.
        """
        inside: list[tuple[float, SignalPoint]] = []
        for point, values in candidates:
            if self._are_true(values, literals):
                margin = self._margin(values, literals)
                if margin >= _CLEAR:
                    return point
                inside.append((margin, point))
        return max(inside, key=lambda candidate: candidate[0])[1] if inside else None

    # --- truth ------------------------------------------------------------------------------------

    def _values(self, point: SignalPoint) -> tuple[float, ...] | None:
        """Return the values of the atoms at a point, or None if one of them has no value there."""
        inputs = [point[name] for name in self._names]
        try:
            values = tuple([function(inputs) for function in self._functions])
        except _UNDEFINED:
            return None
        return values if all(map(isfinite, values)) else None

    def _are_true(self, values: Sequence[float], literals: Implicant) -> bool:
        return all((values[self._place[atom]] > 0.0) == holds for atom, holds in literals) and not any(
            sum(values[place] > 0.0 for place in places) > 1 for places in self._exclusive
        )

    def _margin(self, values: Sequence[float], literals: Implicant) -> float:
        """Return by how much the literals are true: the least distance of an atom's value from 0.

        The result is negative if a literal is false, and 1 if there are no literals.
        """
        sides = (values[self._place[atom]] if holds else -values[self._place[atom]] for atom, holds in literals)
        return min(sides, default=1.0)

    # --- points -----------------------------------------------------------------------------------

    @cached_property
    def _candidates(self) -> list[Candidate]:
        return [(point, values) for point in self._points() if (values := self._values(point))]

    @cached_property
    def _far_candidates(self) -> list[Candidate]:
        return [(point, values) for point in self._far_points() if (values := self._values(point))]

    @cached_property
    def _simple(self) -> list[SignalPoint]:
        """The points to try first, whatever the literals are."""
        whole = Op("min", (*self._expressions, *map(Const, self._params.values())))
        box: Box = {Variable(name): self._ranges[name] for name in self._names}
        bools: frozenset[AnyVariable] = frozenset(Variable(name) for name in self._bools)
        simple = ({variable.name: value for variable, value in point.items()} for point in points(whole, box, bools))
        return [self._with_whole_numbers(point) for point in simple]

    def _with_whole_numbers(self, point: SignalPoint) -> SignalPoint:
        """Return a point with the values of its ints rounded; the ends of their ranges are whole numbers."""
        if not self._ints:
            return point
        return {name: float(round(value)) if name in self._ints else value for name, value in point.items()}

    def _points(self) -> Iterator[SignalPoint]:
        """Yield the points of :attr:`_simple`, then points at and between the borders of atoms."""
        yield from self._simple
        for name in self._names:
            if name not in self._bools and self._simple:
                ladder = sorted({point[name] for point in self._simple})
                yield from self._between_borders(self._simple[0], name, ladder)

    def _far_points(self) -> Iterator[SignalPoint]:
        """Yield points at which one signal without a finite range has a very large value."""
        for name in self._names:
            low, high = self._ranges[name]
            far = [value for value in _FAR if low <= value <= high]
            if isfinite(high - low) or not self._simple:
                continue
            yield from ({**self._simple[0], name: value} for value in far)
            ladder = sorted({*far, *(point[name] for point in self._simple)})
            yield from self._between_borders(self._simple[0], name, ladder)

    def _between_borders(self, start: SignalPoint, name: str, ladder: Sequence[float]) -> Iterator[SignalPoint]:
        """Vary the signal ``name``; yield points on both sides of each border of an atom.

        The other signals have their values in ``start``. After these points, yield a point in the
        middle between each two neighbouring borders. Borders are searched between neighbouring
        values of ``ladder``, which is sorted.
        """
        borders: list[float] = []
        for index in range(len(self._functions)):
            signs = [self._sign({**start, name: value}, index) for value in ladder]
            for low, high, below, above in zip(ladder, ladder[1:], signs, signs[1:], strict=False):
                if None not in (below, above) and below != above:
                    borders += self._border({**start}, name, index, low, high)
        borders = sorted(set(borders))
        values = [*borders, *(midpoint(low, high) for low, high in pairwise(borders))]
        if name in self._ints:
            values = [float(whole) for value in values for whole in dict.fromkeys((floor(value), ceil(value)))]
        for value in values:
            yield {**start, name: value}

    def _border(self, start: dict[str, float], name: str, index: int, low: float, high: float) -> tuple[float, float]:
        """Return two almost equal values of a signal between which the truth of an atom changes.

        The search is a bisection between ``low`` and ``high``, at which the truth values differ.
        ``index`` is the place of the atom in the group.
        """
        below = self._sign({**start, name: low}, index)
        for _ in range(_HALVINGS):
            middle = _middle(low, high)
            if self._sign({**start, name: middle}, index) == below:
                low = middle
            else:
                high = middle
        return low, high

    def _sign(self, point: SignalPoint, index: int) -> bool | None:
        try:
            value = self._functions[index]([point[name] for name in self._names])
        except _UNDEFINED:
            return None
        return value > 0.0

    def _climb(self, start: SignalPoint, literals: Implicant) -> SignalPoint | None:
        """Search from ``start`` for a point at which the literals are true; return None if none is found.

        The climb changes one signal at a time. If a change helps, the next change of this signal is
        twice as large, else half as large.
        """
        goals = [goal for literal in literals for goal in self._sign_functions(literal)]
        best, deficit = dict(start), self._deficit(start, goals)
        sides = {name: side for name, side in self._ranges.items() if name not in self._bools}
        steps = {name: (high - low) / 8 if isfinite(high - low) else 1.0 for name, (low, high) in sides.items()}
        for _ in range(_ROUNDS):
            for name, step in steps.items():
                low, high = sides[name]
                steps[name] = step / 2
                step = float(max(1, round(step))) if name in self._ints else step
                for value in (min(best[name] + step, high), max(best[name] - step, low)):
                    point = {**best, name: value}
                    values, point_deficit = self._values(point), self._deficit(point, goals)
                    if values is not None and self._are_true(values, literals):
                        return point
                    if point_deficit < deficit:
                        best, deficit, steps[name] = point, point_deficit, step * 2
        return None

    def _deficit(self, point: SignalPoint, goals: Sequence[tuple[Callable[[Sequence[float]], float], bool]]) -> float:
        """Return by how much, in total, the functions in ``goals`` miss their required signs at a point.

        Each goal is a function, and whether its value must be positive. The result is 0 or more;
        infinity if a function has no value at the point.
        """
        inputs = [point[name] for name in self._names]
        try:
            # Aim beyond the border: at the border the value is 0 and the atom does not hold.
            return sum(max(0.0, _CLEAR + (-goal(inputs) if holds else goal(inputs))) for goal, holds in goals)
        except _UNDEFINED:
            return inf

    def _sign_functions(self, literal: tuple[int, bool]) -> Sequence[tuple[Callable[[Sequence[float]], float], bool]]:
        """Return functions of the signals that must all have the right sign for a literal to be true.

        Each comes with a bool: whether its value must be positive. Unlike the value of the atom,
        their values are not clamped, so there are no plateaus on which hill climbing gets stuck.
        """
        if literal not in self._goals:
            atom, holds = literal
            parts = list(_sign_parts(self._expressions[self._place[atom]], holds))
            functions = compile_expressions([expression for expression, _ in parts], self._names, self._params)
            self._goals[literal] = [(function, part[1]) for function, part in zip(functions, parts, strict=True)]
        return self._goals[literal]


def _middle(low: float, high: float) -> float:
    """Return the middle of two numbers; for large numbers of different size, their geometric mean."""
    least, most = sorted((abs(low), abs(high)))
    if (low > 0) != (high > 0) or least < _LARGE or most / least < 4:
        return midpoint(low, high)
    return copysign(sqrt(least) * sqrt(most), low)


def _sign_parts(expression: Expression, holds: bool) -> Iterator[tuple[Expression, bool]]:
    """Yield the subexpressions that decide the sign of an expression.

    ``holds`` says whether the value of the whole expression must be positive. Each subexpression
    comes with a bool that says the same about its own value. For ``min(x, -y)`` and True, these are
    ``x`` and True, and ``y`` and False.
    """
    stack = [(expression, holds)]
    while stack:
        node, holds = stack.pop()
        if isinstance(node, Op) and (node.op == "clamp" or (node.op == "/" and _is_positive(node.args[1]))):
            stack.append((node.args[0], holds))
        elif isinstance(node, Op) and node.op == ("min" if holds else "max"):
            stack += [(part, holds) for part in node.args]
        elif isinstance(node, Op) and node.op == "max" and len(node.args) == 2 and _is_negative(node.args[1]):
            # A least value below 0, as in the atom of an enum, makes a plateau, and never decides the sign.
            stack.append((node.args[0], holds))
        elif isinstance(node, Op) and node.op == "neg":
            stack.append((node.args[0], not holds))
        else:
            yield node, holds


def _is_positive(node: Expression) -> bool:
    return isinstance(node, Const) and node.value > 0


def _is_negative(node: Expression) -> bool:
    return isinstance(node, Const) and node.value < 0


def atom_groups(fspa: Fspa) -> tuple[AtomGroup, ...]:
    """Divide the atoms of an automaton into groups, so that no two groups share a signal.

    The groups are in the order of their first atoms.
    """
    signal_names = [_signals(atom.expression) for atom in fspa.atoms]
    merged: list[tuple[list[int], set[str]]] = []
    for index, names in enumerate(signal_names):
        joined: tuple[list[int], set[str]] = ([index], set(names))
        disjoint = []
        for group in merged:
            if group[1] & joined[1]:
                joined = ([*group[0], *joined[0]], group[1] | joined[1])
            else:
                disjoint.append(group)
        merged = [*disjoint, joined]
    merged.sort(key=lambda group: min(group[0]))
    signals = fspa.signals
    return tuple(
        AtomGroup(fspa, sorted(atoms), [signal for signal in signals if signal.name in names])
        for atoms, names in merged
    )


def _signals(expression: Expression) -> frozenset[str]:
    return frozenset(node.name for node in nodes(expression) if isinstance(node, Variable))


def _range(signal: Signal) -> Interval:
    if signal.type == "bool":
        return 0.0, 1.0
    return -inf if signal.low is None else signal.low, inf if signal.high is None else signal.high
