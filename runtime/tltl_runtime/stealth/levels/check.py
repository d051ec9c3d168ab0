"""What must hold of the names in a level: specs can use them, and they stand for something."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable

from tltl_runtime.stealth.level import Level, entity_names
from tltl_runtime.stealth.levels.parts import CELL_TYPES, Places
from tltl_runtime.stealth.levels.table import MOST_SUGGESTIONS, suggestion
from tltl_runtime.stealth.signals import readers
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic


def check_names(names: Iterable[str], places: Places) -> list[Diagnostic]:
    """TLT0804 for each name that a spec could not declare as an entity."""
    from tltlc.grammar.parser import parse

    found = []
    for name in names:
        good = re.fullmatch(r"[A-Za-z_]\w*", name, re.ASCII) and not parse(SourceFile("", f"entity {name}\n"))[1]
        if not good:
            help_ = "a name is one word of letters, digits and _, and no word of the language, e.g. `north_door`"
            found.append(Diagnostic("TLT0804", f"no spec could speak of `{name}`", places.named(name), help_))
    return found


def check_references(level: Level, places: Places) -> list[Diagnostic]:
    """TLT0805 for each name that stands for nothing, and for barriers that nothing or too much opens."""
    # What a further name of a signal stands for is itself among the names to be checked.
    signals = readers(replace(level, signals=()))
    known = {
        "switch": [switch.name for switch in level.switches],
        "barrier": [barrier.name for barrier in level.barriers],
        "entity": list(entity_names(level)),
        "cell type": list(CELL_TYPES),
        "signal": [name for name in signals if "(" not in name],
    }
    there = {kind: frozenset(names) for kind, names in known.items()} | {"signal": frozenset(signals)}
    found: list[Diagnostic] = []
    for kind, name, label in places.references:
        if name not in there[kind]:
            way_out = suggestion(name, known[kind]) if len(found) < MOST_SUGGESTIONS else None
            found.append(Diagnostic("TLT0805", f"there is no {kind} `{name}`", (label,), way_out))
    unlocked = Counter(name for unlock in level.unlocks for name in unlock.barriers)
    for barrier in level.barriers:
        ways = bool(barrier.opened_by) + unlocked[barrier.name]
        if ways != 1:
            title = f"{'two things open' if ways else 'nothing opens'} the barrier `{barrier.name}`"
            help_ = "name its switches in `opened_by`, or the barrier in one `[[unlock]]`"
            found.append(Diagnostic("TLT0805", title, places.named(barrier.name), help_))
    return found
