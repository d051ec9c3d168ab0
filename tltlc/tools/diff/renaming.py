"""Find atoms and signals that have another name but the same meaning."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from tltlc.core.record import replace
from tltlc.expression.tree import (
    AtomValue,
    Before,
    Condition,
    Const,
    Expression,
    ParamValue,
    SignalValue,
    StepLength,
    When,
    nodes,
)
from tltlc.tools.diff.differences import type_and_range
from tltlc.tools.diff.expression_shapes import ExpressionLeaf, replace_leaves

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Atom, Register
    from tltlc.resolve.spec import Param as SpecParam


def with_old_atom_names(old: Fspa, new: Fspa) -> Fspa:
    """Return the automaton ``new`` in which renamed atoms have their old names again.

    An added atom counts as renamed if a removed atom has the same expression. The names of params in
    the expressions may differ. Each removed atom gives its name to one added atom at most. Only the
    names in ``atoms`` and in the updates of registers change; the formulas keep the new ones.
    """
    names, new_names = {atom.name for atom in old.atoms}, {atom.name for atom in new.atoms}
    removed: dict[object, Atom] = {}
    for atom in old.atoms:
        if atom.name not in new_names:
            removed.setdefault(_key(atom.expression, old), atom)
    atoms: list[Atom] = []
    old_names: dict[str, str] = {}
    for atom in new.atoms:
        known = atom if atom.name in names else removed.pop(_key(atom.expression, new), atom)
        atoms.append(replace(atom, base=known.base, arguments=known.arguments))
        old_names[atom.name] = known.name

    def rename(leaf: ExpressionLeaf) -> ExpressionLeaf:
        return AtomValue(old_names[leaf.name]) if isinstance(leaf, AtomValue) else leaf

    return replace(new, atoms=tuple(atoms), registers=_with_leaves(new.registers, rename))


def new_signal_names(old: Fspa, new: Fspa) -> dict[str, str]:
    """Return the new names of renamed signals, by their old names.

    A removed signal counts as renamed if an atom that read this signal now reads an added signal of
    the same type in its place. Apart from the names of renamed signals and of params, the expression
    of the atom must be the same.
    """
    types, new_types = ({signal.name: signal.type for signal in fspa.signals} for fspa in (old, new))
    new_expressions = {atom.name: atom.expression for atom in new.atoms}
    names: dict[str, str] = {}
    for old_expression, new_expression in [
        (atom.expression, new_expressions[atom.name]) for atom in old.atoms if atom.name in new_expressions
    ]:
        signal_pairs = [
            (before.name, after.name)
            for before, after in zip(nodes(old_expression), nodes(new_expression), strict=False)
            if isinstance(before, SignalValue) and isinstance(after, SignalValue)
        ]
        likely = {
            before: after
            for before, after in signal_pairs
            if before in types.keys() - new_types.keys()
            and after in new_types.keys() - types.keys()
            and types[before] == new_types[after]
        }
        is_one_to_one = len(set(likely.values())) == len(likely)
        if likely and is_one_to_one and _key(_rename_signals(old_expression, likely), old) == _key(new_expression, new):
            names |= {
                before: after for before, after in likely.items() if before not in names and after not in names.values()
            }
    return names


def rename_signals(fspa: Fspa, names: Mapping[str, str]) -> Fspa:
    """Return the automaton with signals renamed; ``names`` maps old names to new names."""
    return replace(
        fspa,
        atoms=tuple(replace(atom, expression=_rename_signals(atom.expression, names)) for atom in fspa.atoms),
        registers=tuple(
            replace(register, update=_rename_signals(register.update, names)) for register in fspa.registers
        ),
        signals=tuple(
            replace(signal, base=names[signal.name], arguments=()) if signal.name in names else signal
            for signal in fspa.signals
        ),
    )


def _with_leaves(
    registers: tuple[Register, ...], change: Callable[[ExpressionLeaf], ExpressionLeaf]
) -> tuple[Register, ...]:
    return tuple(replace(register, update=replace_leaves(register.update, change)) for register in registers)


def _rename_signals(expression: Expression, names: Mapping[str, str]) -> Expression:
    def rename(leaf: ExpressionLeaf) -> ExpressionLeaf:
        return SignalValue(names.get(leaf.name, leaf.name)) if isinstance(leaf, SignalValue) else leaf

    return replace_leaves(expression, rename)


def _key(expression: Expression, fspa: Fspa) -> object:
    """Return a key of an expression; expressions that differ only in the names of params have equal keys."""
    params = {param.name: param for param in fspa.params}
    return tuple(_token(node, params) for node in nodes(expression))


def _token(node: Expression | Condition, params: Mapping[str, SpecParam]) -> object:
    """Return a key of a single node. It has the number of the node's children, but not the children."""
    if isinstance(node, ParamValue):
        return "param", type_and_range(params[node.name])
    if isinstance(node, (Const, SignalValue, AtomValue, Before, StepLength)):
        return node
    if isinstance(node, When):
        return "when", len(node.cases)
    return node.op, len(node.args)
