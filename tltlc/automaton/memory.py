"""The order in which a monitor computes atoms and registers at a sample, and which atoms follow from others."""

from __future__ import annotations

from typing import Literal

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.expression.tree import AtomValue, Expression, nodes
from tltlc.resolve import registers


@record
class Computation:
    """One thing that a monitor computes at a sample: the atom or the register with this index."""

    kind: Literal["atom", "register"]
    index: int


def schedule(fspa: Fspa) -> tuple[Computation, ...]:
    """Return the atoms and registers in the order in which a monitor computes them at a sample.

    Registers keep their order. Each comes after the atoms that its update reads, and each atom after
    the registers that it reads. Without registers, the atoms keep their order, too.
    """
    number = {atom.name: index for index, atom in enumerate(fspa.atoms)}
    order: dict[Computation, None] = {}
    for index, register in enumerate(fspa.registers):
        for name in _atoms_read(register.update):
            order.setdefault(Computation("atom", number[name]))
        order.setdefault(Computation("register", index))
    for index in range(len(fspa.atoms)):
        order.setdefault(Computation("atom", index))
    return tuple(order)


def given_atoms(fspa: Fspa) -> tuple[int, ...]:
    """Return the indices of the atoms that do not follow from the other atoms at this sample and those before.

    ``times(seen) > 3`` follows from ``seen``. Without registers, no atom follows from others.
    """
    following = registers.following_atoms(fspa.atoms, fspa.registers)
    return tuple(index for index, atom in enumerate(fspa.atoms) if atom.name not in following)


def registers_from_atoms(fspa: Fspa) -> frozenset[str]:
    """Return the names of the registers whose values follow from the values of the atoms so far."""
    return registers.from_atoms(fspa.registers)


def _atoms_read(expression: Expression) -> list[str]:
    return [node.name for node in nodes(expression) if isinstance(node, AtomValue)]
