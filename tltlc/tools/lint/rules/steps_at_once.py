"""TLT0415: several goals that one step can meet, as far as the automaton knows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Final

from tltlc.automaton.finite.build import build
from tltlc.automaton.fspa import Edge, Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Label, TltlError
from tltlc.logic.formula import Formula
from tltlc.resolve.spec import Spec
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, without_brackets
from tltlc.tools.lint.goals import conjuncts, goals
from tltlc.tools.lint.rule import LintRule, RuleFinding

_MOST_LABELS: Final = 4
_MOST_STATES: Final = 1_000
"""The most states of the automaton that is built to see what declaring atoms `exclusive` would change.

The limit keeps this rule, which reports only notes, faster than the compilation.
"""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each group of goals, atoms of one predicate, that one step can meet together.

    An example is ``near(s1)`` and ``near(s2)``. There is a finding only if the spec needs more steps
    once these atoms are declared exclusive. Also yield a finding for each goal that asks for several
    of these atoms at one step.
    """
    entities = {binding.name for binding in view.env.scope.names.values() if binding.kind == "entity"}
    for spec in view.specs:
        if spec.fspa.semantics != "finite" or spec.fspa.states[0].verdict == "violated":
            continue
        groups = _goal_atoms(_same_predicate(spec.fspa, entities), spec)
        if groups:
            yield from _joint_goals(groups, spec)
        for group in groups:
            indices = sorted(set().union(*(_atoms_together(edge, group) for edge in spec.fspa.edges)))
            if indices and _is_shortened(spec, indices):
                yield _finding(spec, [spec.fspa.atoms[index].name for index in indices])


def _joint_goals(groups: list[set[int]], spec: SpecView) -> Iterator[RuleFinding]:
    """Yield a finding for each goal, such as ``near(s1) and near(s2)``, that asks for two atoms of a group.

    The author may mean two goals, one after the other. ``groups`` has sets of indices of atoms.
    """
    for goal in goals(spec):
        parts = [part for part in conjuncts(goal) if _atom(part)]
        for group in groups:
            names = {spec.fspa.atoms[index].name for index in group}
            members = [part for part in parts if _atom(part) in names]
            if len({_atom(part) for part in members}) > 1:
                member_names = list(dict.fromkeys(_atom(part) for part in members))
                title = f"this goal asks for `{member_names[0]}` and `{member_names[1]}` at the same step"
                label = Label(goal.source, without_brackets(goal.tree).span, "all of this at once")
                help_ = f"if one comes after the other, write `{' then '.join(member_names)}`"
                yield RuleFinding(title, (label,), help_)


def _atom(part: ScopedExpression) -> str:
    """Return the name of an atom; an empty string if the expression is anything but an atom."""
    formula = part.formula()
    return formula.name if formula is not None and formula.op == "atom" else ""


def _goal_atoms(groups: list[set[int]], spec: SpecView) -> list[set[int]]:
    """Remove from each group the atoms that no goal asks for; leave out groups with fewer than two atoms left.

    Groups are sets of indices of atoms. A goal asks for an atom if only `and` and `or` are around it.
    """
    names = {part.name for goal in goals(spec) for part in _operands(goal.formula()) if part.op == "atom"}
    reached = [{index for index in group if spec.fspa.atoms[index].name in names} for group in groups]
    return [group for group in reached if len(group) > 1]


def _operands(formula: Formula | None) -> Iterator[Formula]:
    """Yield the operands of nested `and` and `or`; for any other formula, the formula itself.

    For ``a & (b | X c)``, these are ``a``, ``b`` and ``X c``. Yield nothing for None.
    """
    pending = [] if formula is None else [formula]
    while pending:
        part = pending.pop()
        if part.op in ("and", "or"):
            pending += reversed(part.args)
        else:
            yield part


def _with_exclusive(spec: Spec, indices: list[int]) -> Spec:
    """Return the spec with the atoms at these indices declared exclusive."""
    return replace(spec, exclusive=(*spec.exclusive, tuple(indices)))


def _finding(spec: SpecView, names: list[str]) -> RuleFinding:
    parts = [part for part in spec.spec.parts if set(names).intersection(part.formula.atoms())]
    labels = (Label(part.source, part.span) for part in parts[:_MOST_LABELS])
    others = f" and {len(names) - 2} more" if len(names) > 2 else ""
    title = f"`{names[0]}` and `{names[1]}`{others} may be met at the same step, so progress counts them as one"
    help_ = f"if at most one of them holds at a time, write `exclusive {', '.join(names)}`"
    return RuleFinding(title, (spec.name_label(), *labels), help_)


def _same_predicate(fspa: Fspa, entities: Iterable[str]) -> list[set[int]]:
    """Return groups of indices of atoms that differ only in their first entity.

    For example, ``near(s1)`` and ``near(s2)`` are in one group.
    """
    known = set(entities)
    groups: dict[tuple[str, ...], set[int]] = {}
    for index, atom in enumerate(fspa.atoms):
        if atom.arguments and atom.arguments[0] in known:
            groups.setdefault((atom.base, *atom.arguments[1:]), set()).add(index)
    return [group for group in groups.values() if len(group) > 1]


def _atoms_together(edge: Edge, group: set[int]) -> set[int]:
    """If an edge can be taken only with several atoms of a group at once, return these atoms.

    ``group`` and the result have indices of atoms. The result is empty if the edge can be taken with
    one atom of the group or none, that is, if a prime implicant of its guard has at most one.
    """
    together = [group.intersection(atom for atom, holds in prime if holds) for prime in edge.guard.primes]
    return set().union(*together) if all(len(atoms) > 1 for atoms in together) else set()


def _is_shortened(spec: SpecView, indices: list[int]) -> bool:
    """Whether declaring these atoms exclusive makes the goal of the spec farther away, but not unreachable.

    False as well if the automaton would be too large.
    """
    try:
        apart = build(_with_exclusive(spec.spec, indices), state_budget=_MOST_STATES)
    except TltlError:
        return False
    return _length(apart) > _length(spec.fspa)


def _length(fspa: Fspa) -> tuple[int, int]:
    """Return the least number of steps to the goal, from the initial state and from the state farthest away.

    Both are 0 if no trace satisfies the spec.
    """
    return fspa.states[0].distance or 0, fspa.spec_size


RULE = LintRule("TLT0415", "note", check, lint_only=True)
