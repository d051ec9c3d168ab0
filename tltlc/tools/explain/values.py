"""Convert an explanation to JSON values."""

from __future__ import annotations

from typing import Any

from tltlc.tools.explain.explanation import Explanation


def json_values(explanation: Explanation) -> dict[str, Any]:
    """Return an explanation as a JSON object: its fields by name, and records inside it as objects, too.

    Only the entries of ``counting`` are shorter: each is the list of its states.
    """
    return {**_value(explanation), "counting": [list(run.states) for run in explanation.counting]}


def _value(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_value(element) for element in value]
    if hasattr(value, "__match_args__"):
        return {name: _value(getattr(value, name)) for name in value.__match_args__}
    return value
