"""Formulas that differ only in counts of steps are printed as one text, with ranges."""

from __future__ import annotations

import pytest

from tests.unfolded import unfolded
from tltlc import compile_text
from tltlc.logic.formula import Formula
from tltlc.logic.text.counts import CountPrinter, foreign_range_text, range_text
from tltlc.logic.text.printer import ascii_text, english_text


def formula(text: str) -> Formula:
    with unfolded():
        (fspa,) = compile_text(f"clock 1 Hz signal p: bool signal p2: bool signal p3: bool spec s = {text}")
    assert isinstance(fspa.formula, Formula)
    return fspa.formula


def english(formula: Formula, counts: CountPrinter) -> str:
    return english_text(formula, counts=counts)


@pytest.mark.parametrize(
    ("first", "last", "ascii", "in_english"),
    [
        ("F[0,39] p", "F[0,2] p", "F[0,39…2] p", "Reach p within 39…2 steps."),
        ("F[0,39] p", "F[0,39] p", "F[0,39] p", "Reach p within 39 steps."),
        ("F[0,9] p", "F[0,1] p", None, "Reach p within 9…1 steps."),
        ("F[0,1] p", "F[0,1] p", "p | X p", "Reach p within 1 step."),
        ("G[0,9] p2 & F p", "G[0,2] p2 & F p", "G[0,9…2] p2 & F p", "Keep p2 for 10…3 steps, and reach p."),
        (
            "F[0,9] p | G[0,4] p2",
            "F[0,5] p | G[0,4] p2",
            "F[0,9…5] p | G[0,4] p2",
            "Either reach p within 9…5 steps or keep p2 for 5 steps.",
        ),
        ("X X X X X p", "X X p", None, "Have p after 5…2 steps."),
        ("X X p", "X p", None, None),
        ("F[0,9] p2", "F[0,5] p3", None, None),
        ("F p2", "F p3", None, None),
    ],
)
def test_counts_that_differ_become_ranges(first: str, last: str, ascii: str | None, in_english: str | None) -> None:  # noqa: A002
    formulas = formula(first), formula(last)
    assert range_text(*formulas, ascii_text) == ascii
    assert range_text(*formulas, english) == in_english


@pytest.mark.parametrize(
    ("first", "last", "text"),
    [
        ("wait 6", "wait 2", "wait 6…2"),
        ("wait 6", "wait 6", "wait 6"),
        ("2 of 9 keys", "2 of 10 keys", "2 of 9…10 keys"),
        ("1", "12", "1…12"),
        ("wait 6", "go 6", None),
        ("wait 6", "wait", None),
    ],
)
def test_numbers_that_differ_in_other_texts_become_ranges(first: str, last: str, text: str | None) -> None:
    assert foreign_range_text(first, last) == text
