"""TLT0453: counts and values since an event, at the step of the event."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep a implies times_since(b, a) >= 2", "previously (times_since(b, a) >= 2)"),
        ("keep a and c implies times_since(b, a) == 0", "previously (times_since(b, a) == 0)"),
        ("keep begins a implies times_since(b, begins a) < 2", "previously (times_since(b, begins a) < 2)"),
        ("keep begins a implies times_since(b, a) >= 2", "previously (times_since(b, a) >= 2)"),
        ("require always (a implies (c and times_since(b, (a)) > 1))", "previously (times_since(b, (a)) > 1)"),
        ("keep ends a and time_holding(a) < 2 s implies not b", "previously (time_holding(a) < 2 s)"),
        ("keep ends a implies time_holding(a) <= 2 s", "previously (time_holding(a) <= 2 s)"),
        ("keep ends a implies b or time_holding(a) >= 2 s", "previously (time_holding(a) >= 2 s)"),
        ("avoid (ends a) and 2 s > time_holding(a)", "previously (2 s > time_holding(a))"),
        ("keep a implies x > lowest_since(x, a) + 1", "previous(lowest_since(x, a))"),
        ("keep a implies x > value_at(x, a) - 1", "previous(value_at(x, a))"),
    ],
)
def test_a_memory_at_the_step_of_its_event_gets_that_of_the_step_before(clause: str, offered: str) -> None:
    (finding,) = (
        item for item in findings_in(block(clause, before=f"clock 1 Hz\n{RANGES}")) if item.diagnostic.code == "TLT0453"
    )
    assert offered in (finding.diagnostic.help or "")


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies previously (times_since(b, a) >= 2)",
        "keep a implies times_since(b, begins a) >= 2",
        "keep ends a implies times_since(b, a) >= 2",
        "keep a implies x > previous(value_at(x, a))",
        "keep times_since(b, a) <= 2",
        "keep ends a and previously (time_holding(a) < 2 s) implies not b",
        "keep ends a and time_holding(b) < 2 s implies not b",
    ],
)
def test_other_memories_have_no_finding(clause: str) -> None:
    assert "TLT0453" not in codes(block(clause, before=f"clock 1 Hz\n{RANGES}"))


def test_the_count_that_is_offered_is_that_of_the_events_before() -> None:
    verdicts = {}
    for text in ("times_since(b, a) >= 2", "previously (times_since(b, a) >= 2)"):
        (fspa,) = compile_text(f"signal a: bool signal b: bool spec s = G(a -> {text})")
        monitor = Monitor(fspa)
        verdicts[text] = [monitor.step({"a": a, "b": b}).verdict for a, b in ((0, 1), (0, 0), (0, 1), (1, 0))]
    assert [steps[-1] for steps in verdicts.values()] == ["violated", "holding"]
