"""Which keys of a TOML file have changed, in short words: ```walk_speed` 1.6 → 2.6``."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final, TypeGuard

from tltl_runtime.support.number_text import listed
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.toml_text import parse

_MOST: Final = 3
"""Keys of a file that are named; of more it is said how many there are."""

_SHORT: Final = 24
"""Characters of a value that is shown; of a longer one it is only said that it has changed."""


def changed_keys(before: str, now: str) -> str:
    """The keys whose values differ between two TOML texts, with these where they are short.

    Tables in lists go by their `name` where all have one of their own, else by their position, counted from 1.  Empty
    where a text is no TOML.
    """
    try:
        old, new = (parse(SourceFile("", text), "TLT0801", "") for text in (before, now))
    except TltlError:
        return ""
    return listed(list(_changes((), old, new)), _MOST) or "its layout"


def _changes(path: tuple[str, ...], old: Mapping[str, Any], new: Mapping[str, Any]) -> Iterator[str]:
    """What differs between two tables at a path, in the order of the new one."""
    for key in dict.fromkeys((*new, *old)):
        here = (*path, key)
        name, before, now = f"`{'.'.join(here)}`", old.get(key), new.get(key)
        if key not in old:
            yield f"{name} new{_shown(': ', now)}"
        elif key not in new:
            yield f"{name} gone"
        elif isinstance(before, dict) and isinstance(now, dict):
            yield from _changes(here, before, now)
        elif _are_tables(before) and _are_tables(now):
            named = _have_names(before) and _have_names(now)
            old_tables, new_tables = map(_names if named else _positions, (before, now))
            if named and before != now and old_tables == new_tables:
                yield f"the order of {name}"
            yield from _changes(here, old_tables, new_tables)
        elif (type(before), before) != (type(now), now):
            values = _shown(" ", before), _shown(" → ", now)
            yield name + "".join(values) if all(values) else name


def _are_tables(value: Any) -> TypeGuard[list[dict[str, Any]]]:
    return isinstance(value, list) and bool(value) and all(isinstance(each, dict) for each in value)


def _have_names(tables: Sequence[Mapping[str, Any]]) -> bool:
    """Whether each has a name of its own."""
    return len({each["name"] for each in tables if isinstance(each.get("name"), str)}) == len(tables)


def _names(tables: Sequence[Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    return {each["name"]: each for each in tables}


def _positions(tables: Sequence[Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    return {str(row): each for row, each in enumerate(tables, 1)}


def _shown(before: str, value: Any) -> str:
    """A value behind what comes before it; empty where it is long."""
    text = json.dumps(value, ensure_ascii=False, default=str)
    return before + text if len(text) <= _SHORT else ""
