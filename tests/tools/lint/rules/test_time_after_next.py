"""TLT0439: times behind `next` where the clock varies."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import findings_in
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text

SIGNALS = "clock varies\nsignal a: bool\nsignal b: bool\n"


def helps(clause: str, signals: str = SIGNALS) -> list[str | None]:
    text = f"{signals}spec s {{\n    limit 300 steps\n    {clause}\n}}\n"
    diagnostics = (finding.diagnostic for finding in findings_in(text))
    return [diagnostic.help for diagnostic in diagnostics if diagnostic.code == "TLT0439"]


def test_the_help_counts_from_the_event() -> None:
    (help_,) = helps("keep begins a implies weak_next always for 1 s not begins a")
    assert help_ == "to count from the event, write `avoid (begins a) then within 1 s (begins a)`"
    (counted,) = compile_text(f"{SIGNALS}spec s {{ avoid (begins a) then within 1 s (begins a) }}")
    (behind_next,) = compile_text(f"{SIGNALS}spec s {{ keep begins a implies weak_next always for 1 s not begins a }}")
    play = [(0.0, True), (0.5, False), (0.75, True)]
    verdicts = []
    for fspa in (counted, behind_next):
        monitor = Monitor(fspa)
        verdicts.append([monitor.step({"a": a}, dt).verdict for dt, a in play][-1])
    assert verdicts == ["holding", "violated"]


@pytest.mark.parametrize(
    "clause", ["keep a implies next eventually within 2 s b", "keep a implies (next (always for 2 s b))"]
)
def test_a_time_behind_next_is_reported(clause: str) -> None:
    assert len(helps(clause)) == 1


@pytest.mark.parametrize(
    ("clause", "signals"),
    [
        ("keep a implies next eventually within 2 s b", SIGNALS.replace("varies", "60 Hz")),
        ("keep a implies eventually within 2 s b", SIGNALS),
        ("reach a then within 2 s b", SIGNALS),
        ("keep a implies next b", SIGNALS),
    ],
)
def test_other_times_are_not_reported(clause: str, signals: str) -> None:
    assert helps(clause, signals) == []
