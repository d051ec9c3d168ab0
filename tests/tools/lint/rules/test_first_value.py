"""TLT0488: rules about an event that compare with the value at the event before."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text

BEFORE = f"clock 1 Hz\n{RANGES}"


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        (
            "keep begins a implies x >= previous(value_at(x, begins a)) + 0.5",
            "write `keep begins a and previously once a implies x >= previous(value_at(x, begins a)) + 0.5`",
        ),
        (
            "keep a and b implies (c and x > previous(value_at(x, a)))",
            "add `and previously once a` to that condition",
        ),
        (
            "keep ends a implies x > previous(value_at(x, ends a))",
            "write `keep ends a and previously once ends a implies x > previous(value_at(x, ends a))`",
        ),
    ],
)
def test_a_comparison_with_the_event_before_gets_a_note(clause: str, offered: str) -> None:
    (note,) = (
        item.diagnostic for item in findings_in(block(clause, before=BEFORE)) if item.diagnostic.code == "TLT0488"
    )
    assert note.severity == "note"
    assert offered in (note.help or "")


def test_the_offered_rule_leaves_the_first_event_free() -> None:
    verdicts = []
    for condition in ("begins a", "begins a and previously once a"):
        text = f"keep {condition} implies x >= previous(value_at(x, begins a)) + 3"
        (fspa,) = compile_text(f"signal a: bool\nsignal x in [0, 9]\nspec s {{ {text} }}")
        monitor = Monitor(fspa)
        verdicts.append([monitor.step({"a": a, "x": x}).verdict for a, x in ((0, 0), (1, 2), (0, 2), (1, 4))])
    assert verdicts == [["holding", *["violated"] * 3], [*["holding"] * 3, "violated"]]


@pytest.mark.parametrize(
    "clause",
    [
        "keep begins a and previously once a implies x >= previous(value_at(x, begins a)) + 0.5",
        "keep begins a implies x >= value_at(x, begins b)",
        "keep begins a implies x >= previous(value_at(x, begins b))",
        "keep b implies x >= previous(x) + 0.5",
    ],
)
def test_other_rules_get_none(clause: str) -> None:
    assert "TLT0488" not in codes(block(clause, before=BEFORE))
