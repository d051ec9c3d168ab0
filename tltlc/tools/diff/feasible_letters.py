"""Which traces over the atoms of two specs a game can show: atoms of the same signals may imply each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from tltlc.automaton.compare import Literals, Trace, separating
from tltlc.core.record import replace
from tltlc.expression.tree import Const, Param
from tltlc.tools.diff.expression_shapes import Leaf, with_leaves
from tltlc.tools.witness.samples import Realiser

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Atom, Signal

_MOST: Final = 30
"""Traces that are found to be impossible in one comparison."""


class Reality:
    """Looks for samples of the letters over the atoms of two automata; ``impossible`` is what none was found for.

    ``never`` is what is known to be impossible, and is not said.
    """

    def __init__(self, a: Fspa, b: Fspa, never: tuple[Literals, ...]) -> None:
        self._never = never
        self.impossible: dict[Literals, None] = {}
        self._left = _MOST
        self._both = _both(a, b)
        self._realiser = None if self._both is None else Realiser(self._both)

    def real(self, trace: Trace | None, one: Fspa, other: Fspa, work: int) -> Trace | None:
        """The trace, which ``one`` alone accepts, if samples are found for it, else another such trace, or None."""
        while trace is not None and self._left and (found := self._obstacles(trace)):
            self._left -= 1
            self.impossible |= dict.fromkeys(found)
            trace = separating(one, other, work, (*self._never, *self.impossible))
        return trace

    def _obstacles(self, trace: Trace) -> list[Literals]:
        """Literals of the trace's letters that nothing gives together."""
        if self._both is None or self._realiser is None:
            return []
        found = []
        for letter in dict.fromkeys((*trace.prefix, *trace.cycle)):
            for obstacle in self._realiser.obstacles(letter):
                named = [(self._both.atoms[atom].name, holds) for atom, holds in obstacle.literals]
                found.append(tuple(sorted(named, key=lambda literal: not literal[1])))
        return found


def _both(a: Fspa, b: Fspa) -> Fspa | None:
    """An automaton that has the atoms of both, with their params at their values, and nothing else of use.

    None where a signal is another thing in B than in A.
    """
    signals = {signal.name: signal for signal in a.signals}
    for signal in b.signals:
        found = _common(signals.get(signal.name, signal), signal)
        if found is None:
            return None
        signals[signal.name] = found
    atoms: dict[str, Atom] = {}
    for atom in (*_atoms(a), *_atoms(b)):
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


def _common(one: Signal, other: Signal) -> Signal | None:
    """The signal in the range of both; None where that is empty, or one of them alone is a bool."""
    lows = [low for low in (one.low, other.low) if low is not None]
    highs = [high for high in (one.high, other.high) if high is not None]
    found = replace(one, low=max(lows, default=None), high=min(highs, default=None))
    if (one.type == "bool") != (other.type == "bool"):
        return None
    return None if found.low is not None and found.high is not None and found.low > found.high else found


def _atoms(fspa: Fspa) -> list[Atom]:
    """The atoms with the values of params in their places."""
    values = {param.name: param.value for param in fspa.params}

    def bound(leaf: Leaf) -> Leaf:
        return Const(values[leaf.name]) if isinstance(leaf, Param) else leaf

    return [replace(atom, expression=with_leaves(atom.expression, bound)) for atom in fspa.atoms]
