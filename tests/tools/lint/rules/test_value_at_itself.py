"""TLT0490: rules about an event that compare a number with its value at another event."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import SIGNALS, block, codes, findings_in
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text

BEFORE = f"{SIGNALS}signal n: int in [0, 9]\nsignal m: int in [0, 9]\n"


@pytest.mark.parametrize(
    ("clause", "call", "offered"),
    [
        (
            "keep ends a implies n == value_at(n, begins b)",
            "value_at(n, begins b)",
            "value_at(n, begins b and not ends a)",
        ),
        (
            "keep begins a and c implies n >= value_at(n, ends b) + 2",
            "value_at(n, ends b)",
            "value_at(n, ends b and not begins a)",
        ),
        (
            "keep ends a implies (c or n <= value_at(n, (begins b)))",
            "value_at(n, (begins b))",
            "value_at(n, begins b and not ends a)",
        ),
    ],
)
def test_a_value_at_another_event_gets_a_note_whose_help_gets_none(clause: str, call: str, offered: str) -> None:
    (note,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0490"
    )
    assert note.severity == "note" and f"write `{offered}`" in (note.help or "")
    assert note.labels[0].source.slice(note.labels[0].span) == call
    assert "TLT0490" not in codes(block(clause.replace(call, offered), before=BEFORE))


def test_the_offered_value_is_that_of_an_earlier_step() -> None:
    trace = [{"a": 0, "b": 1, "n": 5}, {"a": 1, "b": 0, "n": 8}, {"a": 0, "b": 1, "n": 8}]
    verdicts = []
    for event in ("begins b", "begins b and not ends a"):
        (fspa,) = compile_text(block(f"keep ends a implies n == value_at(n, {event})", before=BEFORE))
        monitor = Monitor(fspa)
        verdicts.append([monitor.step(sample).verdict for sample in trace][-1])
    assert verdicts == ["holding", "violated"]


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies n == value_at(n, begins b)",
        "keep ends a implies n == value_at(n, begins a)",
        "keep ends a implies m == value_at(n, begins b)",
        "keep ends a implies previous(n) == value_at(n, begins b)",
        "keep ends a implies n == value_at(n, begins b and not a)",
        "keep ends a implies eventually n == value_at(n, begins b)",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0490" not in codes(block(clause, before=BEFORE))
