"""TLT0451: counts before `since`, which begin at the first step."""

from __future__ import annotations

import re

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.pipeline import compile_text
from tltlc.tools.diff.relation import compare

BEFORE = f"clock 10 Hz\n{RANGES}"


@pytest.mark.parametrize(
    ("clause", "count", "as_read"),
    [
        ("keep times(a) <= 3 since b", "keep times_since(a, b) <= 3", "keep (times(a) <= 3) since b"),
        (
            "keep total_time(a) <= 3 s since b",
            "keep total_time_since(a, b) <= 3 s",
            "keep (total_time(a) <= 3 s) since b",
        ),
        ("keep highest(x) < 3 since b", "keep highest_since(x, b) < 3", "keep (highest(x) < 3) since b"),
        (
            "keep c implies times(a and b) == 0 since begins c",
            "keep c implies times_since(a and b, begins c) == 0",
            "keep c implies (times(a and b) == 0) since begins c",
        ),
    ],
)
def test_a_count_before_since_gets_a_count_since_the_event(clause: str, count: str, as_read: str) -> None:
    (finding,) = (item for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0451")
    label = finding.diagnostic.labels[0]
    marked = label.source.slice(label.span)
    quoted = re.findall("`([^`]*)`", finding.diagnostic.help or "")
    assert [clause.replace(marked, quoted[0]), clause.replace(marked, quoted[2])] == [count, as_read]
    assert "TLT0451" not in codes(block(count, before=BEFORE)) + codes(block(as_read, before=BEFORE))
    (typed,), (read,) = (compile_text(block(text, before=BEFORE)) for text in (clause, as_read))
    assert compare(typed, read).relation == "equivalent"


@pytest.mark.parametrize("clause", ["keep (times(a) <= 3) since b", "keep a since times(b) > 2", "keep times(a) <= 3"])
def test_other_counts_have_no_finding(clause: str) -> None:
    assert "TLT0451" not in codes(block(clause, before=BEFORE))
