"""TLT0465: counts of one event or another, which count events at steps in a row once."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

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


def test_a_count_of_changes_of_a_number_gets_the_time_with_them() -> None:
    before = "clock 10 Hz\nsignal n: int in [0, 9]\n"
    text = block("keep times_within(n > previous(n), 1 s) <= 1", before=before)
    (finding,) = (item.diagnostic for item in findings_in(text) if item.diagnostic.code == "TLT0465")
    offered = "keep total_time_within(n > previous(n), 1 s) / 0.1 s <= 1"
    assert f"write `{offered}`;" in (finding.help or "")
    assert "TLT0465" not in codes(block(offered, before=before))
    assert "TLT0465" not in codes(block("keep times(n > previous(n)) <= 1", before=before))


@pytest.mark.parametrize(
    ("count", "last"),
    [
        ("times_within(n > previous(n), 1 s)", "holding"),
        ("total_time_within(n > previous(n), 1 s) / 0.1 s", "violated"),
    ],
)
def test_the_time_with_changes_counts_those_at_steps_in_a_row(count: str, last: str) -> None:
    (fspa,) = compile_text(f"clock 10 Hz\nsignal n: int in [0, 9]\nspec s {{ keep {count} <= 1 }}")
    for numbers, verdict in (((0, 1, 1), "holding"), ((0, 1, 1, 2), "violated"), ((0, 1, 2), last)):
        monitor = Monitor(fspa)
        assert [monitor.step({"n": n}).verdict for n in numbers][-1] == verdict
