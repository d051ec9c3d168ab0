"""TLT0455: `avoid a then b`, which allows b at the very step of a."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import APART, RANGES, SIGNALS, accepted_traces, block, codes, findings_in
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.tools.lint.rules import same_step

CLOCK = f"clock 1 Hz\n{RANGES}signal mode: (idle, alert, chase)\n"


def notes(text: str) -> list[Diagnostic]:
    return [finding.diagnostic for finding in findings_in(text) if finding.diagnostic.code == "TLT0455"]


@pytest.mark.parametrize(
    ("clause", "offered", "both"),
    [
        ("avoid a then b", "avoid b and once a", "avoid a and b"),
        ("avoid ((a) then ((b)))", "avoid b and once a", "avoid a and b"),
        ("avoid a then within 2 s b", "avoid b and once within 2 s a", "avoid a and b"),
        ("avoid a then within 1 step b", "avoid b and once within 1 step a", "avoid a and b"),
        ("avoid (begins a) then within 2 s b", "avoid b and once within 2 s begins a", "avoid (begins a) and b"),
        ("avoid (not a) then b", "avoid b and once not a", "avoid b and not a"),
    ],
)
def test_the_offered_clause_also_forbids_both_at_one_step(clause: str, offered: str, both: str) -> None:
    before = "clock 1 Hz\nsignal a: bool signal b: bool\n"
    (note,) = notes(block(clause, before=before))
    assert (note.help or "").split("`")[1] == offered
    assert "TLT0455" not in codes(block(offered, before=before))
    later, together, inclusive = (
        accepted_traces(block(text, before=before), "ab", 4) for text in (clause, both, offered)
    )
    assert later & together == inclusive < later


def test_an_offered_condition_has_brackets_where_it_needs_them() -> None:
    (note,) = notes(block("avoid (a or b) then within 2 s (c and not b)", before=CLOCK))
    assert (note.help or "").split("`")[1] == "avoid (c and not b) and once within 2 s (a or b)"


def test_the_note_names_both_conditions() -> None:
    (note,) = notes(block("avoid a then b"))
    assert (note.severity, note.title) == ("note", "`then` means a later step")
    assert note.labels[0].message == "so `b` at the very step of `a` is allowed"
    assert note.help == (
        "to forbid it at that step, too, write `avoid b and once a`; "
        "if only later steps count, allow it with the comment `// tltlc: allow TLT0455`"
    )


@pytest.mark.parametrize(
    "clause",
    ["avoid x > 5 then within 3 s y > 6", "avoid a then x > 5", "avoid a then mode is chase", "avoid a\n then  b"],
)
def test_conditions_that_may_hold_together_get_a_note(clause: str) -> None:
    (note,) = notes(block(clause, before=CLOCK))
    assert "TLT0455" not in codes(block((note.help or "").split("`")[1], before=CLOCK))


@pytest.mark.parametrize(
    "clauses",
    [
        # The two never hold together.
        ("avoid a then not a",),
        ("avoid x > 5 then x < 3",),
        ("avoid mode is alert then mode is chase",),
        ("avoid (begins a) then (ends a)",),
        # Another clause forbids both at one step.
        ("avoid a then b", "avoid a and b"),
        ("avoid a then b", "keep a implies not b"),
        # One of them includes the other.
        ("avoid a then within 3 s a",),
        ("avoid (begins a) then within 3 s (begins a)",),
        ("avoid a then (begins a)",),
        ("avoid (begins a) then a",),
        ("avoid x > 5 then x > 6",),
        ("avoid a then (a and b)",),
        # Other clauses and sequences.
        ("reach a then b",),
        ("avoid a and next b",),
        ("avoid a then b then c",),
        ("avoid a then (next b)",),
        ("keep a implies (b then c)",),
        ("avoid a then b  // tltlc: allow TLT0455",),
    ],
)
def test_other_clauses_get_no_note(clauses: tuple[str, ...]) -> None:
    assert notes(block(*clauses, before=CLOCK)) == []


def test_exclusive_atoms_never_hold_together() -> None:
    assert notes(block("avoid at(x) then at(y)", before=APART)) == []
    assert len(notes(block("avoid at(x) then at(z)", before=APART))) == 1


def test_many_clauses_are_not_asked() -> None:
    rules = [f"avoid c and x > {count / 10}" for count in range(same_step._MOST_PARTS)]
    assert len(notes(block("avoid a then b", "avoid a and b", *rules, before=CLOCK))) == 1


def test_a_clock_that_varies_has_the_same_clause() -> None:
    before = f"clock varies\n{SIGNALS}"
    (note,) = notes(block("avoid a then within 3 s b", before=before))
    assert (note.help or "").split("`")[1] == "avoid b and once within 3 s a"
    assert "TLT0455" not in codes(block("avoid b and once within 3 s a", before=before))
