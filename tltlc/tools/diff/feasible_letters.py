"""Find traces that a game can produce, over the atoms of two specs.

Atoms over the same signals may imply each other, as ``fuel > 30`` implies ``fuel > 20``. So there
are traces for which no samples exist.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from tltlc.automaton.compare import NamedLiterals, Trace, separating
from tltlc.core.record import replace
from tltlc.expression.tree import Const, ParamValue
from tltlc.tools.diff.expression_shapes import ExpressionLeaf, replace_leaves
from tltlc.tools.witness.samples import SampleFinder

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Atom, Signal

_MOST: Final = 30
"""The most impossible traces that one comparison replaces."""


class FeasibleLetters:
    """Checks whether a game can produce a trace: whether signals can have values that give each of its letters.

    The letters are over the atoms of both automata. ``impossible`` collects the conjunctions of
    literals for which the search found no sample. ``never`` has conjunctions that are already known
    to be impossible; they are not added to ``impossible``.
    """

    def __init__(self, a: Fspa, b: Fspa, never: tuple[NamedLiterals, ...]) -> None:
        self._never = never
        self.impossible: dict[NamedLiterals, None] = {}
        self._searches_left = _MOST
        self._joint = joint_automaton(a, b)
        self._finder = None if self._joint is None else SampleFinder(self._joint)

    def feasible_trace(self, trace: Trace | None, accepting: Fspa, rejecting: Fspa, work: int) -> Trace | None:
        """Return a trace that only ``accepting`` accepts, and for which samples are found.

        ``trace`` is a trace that only ``accepting`` accepts, or None; if samples are found for it,
        the result is ``trace`` itself. Return None if no such trace is left. After ``_MOST``
        impossible traces, the search gives up: then no samples may exist for the result.

        Raises:
            OutOfWork: a search takes more than ``work`` steps.
        """
        while trace is not None and self._searches_left and (obstacles := self._obstacles(trace)):
            self._searches_left -= 1
            self.impossible |= dict.fromkeys(obstacles)
            trace = separating(accepting, rejecting, work, (*self._never, *self.impossible))
        return trace

    def _obstacles(self, trace: Trace) -> list[NamedLiterals]:
        """Return the conjunctions of literals that occur in a trace, but for which no sample is found."""
        if self._joint is None or self._finder is None:
            return []
        obstacles = []
        for letter in dict.fromkeys((*trace.prefix, *trace.cycle)):
            for obstacle in self._finder.obstacles(letter):
                literals = [(self._joint.atoms[atom].name, holds) for atom, holds in obstacle.literals]
                obstacles.append(tuple(sorted(literals, key=lambda literal: not literal[1])))
        return obstacles


def joint_automaton(a: Fspa, b: Fspa) -> Fspa | None:
    """Return an automaton that has the atoms of both automata, with params replaced by their values.

    Only its atoms, signals and exclusive groups are meaningful. The range of a signal that both read
    is the intersection of its two ranges. Return None if this intersection is empty, or if the
    signal is a bool in only one automaton.
    """
    signals = {signal.name: signal for signal in a.signals}
    for signal in b.signals:
        common = _common_signal(signals.get(signal.name, signal), signal)
        if common is None:
            return None
        signals[signal.name] = common
    atoms: dict[str, Atom] = {}
    for atom in (*_atoms_without_params(a), *_atoms_without_params(b)):
        atoms.setdefault(atom.name, atom)
    names = tuple(atoms)
    groups = [[fspa.atoms[atom].name for atom in group] for fspa in (a, b) for group in fspa.exclusive]
    return replace(
        a,
        atoms=tuple(atoms.values()),
        signals=tuple(signals.values()),
        params=(),
        exclusive=tuple(tuple(names.index(name) for name in group) for group in groups),
    )


def _common_signal(one: Signal, other: Signal) -> Signal | None:
    """Return a signal whose range is the intersection of both ranges.

    Returns None if the intersection is empty, or if only one of the signals is a bool.
    """
    lows = [low for low in (one.low, other.low) if low is not None]
    highs = [high for high in (one.high, other.high) if high is not None]
    # A value is whole only if both sides say so.
    base = other if one.type == "int" else one
    common = replace(base, low=max(lows, default=None), high=min(highs, default=None))
    if (one.type == "bool") != (other.type == "bool"):
        return None
    return None if common.low is not None and common.high is not None and common.low > common.high else common


def _atoms_without_params(fspa: Fspa) -> list[Atom]:
    """Return the atoms of an automaton, with params replaced by their values."""
    values = {param.name: param.value for param in fspa.params}

    def bind(leaf: ExpressionLeaf) -> ExpressionLeaf:
        return Const(values[leaf.name]) if isinstance(leaf, ParamValue) else leaf

    return [replace(atom, expression=replace_leaves(atom.expression, bind)) for atom in fspa.atoms]
