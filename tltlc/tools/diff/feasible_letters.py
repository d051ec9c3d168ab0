"""Find the traces over the atoms of two specs that a game can produce.

Atoms over the same signals may imply each other, so some traces are impossible.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from tltlc.automaton.compare import Literals, Trace, separating
from tltlc.core.record import replace
from tltlc.expression.tree import Const, ParamValue
from tltlc.tools.diff.expression_shapes import Leaf, with_leaves
from tltlc.tools.witness.samples import Realiser

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Atom, Signal

_MOST: Final = 30
"""The most impossible traces that one comparison may find."""


class FeasibleLetters:
    """Searches samples for the letters over the atoms of two automata.

    ``impossible`` collects the literals for which no sample was found. ``never`` has literals that
    are known to be impossible. They are not reported.
    """

    def __init__(self, a: Fspa, b: Fspa, never: tuple[Literals, ...]) -> None:
        self._never = never
        self.impossible: dict[Literals, None] = {}
        self._left = _MOST
        self._both = _both(a, b)
        self._realiser = None if self._both is None else Realiser(self._both)

    def real(self, trace: Trace | None, one: Fspa, other: Fspa, work: int) -> Trace | None:
        """Return ``trace``, which only ``one`` accepts, if samples are found for it.

        Otherwise return another such trace with samples, or None. If the limit of impossible traces
        is reached, the result may be a trace without samples.
        """
        while trace is not None and self._left and (found := self._obstacles(trace)):
            self._left -= 1
            self.impossible |= dict.fromkeys(found)
            trace = separating(one, other, work, (*self._never, *self.impossible))
        return trace

    def _obstacles(self, trace: Trace) -> list[Literals]:
        """Return literals of the trace's letters that no sample makes true together."""
        if self._both is None or self._realiser is None:
            return []
        obstacles = []
        for letter in dict.fromkeys((*trace.prefix, *trace.cycle)):
            for obstacle in self._realiser.obstacles(letter):
                named = [(self._both.atoms[atom].name, holds) for atom, holds in obstacle.literals]
                obstacles.append(tuple(sorted(named, key=lambda literal: not literal[1])))
        return obstacles


def _both(a: Fspa, b: Fspa) -> Fspa | None:
    """Return an automaton with the atoms of both automata and their params replaced by values.

    Its other parts have no meaning. Returns None if a signal is different in B and in A.
    """
    signals = {signal.name: signal for signal in a.signals}
    for signal in b.signals:
        common = _common(signals.get(signal.name, signal), signal)
        if common is None:
            return None
        signals[signal.name] = common
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
    """Return the signal with the range that both share.

    Returns None if that range is empty, or if only one of the two is a bool.
    """
    lows = [low for low in (one.low, other.low) if low is not None]
    highs = [high for high in (one.high, other.high) if high is not None]
    common = replace(one, low=max(lows, default=None), high=min(highs, default=None))
    if (one.type == "bool") != (other.type == "bool"):
        return None
    return None if common.low is not None and common.high is not None and common.low > common.high else common


def _atoms(fspa: Fspa) -> list[Atom]:
    """Return the atoms with params replaced by their values."""
    values = {param.name: param.value for param in fspa.params}

    def bound(leaf: Leaf) -> Leaf:
        return Const(values[leaf.name]) if isinstance(leaf, ParamValue) else leaf

    return [replace(atom, expression=with_leaves(atom.expression, bound)) for atom in fspa.atoms]
