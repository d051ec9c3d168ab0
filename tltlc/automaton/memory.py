"""The order in which a monitor computes atoms and registers at a sample, and which atoms follow from others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import AtomValue, Before, Expression, Op, SignalValue, VariableKey, nodes
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


def breaches_now(fspa: Fspa) -> dict[str, Expression]:
    """Return the registers of kind ``breach`` about this sample alone: their names, and their values over its atoms."""
    return {
        register.name: register.update
        for register in fspa.registers
        if register.kind == "breach"
        if not any(isinstance(node, (SignalValue, Before)) for node in nodes(register.update))
    }


def deciding_atoms(fspa: Fspa, atoms: Sequence[int], values: Sequence[float]) -> tuple[int, ...]:
    """Return atoms that hold or fail at a sample, with the reasons in place of those about the sample alone.

    ``values`` are the values of all atoms. Where the atom says that a rule about this sample is broken,
    the reasons are the atoms that break it.
    """
    breaches = breaches_now(fspa)
    number = {atom.name: index for index, atom in enumerate(fspa.atoms)}
    known: dict[VariableKey, float] = {AtomValue(name): values[index] for name, index in number.items()}
    reasons: dict[int, None] = {}
    for index in atoms:
        name = fspa.atoms[index].name
        names = _reasons(breaches[name], known) if name in breaches and values[index] > 0.0 else [name]
        reasons.update(dict.fromkeys(number[reason] for reason in names))
    return tuple(reasons)


def _reasons(value: Expression, known: Mapping[VariableKey, float]) -> Iterator[str]:
    """Yield the names of the atoms that make a formula true, whose robustness is ``value``."""
    if isinstance(value, Op) and value.op == "max":
        yield from _reasons(max(value.args, key=lambda part: evaluate(part, known, {})), known)
    elif isinstance(value, Op) and value.op == "min":
        for part in value.args:
            yield from _reasons(part, known)
    else:
        yield from _atoms_read(value)[:1]


def _atoms_read(expression: Expression) -> list[str]:
    return [node.name for node in nodes(expression) if isinstance(node, AtomValue)]
