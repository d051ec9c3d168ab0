"""TLT0415: goals at several places that the automaton takes to be met at one step."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from tltlc.automaton.finite.build import build
from tltlc.automaton.fspa import Edge, Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label, TltlError
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Spec
from tltlc.tools.lint.file_view import Expression, SpecView, View, inner
from tltlc.tools.lint.goals import conjuncts, goals
from tltlc.tools.lint.rule import Remark, Rule

_MOST_LABELS: Final = 4
_MOST_STATES: Final = 1_000
"""Of an automaton that is built to see what `exclusive` would do: a note must not take longer than the compilation."""


def check(view: View) -> Iterator[Remark]:
    """A remark for each predicate with which a spec is farther from its goal where its atoms never hold together."""
    entities = {binding.name for binding in view.env.scope.names.values() if binding.kind == "entity"}
    for spec in view.specs:
        if spec.fspa.semantics != "finite" or spec.fspa.states[0].verdict == "violated":
            continue
        groups = _reached(_alike(spec.fspa, entities), spec)
        if groups:
            yield from _together(groups, spec)
        for group in groups:
            indices = sorted(set().union(*(_atoms_together(edge, group) for edge in spec.fspa.edges)))
            if indices and _is_shortened(spec, indices):
                yield _remark(spec, [spec.fspa.atoms[index].name for index in indices])


def _together(groups: list[set[int]], spec: SpecView) -> Iterator[Remark]:
    """A remark for each goal that asks for several atoms of a group at one step, and may well mean one by one."""
    for goal in goals(spec):
        parts = [part for part in conjuncts(goal) if _atom(part)]
        for group in groups:
            names = {spec.fspa.atoms[index].name for index in group}
            asked = [part for part in parts if _atom(part) in names]
            if len({_atom(part) for part in asked}) > 1:
                found = list(dict.fromkeys(_atom(part) for part in asked))
                title = f"`{found[0]}` and `{found[1]}` are asked for at one step"
                label = Label(goal.source, inner(goal.tree).span, "all of this at the same moment")
                way_out = f"where one comes after the other, say so: `{' then '.join(found)}`"
                yield Remark(title, (label,), way_out)


def _atom(part: Expression) -> str:
    """The name of an atom, empty where an expression is none."""
    formula = part.formula()
    return formula.name if formula is not None and formula.op == "atom" else ""


def _reached(groups: list[set[int]], spec: SpecView) -> list[set[int]]:
    """Of each group the atoms that goals ask for: what is kept, or comes by an `until`, is no step of the way."""
    asked = {part.name for goal in goals(spec) for part in _operands(goal.formula()) if part.op == "atom"}
    reached = [{index for index in group if spec.fspa.atoms[index].name in asked} for group in groups]
    return [group for group in reached if len(group) > 1]


def _operands(formula: Formula | None) -> Iterator[Formula]:
    """The operands of `and` and `or`, and the formula itself where it is neither."""
    waiting = [] if formula is None else [formula]
    while waiting:
        part = waiting.pop()
        if part.op in ("and", "or"):
            waiting += reversed(part.args)
        else:
            yield part


def _apart(spec: Spec, indices: list[int]) -> Spec:
    """The spec with these atoms declared exclusive; those of the automaton are those of the spec."""
    return replace(spec, exclusive=(*spec.exclusive, tuple(indices)))


def _remark(spec: SpecView, names: list[str]) -> Remark:
    parts = [part for part in spec.spec.parts if set(names).intersection(part.formula.atoms())]
    labels = (Label(part.source, part.span) for part in parts[:_MOST_LABELS])
    others = f" and {len(names) - 2} more" if len(names) > 2 else ""
    title = f"`{names[0]}` and `{names[1]}`{others} may be met at one step, so progress counts them as one"
    way_out = f"where at most one of them holds at a time, say so: `exclusive {', '.join(names)}`"
    return Remark(title, (spec.name_label(), *labels), way_out)


def _alike(fspa: Fspa, entities: Iterable[str]) -> list[set[int]]:
    """Groups of atoms that differ in the entity that they speak of first, as ``near(s1)`` and ``near(s2)``."""
    known = set(entities)
    groups: dict[tuple[str, ...], set[int]] = {}
    for index, atom in enumerate(fspa.atoms):
        head, _, arguments = atom.name.partition("(")
        first, *rest = arguments.rstrip(")").split(", ")
        if first in known:
            groups.setdefault((head, *rest), set()).add(index)
    return [group for group in groups.values() if len(group) > 1]


def _atoms_together(edge: Edge, group: set[int]) -> set[int]:
    """The atoms of a group that an edge needs to hold at once; none where it can be taken otherwise."""
    together = [group.intersection(atom for atom, holds in prime if holds) for prime in edge.guard.primes]
    return set().union(*together) if all(len(held) > 1 for held in together) else set()


def _is_shortened(spec: SpecView, indices: list[int]) -> bool:
    """Whether the way to the goal is longer where these atoms exclude each other, and there still is one."""
    try:
        apart = build(_apart(spec.spec, indices), state_budget=_MOST_STATES)
    except TltlError:
        return False
    return _length(apart) > _length(spec.fspa)


def _length(fspa: Fspa) -> tuple[int, int]:
    """The distance from the start, and the greatest one; both are 0 where no trace satisfies it."""
    return fspa.states[0].distance or 0, fspa.spec_size


RULE = Rule("TLT0415", "note", check)
