"""TLT0446: words that apply to less than they seem to."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in, labelled_texts, labelled_texts_in_block
from tltlc.pipeline import compile_text
from tltlc.tools.diff.relation import compare

BEFORE = f"clock 10 Hz\n{RANGES}"


def readings(clause: str) -> list[str]:
    """Return the two readings that the help names, each as the clause to write."""
    (finding,) = (found for found in findings_in(block(clause, before=BEFORE)) if found.diagnostic.code == "TLT0446")
    label = finding.diagnostic.labels[0]
    marked = label.source.slice(label.span)
    return [clause.replace(marked, reading) for reading in re.findall("`([^`]*)`", finding.diagnostic.help or "")]


@pytest.mark.parametrize(
    ("clause", "wide", "narrow"),
    [
        (
            "keep a implies eventually within 6 s b or c",
            "keep a implies eventually within 6 s (b or c)",
            "keep a implies (eventually within 6 s b) or c",
        ),
        (
            "keep a implies eventually within 6 s b or (c until b)",
            "keep a implies eventually within 6 s (b or (c until b))",
            "keep a implies (eventually within 6 s b) or (c until b)",
        ),
        ("keep once a since b", "keep once (a since b)", "keep (once a) since b"),
        ("keep once (a or c) since b", "keep once ((a or c) since b)", "keep (once (a or c)) since b"),
        ("require always a until b", "require always (a until b)", "require (always a) until b"),
        (
            "keep a implies historically for 1 s b or c",
            "keep a implies historically for 1 s (b or c)",
            "keep a implies (historically for 1 s b) or c",
        ),
        ("keep c or eventually a or b", "keep c or eventually (a or b)", "keep c or (eventually a) or b"),
        (
            "keep a implies always b or not c",
            "keep a implies always (b or not c)",
            "keep a implies (always b) or not c",
        ),
        (
            "keep a implies eventually b and c and x > 3",
            "keep a implies eventually (b and c and x > 3)",
            "keep a implies (eventually b) and c and x > 3",
        ),
        (
            "keep a implies b weak_until c or x > 3",
            "keep a implies b weak_until (c or x > 3)",
            "keep a implies (b weak_until c) or x > 3",
        ),
        (
            "keep a implies b and c until x > 3",
            "keep a implies (b and c) until x > 3",
            "keep a implies b and (c until x > 3)",
        ),
        (
            "keep a implies previously b or c",
            "keep a implies previously (b or c)",
            "keep a implies (previously b) or c",
        ),
        ("keep b since c or a", "keep b since (c or a)", "keep (b since c) or a"),
        (
            "keep a implies eventually b or begins c",
            "keep a implies eventually (b or begins c)",
            "keep a implies (eventually b) or begins c",
        ),
    ],
)
def test_the_help_names_both_readings_with_brackets(clause: str, wide: str, narrow: str) -> None:
    assert readings(clause)[-2:] == [wide, narrow]
    typed, whole, part = (compile_text(block(text, before=BEFORE))[0] for text in (clause, wide, narrow))
    assert compare(typed, part).relation == "equivalent"
    assert compare(typed, whole).relation != "equivalent"
    assert "TLT0446" not in codes(block(wide, narrow, before=BEFORE))


@pytest.mark.parametrize(
    ("clause", "until", "wide", "narrow"),
    [
        (
            "keep c implies always not a until ends b",
            "keep c implies not a until ends b",
            "keep c implies always (not a until ends b)",
            "keep c implies (always not a) until ends b",
        ),
        ("require always a until b", "require a until b", "require always (a until b)", "require (always a) until b"),
        (
            "keep c implies always (a) weak_until b",
            "keep c implies a weak_until b",
            "keep c implies always ((a) weak_until b)",
            "keep c implies (always (a)) weak_until b",
        ),
        (
            "keep c implies always (a and x > 3) until b",
            "keep c implies (a and x > 3) until b",
            "keep c implies always ((a and x > 3) until b)",
            "keep c implies (always (a and x > 3)) until b",
        ),
        (
            "keep c implies always a until b and x > 3",
            "keep c implies (a until b) and x > 3",
            "keep c implies always (a until b) and x > 3",
            "keep c implies (always a) until b and x > 3",
        ),
    ],
)
def test_always_until_offers_until_first(clause: str, until: str, wide: str, narrow: str) -> None:
    findings = (found.diagnostic for found in findings_in(block(clause, before=BEFORE)))
    (finding,) = (found for found in findings if found.code == "TLT0446" and found.title.startswith("`always`"))
    label, help_ = finding.labels[0], finding.help or ""
    marked = label.source.slice(label.span)
    assert help_.split("`")[2] == " if it must hold up to then, "
    quoted = re.findall("`([^`]*)`", help_)
    assert [clause.replace(marked, reading) for reading in quoted] == [until, wide, narrow]
    texts = (clause, narrow, until)
    typed, part, meant = (compile_text(block(text, before=BEFORE))[0] for text in texts)
    assert compare(typed, part).relation == "equivalent"
    assert compare(typed, meant).relation != "equivalent"
    assert not any(
        found.diagnostic.code == "TLT0446" and found.diagnostic.title.startswith("`always`")
        for found in findings_in(block(until, before=BEFORE))
    )


@pytest.mark.parametrize("clause", ["keep always a until b", "avoid c and not (always a until b)"])
def test_no_until_is_offered_where_it_begins_anew(clause: str) -> None:
    assert len(readings(clause)) == 2
    assert "TLT0446" not in codes(block(clause.replace("always a", "always (a)"), before=BEFORE))


def test_once_and_since_may_mean_that_it_has_come_since_then() -> None:
    assert readings("keep c implies once a since b")[0] == "keep c implies (not b) since a"


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies eventually b and always c",
        "keep a implies eventually b or not once c",
        "keep a implies eventually b or (a until c)",
        "keep a implies F b or c",
        "keep a implies (eventually b) or c",
        "keep a implies eventually (b) or c",
        "keep a implies (eventually b or once c)",
        "keep a or eventually b",
        "keep once a or b",
        "keep once within 1 s a and b",
        "keep always a implies b",
        "keep next a or b",
        "keep a implies always for 1 s not b and true",
    ],
)
def test_brackets_letters_and_operands_with_such_a_word_are_left_out(clause: str) -> None:
    assert labelled_texts_in_block("TLT0446", clause, before=BEFORE) == []


def test_a_long_chain_is_read_once() -> None:
    clause = f"keep {'c or ' * 500}eventually a or b"
    assert labelled_texts_in_block("TLT0446", clause, before=BEFORE) == ["eventually a or b"]


def test_named_formulas_and_specs_without_a_block_are_read_too() -> None:
    text = f"{RANGES}let soon(p) = eventually p or a\nspec s = always soon(b) and c\n"
    assert labelled_texts(text, "TLT0446") == ["eventually p or a"]
    assert labelled_texts(f"{RANGES}spec s = a implies always b and c\n", "TLT0446") == ["always b and c"]


def test_the_first_step_is_the_more_specific_reason() -> None:
    text = block("require eventually a and b", before=RANGES)
    assert "TLT0429" in codes(text) and "TLT0446" not in codes(text)


@pytest.mark.parametrize("clause", ["keep once within 1 s a weak_until b", "require historically a until b"])
def test_no_reading_is_named_in_which_the_past_contains_later_steps(clause: str) -> None:
    (narrow, _) = readings(clause)
    typed, part = (compile_text(block(text, before=BEFORE))[0] for text in (clause, narrow))
    assert compare(typed, part).relation == "equivalent"
    assert "TLT0446" not in codes(block(narrow, before=BEFORE))


@pytest.mark.parametrize(
    "clause",
    ["keep a implies b until (c or x > 3)", "keep a implies (b and c) until x > 3", "keep (b until c) or always a"],
)
def test_brackets_show_how_far_an_infix_word_applies(clause: str) -> None:
    assert "TLT0446" not in codes(block(clause, before=BEFORE))
