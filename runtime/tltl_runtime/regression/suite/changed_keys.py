"""Describe which keys of a TOML file have changed, for example ```walk_speed` 1.6 → 2.6``."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Final, TypeGuard

from tltl_runtime.support.number_text import short_list
from tltlc.api import SourceFile, TltlError, fileio, record

LAYOUT: Final = "its layout"
"""The description of a file in which no value has changed."""

_MOST_KEYS: Final = 3
"""At most this many keys of a file are named. Further keys are counted."""

_MOST_CHARACTERS: Final = 24
"""A value is shown if its JSON has at most this many characters. Else only its key is shown."""


@record
class ChangedKeys:
    """A description of changed keys, and the parts of the keys that the description names.

    For ```wall.far_wall.at` new``, the parts are ``wall``, ``far_wall`` and ``at``.
    """

    text: str
    parts: tuple[str, ...] = ()


def changed_keys(
    before: str, now: str, part: Callable[[Mapping[str, Any]], Mapping[str, Any]] = lambda table: table
) -> ChangedKeys:
    """Describe the keys whose values differ between two TOML texts, for example ```speed` 1.6 → 2.6``.

    Long values are left out. The description is ``its layout`` if no value differs, and empty if a
    text is not TOML. Tables in a list are matched by their ``name`` if all have distinct names, else
    by position, counted from 1. ``part`` returns the part of a TOML document that is compared.
    """
    try:
        old, new = (fileio.parse_toml(SourceFile("", text), "TLT0801", "") for text in (before, now))
    except TltlError:
        return ChangedKeys("")
    changes = list(_changes((), part(old), part(new)))
    # Further keys are counted, not named.
    parts = tuple(dict.fromkeys(part for path, _ in changes[:_MOST_KEYS] for part in path))
    return ChangedKeys(short_list([text for _, text in changes], _MOST_KEYS) or LAYOUT, parts)


def _changes(
    path: tuple[str, ...], old: Mapping[str, Any], new: Mapping[str, Any]
) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield a pair for each key whose value differs between the tables ``old`` and ``new``.

    The pair is the path of the key in the TOML file and a description of the change. ``path`` are
    the keys that lead to the two tables. The order is that of the new table; removed keys come last.
    """
    for key in dict.fromkeys((*new, *old)):
        key_path = (*path, key)
        name, before, now = f"`{'.'.join(key_path)}`", old.get(key), new.get(key)
        if key not in old:
            yield key_path, f"{name} new{_value_text(': ', now)}"
        elif key not in new:
            yield key_path, f"{name} removed"
        elif isinstance(before, dict) and isinstance(now, dict):
            yield from _changes(key_path, before, now)
        elif _are_tables(before) and _are_tables(now):
            have_names = _have_names(before) and _have_names(now)
            old_tables, new_tables = map(_names if have_names else _positions, (before, now))
            if have_names and before != now and old_tables == new_tables:
                yield key_path, f"the order of {name}"
            yield from _changes(key_path, old_tables, new_tables)
        elif (type(before), before) != (type(now), now):
            values = _value_text(" ", before), _value_text(" → ", now)
            yield key_path, name + "".join(values) if all(values) else name


def _are_tables(value: Any) -> TypeGuard[list[dict[str, Any]]]:
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def _have_names(tables: Sequence[Mapping[str, Any]]) -> bool:
    """Whether all tables have a ``name``, and the names are distinct."""
    return len({table["name"] for table in tables if isinstance(table.get("name"), str)}) == len(tables)


def _names(tables: Sequence[Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    return {table["name"]: table for table in tables}


def _positions(tables: Sequence[Mapping[str, Any]]) -> dict[str, Mapping[str, Any]]:
    return {str(row): table for row, table in enumerate(tables, 1)}


def _value_text(before: str, value: Any) -> str:
    """Return the text ``before`` and then ``value`` as JSON; empty if the JSON is too long."""
    text = json.dumps(value, ensure_ascii=False, default=str)
    return before + text if len(text) <= _MOST_CHARACTERS else ""
