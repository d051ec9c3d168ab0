"""Compare what a library sets for all specs that import it: exclusive atoms and the clock."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from tltlc.core.record import EMPTY, record
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import ClockDecl, ExclusiveDecl
from tltlc.tools.diff import findings as say
from tltlc.tools.diff.differences import are_exclusive

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.grammar.tree import Module
    from tltlc.resolve.spec import ResolvedFile


@record
class Rules:
    """The ``exclusive`` groups that a file itself declares, with their places, and its clock.

    ``clock_s`` is None if the file declares no clock.
    """

    exclusive: Mapping[tuple[str, ...], Label] = EMPTY
    clock_s: float | None = None
    clock: Label | None = None


def rules(module: Module, program: ResolvedFile) -> Rules:
    """Return the rules of a module that resolved without errors."""
    own = [declaration for declaration in module.declarations if isinstance(declaration, ExclusiveDecl)]
    words = program.exclusive
    # The groups of imported files come first.
    groups = words.exclusive[len(words.exclusive) - len(own) :]
    names = [tuple(sorted(words.atoms[atom].name for atom in group)) for group in groups]
    places = {group: Label(module.source, declaration.span) for group, declaration in zip(names, own, strict=True)}
    clock = next((declaration for declaration in module.declarations if isinstance(declaration, ClockDecl)), None)
    if clock is None:
        return Rules(places)
    return Rules(places, words.clock_s, Label(module.source, clock.span))


def changed_rules(old: Rules, new: Rules) -> Iterator[Diagnostic]:
    """Yield the changes for all specs that import the file."""
    for names, place in old.exclusive.items():
        if not are_exclusive(names, new.exclusive):
            yield say.no_longer_exclusive(names, place)
    for names, place in new.exclusive.items():
        if not are_exclusive(names, old.exclusive):
            yield say.exclusive_now(names, place)
    clock = new.clock or (old.clock and say.was(old.clock))
    if clock is not None and old.clock_s != new.clock_s:
        yield say.clock_of_all(old.clock_s, new.clock_s, clock)
