"""Which timers of two specs imply each other: where more than 5 s have passed, more than 4 s have.

The rules compare the updates of registers (:mod:`tltlc.resolve.registers`). Each holds at every sample, by
induction over the trace:

- The time since p is at most the time since q if q implies p. So is its age, which leaves out this sample.
- The time for which p has held is at most that of q if p implies q.
- The longest wait for an answer grows with more requests and with fewer answers. In seconds, a late request
  waits for ever; with a shorter deadline, it is late no later.
- ``x > 5`` implies ``y > 4`` if x is at most y, and ``x < 4`` implies ``y < 5`` if y is at most x.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from math import inf
from typing import TYPE_CHECKING, cast

from tltlc.automaton.remembered_formulas import counted, from_robustness, waited_for, window_of
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When
from tltlc.resolve.registers import following_atoms
from tltlc.resolve.sources import names_read

if TYPE_CHECKING:
    from tltlc.automaton.compare import NamedLiterals
    from tltlc.automaton.fspa import Fspa
    from tltlc.logic.formula import Formula
    from tltlc.resolve.spec import Atom, Register


def timer_conflicts(
    automata: tuple[Fspa, Fspa], split_names: Collection[str], suffixes: tuple[str, str]
) -> Iterator[NamedLiterals]:
    """Yield pairs of literals that no sample meets: an atom of one spec, and the opposite of one that it implies.

    ``split_names`` are the atoms that mean something else in the other spec; they have these ``suffixes``.
    """
    a, b = (_Timers(fspa, split_names, suffix) for fspa, suffix in zip(automata, suffixes, strict=True))
    for one, other in ((a, b), (b, a)):
        for first in one.timers:
            for second in other.timers:
                names = one.named(first), other.named(second)
                if first.base == second.base and names[0] != names[1] and _atom_implies(one, first, other, second):
                    yield ((names[0], True), (names[1], False))


class _Timers:
    """The atoms and registers of a spec. ``timers`` are the atoms that follow from others."""

    def __init__(self, fspa: Fspa, split_names: Collection[str], suffix: str) -> None:
        self.atoms = {atom.name: atom for atom in fspa.atoms}
        self.registers = {register.name: register for register in fspa.registers}
        following = following_atoms(fspa.atoms, fspa.registers)
        self.timers = [atom for atom in fspa.atoms if atom.name in following and atom.timer is not None]
        self._split, self._suffix = split_names, suffix

    def named(self, atom: Atom) -> str:
        """Return the name of an atom in traces over the atoms of both specs."""
        return atom.name + (self._suffix if atom.name in self._split else "")

    def register(self, expression: Expression) -> Register | None:
        """Return the register that the expression of a timer reads; None if it reads none or more."""
        read = set(names_read(expression))
        return self.registers.get(read.pop()) if len(read) == 1 else None


# Each of these proves something of an item of the spec ``one`` and one of the spec ``other``, at each sample.


def _atom_implies(one: _Timers, first: Atom, other: _Timers, second: Atom) -> bool:
    if one.named(first) == other.named(second):
        return True
    # A predicate may compute anything from a register.
    are_timers = first.timer is not None and second.timer is not None
    return are_timers and first.base == second.base and _implies(one, first.expression, other, second.expression)


def _implies(one: _Timers, first: Expression, other: _Timers, second: Expression) -> bool:
    """Whether a robustness above 0 implies that another one is above 0."""
    first, second = _without_least(first), _without_least(second)
    left, right = window_of(first), window_of(second)
    if left is not None and right is not None:
        registers = one.register(first), other.register(second)
        if registers[0] is None or registers[1] is None or left.is_recent != right.is_recent:
            return False
        if left.is_recent:
            return left.border <= right.border and _is_at_most(other, registers[1], one, registers[0])
        return left.border >= right.border and _is_at_most(one, registers[0], other, registers[1])
    if isinstance(first, SignalValue) and isinstance(second, SignalValue):
        return _register_implies(one, one.registers.get(first.name), other, other.registers.get(second.name))
    if isinstance(first, Op) and isinstance(second, Op) and first.op == second.op and first.op in ("min", "max"):
        pairs = list(zip(first.args, second.args, strict=False))
        return len(first.args) == len(second.args) and all(_implies(one, x, other, y) for x, y in pairs)
    return _formula_implies(one, from_robustness(first), other, from_robustness(second))


def _register_implies(one: _Timers, first: Register | None, other: _Timers, second: Register | None) -> bool:
    """Whether a register above 0 implies that another one is: a broken rule, or a request that waits."""
    if first is None or second is None or first.kind != second.kind:
        return False
    if first.kind == "breach":
        return _implies(one, first.update, other, second.update)
    return first.kind == "due" and _waits_longer(one, first, other, second)


def _is_at_most(one: _Timers, first: Register, other: _Timers, second: Register) -> bool:
    """Whether a time is at most another one."""
    if first.kind != second.kind or first.unit != second.unit:
        return False
    if first.kind in ("samples", "elapsed"):
        return True
    if first.kind == "waiting":
        deadlines = _deadline_s(first), _deadline_s(second)
        return deadlines[0] >= deadlines[1] and _waits_longer(one, first, other, second)
    events = counted(first, one.registers), counted(second, other.registers)
    if first.kind in ("time_since", "age"):
        return _formula_implies(other, events[1], one, events[0])
    return first.kind in ("time_holding", "run") and _formula_implies(one, events[0], other, events[1])


def _waits_longer(one: _Timers, first: Register, other: _Timers, second: Register) -> bool:
    """Whether some request waits in ``other`` where one does in ``one``, at least as long."""
    left, right = waited_for(first), waited_for(second)
    return (
        left is not None
        and right is not None
        and left.strict == right.strict
        and _formula_implies(one, left.request, other, right.request)
        and _formula_implies(other, right.goal, one, left.goal)
    )


def _formula_implies(one: _Timers, first: Formula | None, other: _Timers, second: Formula | None) -> bool:
    """Whether a formula without temporal operators implies another one of the same form."""
    if first is None or second is None or first.op != second.op or len(first.args) != len(second.args):
        return False
    if first.op == "atom":
        atoms = one.atoms.get(first.name), other.atoms.get(second.name)
        return atoms[0] is not None and atoms[1] is not None and _atom_implies(one, atoms[0], other, atoms[1])
    pairs = list(zip(first.args, second.args, strict=True))
    forward = [_formula_implies(one, x, other, y) for x, y in pairs]
    if first.op in ("and", "or", "true", "false"):
        return all(forward)
    backward = [_formula_implies(other, y, one, x) for x, y in pairs]
    if first.op == "implies":
        return backward[0] and forward[1]
    return all(backward) and (first.op == "not" or all(forward))


def _without_least(value: Expression) -> Expression:
    """Return a robustness without the least value that it is limited to."""
    if isinstance(value, Op) and value.op == "max" and len(value.args) == 2 and value.args[1] == Const(-1.0):
        return value.args[0]
    return value


def _deadline_s(waiting: Register) -> float:
    """Return the time in seconds after which a request waits for ever; infinity if it does not."""
    update = waiting.update.args[0] if isinstance(waiting.update, Op) else waiting.update
    if waiting.unit != "s" or not isinstance(update, When):
        return inf
    is_late = cast("Condition", update.cases[0][0].args[1])
    return cast("Const", is_late.args[1]).value
