"""Read the options of a scene from a game file."""

from __future__ import annotations

import math
from typing import Any

from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltl_runtime.support.toml_tree import Entry, Tree


def read_options(table: CheckedTable) -> dict[str, Any]:
    """Return the options of a scene as plain values; log an error for each value that JSON cannot contain."""
    values = _values(table.entries)
    for key, value in values.items():
        if not _is_plain(value):
            expected = "finite numbers, texts, true, false, and lists and tables of these"
            table.log.append(wrong_value(table.entries[key], key, expected))
    return values


def _values(tree: Tree) -> dict[str, Any]:
    return {key: _value(entry.value) for key, entry in tree.items()}


def _value(value: Any) -> Any:
    if isinstance(value, Entry):
        return _value(value.value)
    if isinstance(value, dict):
        return {key: _value(item) for key, item in value.items()}
    return [_value(item) for item in value] if isinstance(value, list) else value


def _is_plain(value: object) -> bool:
    if isinstance(value, dict):
        return all(map(_is_plain, value.values()))
    if isinstance(value, list):
        return all(map(_is_plain, value))
    return isinstance(value, (str, int)) or (isinstance(value, float) and math.isfinite(value))
