"""Check the names in a level: whether specs can use them, and whether what they refer to exists."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from tltl_runtime.stealth.level import StealthLevel, entity_names
from tltl_runtime.stealth.levels.level_tables import CELL_TYPES, NamedParts
from tltl_runtime.stealth.signals import readers
from tltl_runtime.support.suggestion import MOST_SUGGESTIONS, suggestion
from tltlc.api import Diagnostic, SourceFile, replace


def check_names(names: Iterable[str], places: NamedParts) -> list[Diagnostic]:
    """Return an error (TLT0804) for each name that no spec can declare as an entity, such as a keyword.

    ``places`` knows where the level's files contain the names.
    """
    from tltlc.api import syntax

    diagnostics = []
    for name in names:
        valid = (
            re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII) and not syntax.parse(SourceFile("", f"entity {name}\n"))[1]
        )
        if not valid:
            help_ = (
                "use one word of ASCII letters, digits and _ that does not begin with a digit "
                "and is not a word of the language, e.g. `north_door`"
            )
            diagnostics.append(
                Diagnostic("TLT0804", f"no spec can use the name `{name}`", places.name_labels(name), help_)
            )
    return diagnostics


def check_references(level: StealthLevel, places: NamedParts) -> list[Diagnostic]:
    """Return an error (TLT0805) for each name that the level's files refer to and that does not exist.

    Also return one for each barrier that nothing opens, or that more than one thing opens.
    """
    # Leave out the aliases of signals: this function checks the names that they stand for.
    signals = readers(replace(level, signals=()))
    known = {
        "switch": [switch.name for switch in level.switches],
        "barrier": [barrier.name for barrier in level.barriers],
        "entity": list(entity_names(level)),
        "cell type": list(CELL_TYPES),
        "signal": [name for name in signals if "(" not in name],
    }
    known_names = {kind: frozenset(names) for kind, names in known.items()} | {"signal": frozenset(signals)}
    diagnostics: list[Diagnostic] = []
    for kind, name, label in places.references:
        if name not in known_names[kind]:
            hint = suggestion(name, known[kind]) if len(diagnostics) < MOST_SUGGESTIONS else None
            diagnostics.append(Diagnostic("TLT0805", f"there is no {kind} `{name}`", (label,), hint))
    unlocked = Counter(name for unlock in level.unlocks for name in unlock.barriers)
    for barrier in level.barriers:
        openers = bool(barrier.opened_by) + unlocked[barrier.name]
        if openers != 1:
            title = f"{'more than one thing opens' if openers else 'nothing opens'} the barrier `{barrier.name}`"
            help_ = "either name its switches in `opened_by`, or name the barrier in one `[[unlock]]`"
            diagnostics.append(Diagnostic("TLT0805", title, places.name_labels(barrier.name), help_))
    return diagnostics
