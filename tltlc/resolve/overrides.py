"""Set params to the values that are given on the command line or when an artefact is loaded."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.resolve import units
from tltlc.resolve.constants import parse_override
from tltlc.resolve.spec import Param
from tltlc.resolve.values import number_text, range_text


def apply_overrides(
    params: Mapping[str, Param], values: Mapping[str, str]
) -> tuple[dict[str, Param], list[Diagnostic]]:
    """Return a copy of ``params`` with new values, such as ``{"level_size": "25 m"}``, and the errors found.

    Values in error are left out. The errors are TLT0308 for a name that is no param, and for a text
    that is no value for the param, and TLT0307 for a value outside the param's range.
    """
    result = dict(params)
    diagnostics = []
    for name, text in values.items():
        old = params.get(name)
        changed = _unknown_param(name, params) if old is None else _override_param(old, text)
        if isinstance(changed, Diagnostic):
            diagnostics.append(changed)
        else:
            result[name] = changed
    return result, diagnostics


def _unknown_param(name: str, params: Mapping[str, Param]) -> Diagnostic:
    from difflib import get_close_matches

    close_matches = get_close_matches(name, list(params), n=1)
    listed = ", ".join(f"`{known}`" for known in params)
    advice = (
        f"did you mean `{close_matches[0]}`?"
        if close_matches
        else f"there are: {listed}"
        if params
        else "there are none: leave it out"
    )
    return Diagnostic("TLT0308", f"there is no param `{name}` to set", (), advice)


def _override_param(old: Param, text: str) -> Param | Diagnostic:
    parsed = parse_override(text)
    dimension = units.TYPES[old.type]
    if parsed is None or parsed[1] not in (None, dimension):
        unit = units.si_unit(dimension)
        advice = f"write a number, e.g. `{old.name}={number_text(old.value)}{f' {unit}' if unit else ''}`"
        return Diagnostic("TLT0308", f"`{text}` is not a value for the param `{old.name}`", (), advice)
    low, high = -inf if old.low is None else old.low, inf if old.high is None else old.high
    if not low <= parsed[0] <= high:
        advice = f"its range is {range_text(low, high, dimension)}"
        return Diagnostic("TLT0307", f"`{text}` lies outside the range of the param `{old.name}`", (), advice)
    if old.type == "int" and not parsed[0].is_integer():
        title = f"`{text}` is not a whole number, and the param `{old.name}` is an int"
        return Diagnostic("TLT0307", title, (), f"write a whole number, e.g. `{old.name}={number_text(old.value)}`")
    return replace(old, value=parsed[0])
