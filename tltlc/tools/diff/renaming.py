"""Find atoms and signals that have another name but the same meaning."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from tltlc.core.record import replace
from tltlc.expression.tree import Condition, Const, Expression, ParamValue, SignalValue, When, nodes
from tltlc.tools.diff.differences import plain
from tltlc.tools.diff.expression_shapes import Leaf, with_leaves

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Atom
    from tltlc.resolve.spec import Param as SpecParam


def with_names_of(old: Fspa, new: Fspa) -> Fspa:
    """Return the new automaton in which renamed atoms have their old names.

    An atom counts as renamed if its expression is the same except for the names of params.
    """
    names, new_names = {atom.name for atom in old.atoms}, {atom.name for atom in new.atoms}
    removed: dict[object, Atom] = {}
    for atom in old.atoms:
        if atom.name not in new_names:
            removed.setdefault(_form(atom.expression, old), atom)
    atoms: list[Atom] = []
    for atom in new.atoms:
        known = atom if atom.name in names else removed.pop(_form(atom.expression, new), atom)
        atoms.append(replace(atom, base=known.base, arguments=known.arguments))
    return replace(new, atoms=tuple(atoms))


def renamed_signals(old: Fspa, new: Fspa) -> dict[str, str]:
    """Return the new names of signals that are gone.

    A signal was renamed if an atom that read it now reads a new signal of the same type, and is the
    same except for the names of such signals and of params.
    """
    types, new_types = ({signal.name: signal.type for signal in fspa.signals} for fspa in (old, new))
    of_new = {atom.name: atom.expression for atom in new.atoms}
    names: dict[str, str] = {}
    for was, now in [(atom.expression, of_new[atom.name]) for atom in old.atoms if atom.name in of_new]:
        read = [
            (one.name, two.name)
            for one, two in zip(nodes(was), nodes(now), strict=False)
            if isinstance(one, SignalValue) and isinstance(two, SignalValue)
        ]
        likely = {
            one: two for one, two in read if one not in new_types and two not in types and types[one] == new_types[two]
        }
        is_one_to_one = len(set(likely.values())) == len(likely)
        if likely and is_one_to_one and _form(_with_signals(was, likely), old) == _form(now, new):
            names |= {one: two for one, two in likely.items() if one not in names and two not in names.values()}
    return names


def with_signals(fspa: Fspa, names: Mapping[str, str]) -> Fspa:
    """Return the automaton with signals renamed."""
    return replace(
        fspa,
        atoms=tuple(replace(atom, expression=_with_signals(atom.expression, names)) for atom in fspa.atoms),
        signals=tuple(
            replace(signal, base=names[signal.name], arguments=()) if signal.name in names else signal
            for signal in fspa.signals
        ),
    )


def _with_signals(expression: Expression, names: Mapping[str, str]) -> Expression:
    def renamed(leaf: Leaf) -> Leaf:
        return SignalValue(names.get(leaf.name, leaf.name)) if isinstance(leaf, SignalValue) else leaf

    return with_leaves(expression, renamed)


def _form(expression: Expression, of: Fspa) -> object:
    """Return a key that is equal for expressions that differ only in the names of params."""
    params = {param.name: param for param in of.params}
    return tuple(_token(node, params) for node in nodes(expression))


def _token(node: Expression | Condition, params: Mapping[str, SpecParam]) -> object:
    """Return a key for a node without its children, except for their number."""
    if isinstance(node, ParamValue):
        return "param", plain(params[node.name])
    if isinstance(node, (Const, SignalValue)):
        return node
    if isinstance(node, When):
        return "when", len(node.cases)
    return node.op, len(node.args)
