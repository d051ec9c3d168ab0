"""TLT0454: `a since b`, for which a must have held at every step since b."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import RANGES, block, codes, findings_in
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import compile_text


@pytest.mark.parametrize(
    ("clause", "offered"),
    [
        ("keep a implies b since c", "((not c) since b)"),
        ("keep a implies (b since begins c)", "((not (begins c)) since b)"),
        ("let held = b since (a and c)", "((not (a and c)) since b)"),
    ],
)
def test_what_may_be_meant_as_an_event_gets_the_clause_for_once(clause: str, offered: str) -> None:
    text = f"{RANGES}{clause}\nspec s {{ limit 9 steps judge at goal reach held }}"
    text = block(clause, before=RANGES) if clause.startswith("keep") else text
    (finding,) = (item for item in findings_in(text) if item.diagnostic.code == "TLT0454")
    assert (finding.diagnostic.help or "").split("`")[1] == offered


@pytest.mark.parametrize(
    "clause",
    [
        "keep a implies (not b since c)",
        "keep a implies (x > 3 since c)",
        "keep a implies once b",
    ],
)
def test_what_lasts_has_no_finding(clause: str) -> None:
    assert "TLT0454" not in codes(block(clause, before=RANGES))


def test_once_since_then_is_what_is_offered() -> None:
    (fspa,) = compile_text("signal a: bool signal b: bool signal c: bool spec s = G(a -> ((not c) since b))")
    for steps, verdict in (("c.b.a", "holding"), ("bc.a", "violated"), ("b.a", "holding"), (".a", "violated")):
        monitor = Monitor(fspa)
        assert [monitor.step({name: name == step for name in "abc"}).verdict for step in steps][-1] == verdict
