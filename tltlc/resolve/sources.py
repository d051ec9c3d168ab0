"""The atoms from which an atom follows: ``times(seen) > 3`` follows from ``seen``."""

from __future__ import annotations

from collections.abc import Iterable

from tltlc.expression.tree import AtomValue, Before, Expression, SignalValue, nodes
from tltlc.resolve.registers import following_atoms
from tltlc.resolve.spec import Atom, Register


def sources(name: str, atoms: Iterable[Atom], registers: Iterable[Register]) -> tuple[str, ...]:
    """Return the names of the atoms from which an atom follows, in the order of ``atoms``.

    None of them follows from others.
    """
    atoms, registers = tuple(atoms), tuple(registers)
    following = following_atoms(atoms, registers)
    expressions = {atom.name: atom.expression for atom in atoms}
    updates = {register.name: register.update for register in registers}
    origins: set[str] = set()
    seen: set[Expression] = set()
    pending = [expressions[name]]
    while pending:
        expression = pending.pop()
        if expression in seen:
            continue
        seen.add(expression)
        for node in nodes(expression):
            if isinstance(node, AtomValue) and node.name in following:
                pending.append(expressions[node.name])
            elif isinstance(node, AtomValue):
                origins.add(node.name)
            elif isinstance(node, (SignalValue, Before)) and node.name in updates:
                pending.append(updates[node.name])
    return tuple(atom.name for atom in atoms if atom.name in origins)


def names_read(expression: Expression) -> list[str]:
    """Return the names of the signals and registers whose current values an expression reads."""
    return [node.name for node in nodes(expression) if isinstance(node, SignalValue)]
