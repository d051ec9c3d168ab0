"""Which atoms follow from others: ``times(seen) > 3`` follows from ``seen`` at this sample and those before."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.expression.tree import AtomValue, Before, Expression, SignalValue, nodes
from tltlc.resolve.spec import Atom, Register


def derived_atoms(atoms: Iterable[Atom], registers: Iterable[Register]) -> frozenset[str]:
    """Return the names of the atoms that follow from the other atoms at this sample and those before.

    They read only registers, and these registers read only atoms. Without registers, no atom follows
    from others.
    """
    from_atoms = registers_from_atoms(registers)
    return frozenset(atom.name for atom in atoms if (reads := set(names_read(atom.expression))) and reads <= from_atoms)


def sources(name: str, atoms: Iterable[Atom], registers: Iterable[Register]) -> tuple[str, ...]:
    """Return the names of the atoms from which a derived atom follows, in the order of ``atoms``.

    None of them follows from others.
    """
    atoms, registers = tuple(atoms), tuple(registers)
    derived = derived_atoms(atoms, registers)
    expressions = {atom.name: atom.expression for atom in atoms}
    updates = {register.name: register.update for register in registers}
    found: dict[str, None] = {}
    seen: set[Expression] = set()
    pending = [expressions[name]]
    while pending:
        expression = pending.pop()
        if expression in seen:
            continue
        seen.add(expression)
        for node in nodes(expression):
            if isinstance(node, AtomValue) and node.name in derived:
                pending.append(expressions[node.name])
            elif isinstance(node, AtomValue):
                found[node.name] = None
            elif isinstance(node, (SignalValue, Before)) and node.name in updates:
                pending.append(updates[node.name])
    return tuple(atom.name for atom in atoms if atom.name in found)


def registers_from_atoms(registers: Iterable[Register]) -> frozenset[str]:
    """Return the names of the registers whose values follow from the values of the atoms so far."""
    names: set[str] = set()
    for register in registers:
        if set(names_read(register.update)) <= names:
            names.add(register.name)
    return frozenset(names)


def names_read(expression: Expression) -> list[str]:
    """Return the names of the signals and registers whose current values an expression reads."""
    return [node.name for node in nodes(expression) if isinstance(node, SignalValue)]
