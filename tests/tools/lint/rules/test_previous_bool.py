"""TLT0452: `previous` of a bool."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep previous(a) implies x > 3", "keep previously a implies x > 3"),
        ("keep b implies not previous(a)", "keep b implies not previously a"),
    ],
)
def test_a_previous_bool_gets_the_operator_that_is_false_at_the_first_step(clause: str, offered: str) -> None:
    (finding,) = (item for item in findings_in(block(clause, before=RANGES)) if item.diagnostic.code == "TLT0452")
    label = finding.diagnostic.labels[0]
    written = (finding.diagnostic.help or "").split("`")[1]
    assert clause.replace(label.source.slice(label.span), written) == offered
    assert "TLT0452" not in codes(block(offered, before=RANGES))


def test_the_two_differ_at_the_first_step_alone() -> None:
    verdicts = []
    for text in ("previous(a)", "previously a"):
        (fspa,) = compile_text(f"signal a: bool spec s = G !({text})")
        for trace in ((True, False), (False, True, False)):
            monitor = Monitor(fspa)
            verdicts.append([monitor.step({"a": value}).verdict for value in trace])
    assert verdicts == [
        ["violated", "violated"],
        ["holding", "holding", "violated"],
        ["holding", "violated"],
        ["holding", "holding", "violated"],
    ]


@pytest.mark.parametrize("clause", ["keep previously a implies b", "keep x >= previous(x)"])
def test_other_memories_have_no_finding(clause: str) -> None:
    assert "TLT0452" not in codes(block(clause, before=RANGES))
