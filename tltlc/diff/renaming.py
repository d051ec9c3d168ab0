"""Atoms that have another name and are the same all the same."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from tltlc.diff.differences import plain
from tltlc.expression import Condition, Const, Expression, Param, Signal, When, nodes
from tltlc.record import replace

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Param as ParamValue


def with_names_of(old: Fspa, new: Fspa) -> Fspa:
    """The new automaton, in which atoms that changed their names alone are called as in the old one.

    Of such an atom the expression is the same but for the names of params.
    """
    names, new_names = {atom.name for atom in old.atoms}, {atom.name for atom in new.atoms}
    gone: dict[object, str] = {}
    for atom in old.atoms:
        if atom.name not in new_names:
            gone.setdefault(_form(atom.expression, old), atom.name)
    atoms = tuple(
        atom if atom.name in names else replace(atom, name=gone.pop(_form(atom.expression, new), atom.name))
        for atom in new.atoms
    )
    return replace(new, atoms=atoms)


def _form(expression: Expression, of: Fspa) -> object:
    """What two expressions share that differ in the names of params alone."""
    params = {param.name: param for param in of.params}
    return tuple(_token(node, params) for node in nodes(expression))


def _token(node: Expression | Condition, params: Mapping[str, ParamValue]) -> object:
    """A node without its parts, of which it says how many there are."""
    if isinstance(node, Param):
        return "param", plain(params[node.name])
    if isinstance(node, (Const, Signal)):
        return node
    if isinstance(node, When):
        return "when", len(node.cases)
    return node.op, len(node.args)
