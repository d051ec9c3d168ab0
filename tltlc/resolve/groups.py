"""Resolve groups of entities: ``entity guards = g1, g2`` is the group ``guards`` with two members."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tltlc.grammar.tree import GroupDecl, NameExpr
from tltlc.resolve.kinds import entity, lookup
from tltlc.resolve.problem import ResolutionError, problem
from tltlc.resolve.scope import Binding
from tltlc.resolve.values import Entity, Env


def entities(names: Sequence[NameExpr], env: Env, *, brackets: bool = True) -> tuple[Entity, ...]:
    """Return the entities that a quantifier lists, each once, with the members of groups in place of the groups.

    Without ``brackets``, as in ``all x in guards: p``, an unknown name is called a group in the error.
    Raises ResolutionError: the errors of :func:`~tltlc.resolve.kinds.entity`, and TLT0207 if a group
    contains itself, directly or through others.
    """
    noun = "entity" if brackets else "group"
    return tuple(dict.fromkeys(member for name in names for member in _members(name, env, (), noun)))


def check_group(binding: Binding, env: Env) -> None:
    """Check the members of a group that nothing may use. Raises the errors of :func:`entities`."""
    declaration = binding.declaration
    assert isinstance(declaration, GroupDecl)
    inside = env.inside(binding.scope, {})
    for member in declaration.members:
        known = binding.scope.names.get(member.name)
        # A member that is something else has been reported as declared twice.
        if known is None or known.kind in ("entity", "group"):
            for _ in _members(member, inside, (declaration,)):
                pass


def _members(name: NameExpr, env: Env, outer: tuple[GroupDecl, ...], noun: str = "entity") -> Iterator[Entity]:
    """Yield the entity with a name, or the members of the group with this name.

    ``outer`` are the groups that contain the name, outermost first. An error calls an unknown name a ``noun``.
    """
    binding = None if name.name in env.local else lookup(name, env, ("entity", "group"), noun)
    if binding is None or not isinstance(binding.declaration, GroupDecl):
        yield entity(name, env)
        return
    group = binding.declaration
    if group in outer:
        raise _recursion_error(name, outer[outer.index(group) :], env)
    inside = env.inside(binding.scope, {})
    for member in group.members:
        yield from _members(member, inside, (*outer, group))


def _recursion_error(name: NameExpr, cycle: Sequence[GroupDecl], env: Env) -> ResolutionError:
    """Return the error for a group that contains itself, without a diagnostic if the cycle was reported already."""
    broken = env.context.broken
    if not broken.isdisjoint(map(id, cycle)):
        return ResolutionError(None)
    broken.update(map(id, cycle))
    group = cycle[0].name
    path = " -> ".join((*(part.name for part in cycle), group))
    title = f"the group `{group}` contains itself: {path}"
    advice = "list entities, or groups that do not contain this one"
    return problem("TLT0207", title, env.scope.source, name.span, advice=advice)
