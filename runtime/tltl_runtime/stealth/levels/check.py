"""What must hold of the names in a level: specs can use them, and they stand for something."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.levels.parts import CELL_TYPES, Places
from tltl_runtime.stealth.levels.table import suggestion
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.source import SourceFile

PLAIN_SIGNALS: Final = (
    *("health", "stamina", "position.x", "position.y", "position.z", "time"),
    *("visible", "seen", "crouching", "grounded"),
)
"""The signals of every level that speak of no entity."""

_SIGNAL_OF_ENTITY: Final = re.compile(r"(distance|bearing|line_of_sight|active|open)\((\w+)\)")


def entities(level: Level) -> tuple[str, ...]:
    """What specs may speak of by name: switches, barriers, exits, enemies and movers."""
    found = [switch.name for switch in level.switches]
    found += [barrier.name for barrier in level.barriers]
    found += [exit_.name for exit_ in level.exits]
    found += [enemy.name for enemy in level.enemies]
    return (*found, *(mover.name for mover in level.movers))


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
    known = {
        "switch": [switch.name for switch in level.switches],
        "barrier": [barrier.name for barrier in level.barriers],
        "entity": list(entities(level)),
        "cell type": list(CELL_TYPES),
        "signal": list(PLAIN_SIGNALS),
    }
    found = []
    for kind, name, label in places.references:
        if kind == "signal" and _is_signal(name, known):
            continue
        if name not in known[kind]:
            title = f"there is no {kind} `{name}`"
            found.append(Diagnostic("TLT0805", title, (label,), suggestion(name, known[kind])))
    unlocked = [name for unlock in level.unlocks for name in unlock.barriers]
    for barrier in level.barriers:
        ways = bool(barrier.opened_by) + unlocked.count(barrier.name)
        if ways != 1:
            title = f"{'two things open' if ways else 'nothing opens'} the barrier `{barrier.name}`"
            help_ = "name its switches in `opened_by`, or the barrier in one `[[unlock]]`"
            found.append(Diagnostic("TLT0805", title, places.named(barrier.name), help_))
    return found


def _is_signal(name: str, known: dict[str, list[str]]) -> bool:
    """Whether every level with these things has a signal of that name."""
    call = _SIGNAL_OF_ENTITY.fullmatch(name)
    if call is None:
        return name in PLAIN_SIGNALS
    return call[2] in known[{"active": "switch", "open": "barrier"}.get(call[1], "entity")]
