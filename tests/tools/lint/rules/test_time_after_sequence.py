"""TLT0447: times that count from the beginning of a sequence."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in, labelled_texts_in_block
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import compile_text
from tltlc.tools.diff.relation import compare

BEFORE = f"clock 10 Hz\n{SIGNALS}signal d: bool\n"


def meant(text: str) -> str:
    """Return the clause that the help of the only finding names for the last event."""
    (finding,) = (found for found in findings_in(text) if found.diagnostic.code == "TLT0447")
    quoted: list[str] = re.findall("`([^`]*)`", finding.diagnostic.help or "")
    return quoted[1]


@pytest.mark.parametrize(
    ("clause", "offered", "forbidden"),
    [
        (
            "keep (a then within 0.3 s b) implies eventually within 0.2 s c",
            "keep b and previously once within 0.2 s a implies eventually within 0.2 s c",
            "a then within 0.3 s (b and not eventually within 0.2 s c)",
        ),
        (
            "keep (a then within 3 steps b) implies always for 2 steps c",
            "keep b and previously once within 2 steps a implies always for 2 steps c",
            "a then within 3 steps (b and not always for 2 steps c)",
        ),
        (
            "keep (a then within 250 ms b) implies not eventually within 0.2 s c",
            "keep b and previously once within 200 ms a implies not eventually within 0.2 s c",
            "a then within 3 steps (b and eventually within 0.2 s c)",
        ),
        (
            "keep (a then b) implies (eventually within 2 steps c)",
            "keep b and previously once a implies eventually within 2 steps c",
            "a then (b and not eventually within 2 steps c)",
        ),
        (
            "keep (a then within 1 step b) implies eventually within 2 steps c",
            "keep b and previously a implies eventually within 2 steps c",
            "a then within 1 step (b and not eventually within 2 steps c)",
        ),
        (
            "keep (a then within 2 steps (b or c) then d) implies eventually within 2 steps c",
            "keep d and previously once ((b or c) and previously once within 1 step a) implies "
            "eventually within 2 steps c",
            "a then within 2 steps (b or c) then (d and not eventually within 2 steps c)",
        ),
        (
            "require always ((a then b) implies eventually within 2 steps c)",
            "require always (b and previously once a implies eventually within 2 steps c)",
            "a then (b and not eventually within 2 steps c)",
        ),
    ],
)
def test_the_offered_clause_counts_from_the_last_event(clause: str, offered: str, forbidden: str) -> None:
    assert meant(block(clause, before=BEFORE)) == offered
    assert set(codes(block(offered, before=BEFORE))) <= {"TLT0421"}
    texts = (clause, offered, f"require always not ({forbidden})")
    typed, counted, same = (compile_text(block(text, before=BEFORE))[0] for text in texts)
    assert compare(counted, same).relation == "equivalent"
    assert compare(counted, typed).relation == "incomparable"


def test_in_a_formula_only_the_formula_is_offered() -> None:
    rule = "(a then b) implies eventually within 2 steps c"
    assert meant(f"{SIGNALS}spec s = always ({rule})") == (
        "always (b and previously once a implies eventually within 2 steps c)"
    )
    assert meant(block(f"keep ({rule}) and (c implies a)")) == (
        "b and previously once a implies eventually within 2 steps c"
    )


def test_a_clock_that_varies_allows_no_such_rule() -> None:
    clause = "keep (a then b) implies eventually within 2 s c"
    with pytest.raises(TltlError, match="TLT0323"):
        codes(block(clause, before=f"clock varies\n{SIGNALS}"))


def test_a_comment_allows_it_and_brackets_do_not() -> None:
    clause = "keep ((a then b) implies (eventually within 2 s c))"
    assert labelled_texts_in_block("TLT0447", clause, before=BEFORE) == ["within 2 s"]
    assert labelled_texts_in_block("TLT0447", f"{clause}  // tltlc: allow TLT0447", before=BEFORE) == []


@pytest.mark.parametrize(
    "clause",
    [
        "keep (a then b) implies eventually c",
        "keep a implies (b then within 2 s c)",
        "keep (a then (next b)) implies eventually within 2 s c",
        "keep a and b implies eventually within 2 s c",
        "require (a then b) implies eventually within 2 s c",
        "avoid a then within 2 s b",
    ],
)
def test_other_rules_are_left_out(clause: str) -> None:
    assert labelled_texts_in_block("TLT0447", clause, before=BEFORE) == []
