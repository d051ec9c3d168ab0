"""Compare what a library sets for all specs that import it: exclusive atoms and the clock."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from tltlc.core.record import EMPTY, record
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import ClockDecl, ExclusiveDecl
from tltlc.tools.diff import findings
from tltlc.tools.diff.differences import are_exclusive

if TYPE_CHECKING:
    from tltlc.diagnostics.diagnostic import Diagnostic
    from tltlc.grammar.module import Module
    from tltlc.resolve.spec import ResolvedFile


@record
class Rules:
    """The ``exclusive`` groups and the clock that a file declares, with their places in its text.

    Groups and clocks of imported files do not count. ``exclusive`` maps each group, as sorted names of
    atoms, to its place. ``clock`` is the period of the clock in seconds or ``varies``, and ``clock_place``
    its place; both are None if the file declares no clock.
    """

    exclusive: Mapping[tuple[str, ...], Label] = EMPTY
    clock: float | str | None = None
    clock_place: Label | None = None


def rules(module: Module, program: ResolvedFile) -> Rules:
    """Return the ``exclusive`` groups and the clock that a module declares.

    ``program`` is the result of resolving the module, which must have had no errors.
    """
    own = [declaration for declaration in module.declarations if isinstance(declaration, ExclusiveDecl)]
    vocabulary = program.exclusive
    # The groups of imported files come first.
    groups = vocabulary.exclusive[len(vocabulary.exclusive) - len(own) :]
    names = [tuple(sorted(vocabulary.atoms[atom].name for atom in group)) for group in groups]
    places = {group: Label(module.source, declaration.span) for group, declaration in zip(names, own, strict=True)}
    clock = next((declaration for declaration in module.declarations if isinstance(declaration, ClockDecl)), None)
    if clock is None:
        return Rules(places)
    declared = "varies" if vocabulary.clock_varies else vocabulary.clock_s
    return Rules(places, declared, Label(module.source, clock.span))


def changed_rules(old: Rules, new: Rules) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each change of an ``exclusive`` group or the clock between two versions of a file."""
    for names, place in old.exclusive.items():
        if not are_exclusive(names, new.exclusive):
            yield findings.exclusive_removed(names, place)
    for names, place in new.exclusive.items():
        if not are_exclusive(names, old.exclusive):
            yield findings.exclusive_added(names, place)
    clock_place = new.clock_place or (old.clock_place and findings.at_old_place(old.clock_place))
    if clock_place is not None and old.clock != new.clock:
        yield findings.library_clock_changed(old.clock, new.clock, clock_place)
