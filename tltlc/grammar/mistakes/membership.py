"""Explain ranges and lists in conditions: `soil in [40, 60]`, `mode in {idle, alert}`, `level not in [3, 5]`."""

from __future__ import annotations

from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.equalities import value_end
from tltlc.grammar.mistakes.parse_failure import CLOSING, OPENING, ParseFailure
from tltlc.grammar.mistakes.rephrasing import formula_start, formula_stop, suggest_rewrite, text_of

_TITLE: Final = "`in` stands in declarations, and in no condition"


def membership(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if parsing failed at a condition such as ``x in [40, 60]``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    is_negated = failure.token.text == "not" and tokens[at + 1].text == "in"
    opening = at + 1 + is_negated
    if failure.token.text != "in" and not is_negated:
        return None
    if failure.start != "clause" or tokens[opening].type not in OPENING:
        return None
    start, members = value_end(tokens, at, -1), _members(failure, opening)
    if start == at or members is None:
        return None
    parts, stop = members
    name = text_of(failure, start, at)
    declared = declared_names(failure.source).names.get(tokens[start].text)
    if declared is not None and declared.type == "enum":
        text, is_loose = (
            f" {'and' if is_negated else 'or'} ".join(f"{name} is {'not ' * is_negated}{part}" for part in parts),
            len(parts) > 1,
        )
    elif tokens[opening].text == "[" and len(parts) == 2:
        low, high = parts
        text = f"{name} < {low} or {name} > {high}" if is_negated else f"{name} >= {low} and {name} <= {high}"
        is_loose = True
    elif declared is not None and declared.type == "int":
        text, is_loose = (
            f" {'and' if is_negated else 'or'} ".join(
                f"{name} {'!=' if is_negated else '=='} {part}" for part in parts
            ),
            len(parts) > 1,
        )
    else:
        return None
    is_part = (start, stop) != (formula_start(failure), formula_stop(failure))
    text = f"({text})" if is_loose and is_part else text
    return suggest_rewrite(failure, start, stop, text, _TITLE)


def _members(failure: ParseFailure, opening: int) -> tuple[list[str], int] | None:
    """Return the texts between commas in the brackets that open at an index, and the index after these brackets."""
    tokens, depth, begun = failure.tokens, 0, opening + 1
    parts: list[str] = []
    for index in range(opening, len(tokens)):
        kind = tokens[index].type
        depth += (kind in OPENING) - (kind in CLOSING)
        if depth == 0 or (depth == 1 and kind == "COMMA"):
            parts.append(text_of(failure, begun, index))
            begun = index + 1
        if depth == 0:
            return (parts, index + 1) if all(parts) else None
    return None
