"""Suggest how to write formulas of logic without a keyword, and equalities at an end of a range."""

from __future__ import annotations

import re
from itertools import pairwise
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Fix, replacement_fix
from tltlc.grammar.keywords import CLAUSES
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.parse_failure import ParseFailure, outer_indices
from tltlc.grammar.mistakes.rephrasing import span_of
from tltlc.grammar.mistakes.sentences.validity import is_valid

_LETTERS: Final = ("U", "W", "R", "M", "F", "G", "X", "N", "[]", "<>")
"""The operators of time as signs of logic, which have no meaning in English."""
_SEVERAL: Final = re.compile("[FGXN]{2,3}")


def logic_fix(failure: ParseFailure) -> Fix | None:
    """Return the fix for a formula such as `!a U b` and `GF a & G !b`, which needs `require` before it; else None."""
    tokens, names = failure.tokens[:-1], declared_names(failure.source).names
    span = span_of(tokens)
    text = failure.source.slice(span)
    first = tokens[0].text
    if _SEVERAL.fullmatch(first) and first not in names:
        text = f"{' '.join(first)}{text[len(first) :]}"
    elif first in CLAUSES or not any(token.text in _LETTERS for token in tokens):
        return None
    if any(tokens[index].type == "IMPLIES" for index in outer_indices(tokens, 0, len(tokens))):
        return None  # of the first step, or of every step
    if "\n" in text or "//" in text or not is_valid((f"require {text}".replace("==", "<="),)):
        return None  # an equality has an error of its own
    fix = replacement_fix(failure.source, span, f"require {text}")
    return replace(fix, title=f"Write `require {text}`")


def equality_fix(failure: ParseFailure) -> Fix | None:
    """Return the fix for `speed == 0` where 0 is an end of the range of a number, which has no equality; else None."""
    names, tokens = declared_names(failure.source).names, failure.tokens[:-1]
    for at, (name, sign) in enumerate(pairwise(tokens)):
        declared = names.get(name.text)
        is_number = declared is not None and declared.type not in ("int", "bool", "enum", "")
        if sign.type != "EQUALS" or declared is None or not is_number or sign is not failure.token:
            continue
        value = " ".join(
            token.text for token in tokens[at + 2 : at + 2 + len(declared.ends[:1] and declared.ends[0].split())]
        )
        if value in declared.ends:
            text = f"{name.text} {'>=' if value == declared.ends[1] else '<='} {value}"
            span = span_of(tokens[at : at + 2 + len(value.split())])
            return replace(replacement_fix(failure.source, span, text), title=f"Write `{text}`")
    return None
