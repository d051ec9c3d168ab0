"""An explanation as values that JSON has."""

from __future__ import annotations

from typing import Any

from tltlc.tools.explain.explanation import Explanation


def values(explained: Explanation) -> dict[str, Any]:
    """The fields of an explanation by their names, and so on inside."""
    found: dict[str, Any] = _value(explained)
    return found


def _value(given: Any) -> Any:
    if isinstance(given, tuple):
        return [_value(each) for each in given]
    if hasattr(given, "__match_args__"):
        return {name: _value(getattr(given, name)) for name in given.__match_args__}
    return given
