"""Which atoms and registers a monitor can compute where a test sets the values of some signals."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from tltlc.core.record import record
from tltlc.expression.tree import Before, Expression, SignalValue, nodes
from tltlc.resolve.spec import Atom, Register, Signal


@record
class Computed:
    """The names of the atoms and registers that depend on numbers that are set, and on no other numbers.

    ``lacking`` maps each other atom that depends on a number that is set to the numbers that are not.
    """

    atoms: frozenset[str]
    registers: frozenset[str]
    lacking: Mapping[str, tuple[str, ...]]


def computed(
    numbers: Collection[str], atoms: Iterable[Atom], registers: Iterable[Register], signals: Iterable[Signal]
) -> Computed:
    """Return what can be computed if the signals ``numbers`` have values.

    A `bool` signal that is an atom itself counts as known, and so does what an atom remembers of other atoms, since
    these have values of their own. A `bool` signal that only predicates read may be in ``numbers``, like a number;
    if it is not, it is in ``lacking`` where it is needed beside a number that is set.
    """
    atoms = tuple(atoms)
    known = frozenset(numbers)
    own_atoms = {atom.name for atom in atoms}
    all_numbers = {signal.name for signal in signals if is_number_in_tests(signal, own_atoms)}
    reads = {register.name: _names_read(register.update) for register in registers}
    reads_of_atoms = {atom.name: _numbers(_names_read(atom.expression), reads, all_numbers) for atom in atoms}
    reads_of_registers = {name: _numbers(names, reads, all_numbers) for name, names in reads.items()}
    partly = {name: needed - known for name, needed in reads_of_atoms.items() if needed & known}
    lacking = {name: tuple(sorted(missing)) for name, missing in partly.items() if missing}
    return Computed(
        frozenset(name for name, needed in reads_of_atoms.items() if needed and needed <= known),
        frozenset(name for name, needed in reads_of_registers.items() if needed and needed <= known),
        lacking,
    )


def is_number_in_tests(signal: Signal, atoms: Collection[str]) -> bool:
    """Whether a step of a test sets a signal: a number, an enum, or a `bool` that is none of ``atoms`` by itself."""
    return signal.type != "bool" or signal.name not in atoms


def _names_read(expression: Expression) -> frozenset[str]:
    return frozenset(node.name for node in nodes(expression) if isinstance(node, (SignalValue, Before)))


def _numbers(names: Iterable[str], reads: Mapping[str, frozenset[str]], numbers: Collection[str]) -> frozenset[str]:
    """Return the numbers among names of signals and registers, and among what these registers read."""
    pending, seen = list(names), set(names)
    while pending:
        for name in reads.get(pending.pop(), frozenset()) - seen:
            seen.add(name)
            pending.append(name)
    return frozenset(seen & set(numbers))
