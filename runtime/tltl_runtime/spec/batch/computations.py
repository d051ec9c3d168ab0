"""What is computed at a sample: the atoms and registers of an automaton, in order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from tltlc.api import Fspa, expressions, monitors, record


@record
class Computation:
    """The atom or the register with this index: its expression, and the key by which others read its value."""

    is_atom: bool
    index: int
    key: expressions.VariableKey
    expression: expressions.Expression


def computations_of(fspa: Fspa) -> list[Computation]:
    """Return the atoms and registers of an automaton in the order in which they are computed."""
    computations: list[Computation] = []
    for step in monitors.schedule(fspa):
        if step.kind == "atom":
            atom = fspa.atoms[step.index]
            key = expressions.AtomValue(atom.name)
            computations.append(Computation(True, step.index, key, atom.expression))
        else:
            register = fspa.registers[step.index]
            computations.append(Computation(False, step.index, register.name, register.update))
    return computations


def rows_of(computations: Sequence[Computation], is_atom: bool) -> list[int]:
    """Return the places of the atoms, or of the registers, among the computations, in the order of the automaton."""
    rows = {each.index: row for row, each in enumerate(computations) if each.is_atom == is_atom}
    return [rows[index] for index in range(len(rows))]


def constants(fspa: Fspa, params: Mapping[str, float]) -> Iterator[float]:
    """Yield all numbers that are used to compute atoms and registers, except the values of signals.

    They are the constants in expressions, the values of registers before the first sample, the ends of
    the signals' ranges, and the values of the params.
    """
    for each in computations_of(fspa):
        yield from (node.value for node in expressions.nodes(each.expression) if isinstance(node, expressions.Const))
    yield from (register.initial for register in fspa.registers)
    for signal in fspa.signals:
        yield from (end for end in (signal.low, signal.high) if end is not None)
    yield from params.values()
