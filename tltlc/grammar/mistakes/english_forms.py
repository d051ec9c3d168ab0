"""Tables of English phrases, such as `a while b`, and how to write them in the language."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.grammar.keywords import CONDITIONS


@record
class Form:
    """A way to write an English phrase in the language: ``{b} implies {a}`` for ``a if b``.

    In ``formula``, ``{a}``, ``{b}`` and ``{c}`` stand for the parts of the phrase. If ``clause`` is not
    empty, a clause with this keyword must replace the whole clause: ``keep not a before b`` becomes
    ``require not a weak_until b``.
    """

    formula: str
    clause: str = ""


Forms = Mapping[str, Form]
"""Maps the keyword of a clause to the way to write an English phrase in this clause.

The key "" is for all clauses that are not listed.
"""

CONDITION: Final = {"reach": Form("{a} and {b}"), "avoid": Form("{a} and {b}"), "": Form("{b} implies {a}")}
SEQUENCE: Final = {"": Form("{a} then {b}")}
REVERSED_SEQUENCE: Final = {"": Form("{b} then {a}")}
KEPT_BEFORE: Final = Form("{a} weak_until {b}", "require")
"""How to write `keep a before b` if it asks for `a` at every step until `b`."""
FORMS: Final[dict[str, Forms]] = {
    **dict.fromkeys((*CONDITIONS, "during"), CONDITION),
    # Use the weak operators: a `keep` or `avoid` must not turn into a goal.
    "before": {
        "keep": KEPT_BEFORE,
        "avoid": Form("(not {a}) weak_until {b}", "require"),
        **SEQUENCE,
    },
    "after": {
        "keep": Form("{b} implies always {a}"),
        "avoid": Form("always ({b} implies always not {a})", "require"),
        **REVERSED_SEQUENCE,
    },
    "followed": {"keep": Form("{a} implies next eventually {b}"), **SEQUENCE},
    "unless": {
        "reach": Form("{a} or {b}"),
        "keep": Form("{a} or {b}"),
        "avoid": Form("{a} and not {b}"),
        "": Form("{a} weak_until {b}"),
    },
    "without": {"": Form("{a} and not {b}")},
    "but": {"": Form("{a} and {b}")},
    "xor": {"": Form("not ({a} iff {b})")},
    "xnor": {"": Form("{a} iff {b}")},
    "nor": {"": Form("not ({a} or {b})")},
    "nand": {"": Form("not ({a} and {b})")},
}
"""Maps an English WORD to the ways to write `a WORD b` in the language."""

IN_TIME: Final = {
    "reach": Form("eventually within {b} {a}", "require"),
    "avoid": Form("not eventually within {b} {a}", "require"),
    "then": Form("{c} then within {b} {a}"),
    "": Form("eventually within {b} {a}"),
}
PAST_TIME: Final = {
    ("ONCE", "within"): Form("once within {b} {a}"),
    ("ONCE", "in"): Form("once within {b} {a}"),
    ("HISTORICALLY", "for"): Form("historically for {b} {a}"),
}
"""How to write `once a within TIME` and `historically a for TIME`, by the terminal and the word."""
FOR_TIME: Final = {
    # After the end of a trace, `always for` requires nothing: one step would satisfy it.
    "reach": Form("(always for {b} {a}) and next after {less} {a}"),
    "keep": Form("always for {b} {a}", "require"),
    "avoid": Form("always for {b} not {a}", "require"),
    "then": Form("{c} then (always for {b} {a}) and next after {less} {a}"),
    "": Form("always for {b} {a}"),
}
HOLDING: Final = Form("time_holding({a}) >= {b}")
"""How to write ``reach a for 3 s``. Steps need another form, because this time is in seconds."""
AFTER_TIME: Final = {
    "reach": Form("next after {b} eventually {a}", "require"),
    "keep": Form("weak_next after {b} always {a}", "require"),
    "avoid": Form("weak_next after {b} always not {a}", "require"),
    "then": Form("{c} and next after {b} eventually {a}"),
    "": Form("next after {b} {a}"),
}
TIMES: Final[dict[str, Forms]] = {
    **dict.fromkeys(("within", "in", "before", "by"), IN_TIME),
    "for": FOR_TIME,
    "after": AFTER_TIME,
}
"""Maps an English WORD to the ways to write `a WORD TIME` and `WORD TIME a` in the language.

``{b}`` is the time, ``{end}`` the time as the end of a bound in brackets, and ``{less}`` the time
minus one step. The key `then` is for `c then a WORD TIME`. There, ``{c} and …`` makes the time begin
at the step that reaches ``c``.
"""
TIMED: Final = {HOLDING, *(form for forms in TIMES.values() for form in forms.values()), *PAST_TIME.values()}

_PREFIX: Final = {"reach": Form("{b} and {a}"), "avoid": Form("{b} and {a}"), "": Form("{b} implies {a}")}
PREFIXES: Final[dict[str, Forms]] = dict.fromkeys(CONDITIONS, _PREFIX)
"""Maps an English WORD to the ways to write `WORD b, a` and `WORD b then a` in the language."""
