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
    assert help_ == (
        "to count from the event, write `avoid (begins a) then within 1 s (begins a)`, which also forbids `begins a` "
        "at exactly 1 s"
    )
    (counted,) = compile_text(f"{SIGNALS}spec s {{ avoid (begins a) then within 1 s (begins a) }}")
    (behind_next,) = compile_text(f"{SIGNALS}spec s {{ keep begins a implies weak_next always for 1 s not begins a }}")
    play = [(0.0, True), (0.5, False), (0.75, True)]
    verdicts = []
    for fspa in (counted, behind_next):
        monitor = Monitor(fspa)
        verdicts.append([monitor.step({"a": a}, dt).verdict for dt, a in play][-1])
    assert verdicts == ["holding", "violated"]


def test_the_help_says_what_its_clause_changes() -> None:
    (help_,) = helps("keep a implies next always for 2 s not b")
    assert help_ is not None
    assert help_.endswith("which also forbids `b` at exactly 2 s, and asks for no step after `a`")
    (counted,) = compile_text(f"{SIGNALS}spec s {{ avoid (a) then within 2 s (b) }}")
    (behind_next,) = compile_text(f"{SIGNALS}spec s {{ keep a implies next always for 2 s not b }}")
    plays = {
        "b at exactly 2 s": [(0.0, True, False), (0.0, False, False), (2.0, False, True)],
        "an end at a": [(0.0, True, False)],
    }
    accepted: dict[str, list[bool]] = {}
    for name, play in plays.items():
        for fspa in (counted, behind_next):
            monitor = Monitor(fspa)
            accepting = [monitor.step({"a": a, "b": b}, dt).accepting for dt, a, b in play]
            accepted.setdefault(name, []).append(accepting[-1])
    assert accepted == {"b at exactly 2 s": [False, True], "an end at a": [True, False]}


@pytest.mark.parametrize(
    ("clause", "help_"),
    [
        ("keep a implies next eventually within 2 s b", "event, leave out `next`: then that step counts, too"),
        ("keep a implies weak_next always for 2 s b", "event, leave out `weak_next`: then that step counts, too"),
        ("require always next always for 2 s b", "step before, leave out `next`: then that step counts, too"),
    ],
)
def test_other_times_get_another_help(clause: str, help_: str) -> None:
    assert helps(clause) == [f"to count from the {help_}"]


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
