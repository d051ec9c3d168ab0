"""The forms of the language for phrases in plain English, such as `a while b` and `a within 20 steps`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.grammar.keywords import CONDITIONS

Forms = Mapping[str, str]
"""Maps the keyword of a clause to the text by which an English phrase is written in this clause.

The key "" is for all other clauses. ``{a}``, ``{b}`` and ``{c}`` are parts of the phrase. A text
that begins with a keyword replaces the whole clause.
"""

CONDITION: Final = {"reach": "{a} and {b}", "avoid": "{a} and {b}", "": "{b} implies {a}"}
SEQUENCE: Final = {"": "{a} then {b}"}
FORMS: Final[dict[str, Forms]] = {
    **dict.fromkeys((*CONDITIONS, "during"), CONDITION),
    # Use the weak operators: a `keep` or `avoid` must not turn into a goal.
    "before": {
        "keep": "require {a} weak_until {b}",
        "avoid": "require (not {a}) weak_until {b}",
        **SEQUENCE,
    },
    "after": {
        "keep": "{b} implies always {a}",
        "avoid": "require always ({b} implies always not {a})",
        "": "{b} then {a}",
    },
    "followed": {"keep": "{a} implies next eventually {b}", **SEQUENCE},
    "unless": {"reach": "{a} or {b}", "keep": "{a} or {b}", "avoid": "{a} and not {b}", "": "{a} weak_until {b}"},
    "without": {"": "{a} and not {b}"},
    "but": {"": "{a} and {b}"},
    "xor": {"": "not ({a} iff {b})"},
    "xnor": {"": "{a} iff {b}"},
    "nor": {"": "not ({a} or {b})"},
    "nand": {"": "not ({a} and {b})"},
}
"""Maps an English WORD to the ways to write `a WORD b` in the language."""

IN_TIME: Final = {
    "reach": "require eventually within {b} {a}",
    "avoid": "require not eventually within {b} {a}",
    "then": "{c} and F[1,{end}] {a}",
    "": "eventually within {b} {a}",
}
FOR_TIME: Final = {
    # After the end of a trace, `always for` requires nothing: one step would satisfy it.
    "reach": "(always for {b} {a}) and next after {less} {a}",
    "keep": "require always for {b} {a}",
    "avoid": "require always for {b} not {a}",
    "then": "{c} then (always for {b} {a}) and next after {less} {a}",
    "": "always for {b} {a}",
}
AFTER_TIME: Final = {
    "reach": "require next after {b} eventually {a}",
    "keep": "require weak_next after {b} always {a}",
    "avoid": "require weak_next after {b} always not {a}",
    "then": "{c} and next after {b} eventually {a}",
    "": "next after {b} {a}",
}
TIMES: Final[dict[str, Forms]] = {
    **dict.fromkeys(("within", "in", "before", "by"), IN_TIME),
    "for": FOR_TIME,
    "after": AFTER_TIME,
}
"""Maps an English WORD to the ways to write `a WORD TIME` and `WORD TIME a` in the language.

``{b}`` is the time, ``{end}`` the time as the end of a bound in brackets, and ``{less}`` the time
less one step. The key `then` is for `c then a WORD TIME`. If its text joins ``{c}`` by `and`, the
time begins at the step that reaches ``c``.
"""
TIMED: Final = {form for forms in TIMES.values() for form in forms.values()}

_PREFIX: Final = {"reach": "{b} and {a}", "avoid": "{b} and {a}", "": "{b} implies {a}"}
PREFIXES: Final[dict[str, Forms]] = dict.fromkeys(CONDITIONS, _PREFIX)
"""Maps an English WORD to the ways to write `WORD b, a` and `WORD b then a` in the language."""
