"""Convert an explanation to JSON values."""

from __future__ import annotations

from typing import Any

from tltlc.tools.explain.explanation import Explanation


def json_values(explanation: Explanation) -> dict[str, Any]:
    """Return the fields of an explanation by name, recursively as JSON values.

    A run in ``counting`` becomes the list of its states.
    """
    return {**_value(explanation), "counting": [list(run.states) for run in explanation.counting]}


def _value(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_value(element) for element in value]
    if hasattr(value, "__match_args__"):
        return {name: _value(getattr(value, name)) for name in value.__match_args__}
    return value
