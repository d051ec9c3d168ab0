"""TLT0465: counts of one event or another, which count events at steps in a row once."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in

BEFORE = f"clock 1 Hz\n{SIGNALS}"


@pytest.mark.parametrize(
    ("count", "sum_of_counts"),
    [
        ("times(begins a or ends a)", "times(begins a) + times(ends a)"),
        ("times_within((begins a) or ends b, 3 s)", "times_within(begins a, 3 s) + times_within(ends b, 3 s)"),
        (
            "times((begins a or ends b) and not c and (a or b))",
            "times(begins a and not c and (a or b)) + times(ends b and not c and (a or b))",
        ),
        ("times_since(begins a or begins b, c)", "times_since(begins a, c) + times_since(begins b, c)"),
    ],
)
def test_a_count_of_one_event_or_another_gets_a_finding(count: str, sum_of_counts: str) -> None:
    text = block(f"keep {count} <= 2", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0465")
    assert finding.severity == "note"
    assert f"write `keep {sum_of_counts} <= 2`;" in (finding.help or "")
    assert "TLT0465" not in codes(block(f"keep {sum_of_counts} <= 2", before=BEFORE))


def test_a_count_in_arithmetic_gets_its_sum_in_brackets() -> None:
    text = block("keep 2 * times(begins a or ends a, 9) <= 4", before=BEFORE)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0465")
    assert "write `(times(begins a, 9) + times(ends a, 9))`, with a maximum in each" in (finding.help or "")


@pytest.mark.parametrize(
    "count",
    [
        "times(a or b)",
        "times(begins a)",
        "times(begins a or b)",
        "times(begins a and ends b)",
        "times((begins a or b) and c)",
    ],
)
def test_other_counts_get_none(count: str) -> None:
    assert "TLT0465" not in codes(block(f"keep {count} <= 2", before=BEFORE))
