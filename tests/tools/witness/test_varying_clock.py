"""On a clock that varies, the traces that tools find and write have the lengths of their steps."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, inside, tltlc

__all__ = ["inside", "tltlc"]

Run = Callable[..., Outcome]

HEAD = "clock varies\nsignal alarm: bool\nsignal hidden: bool\n"
SPECS = (
    "keep alarm implies eventually within 2 s hidden",
    "keep begins alarm implies next always for 1 s hidden",
    "reach alarm then within 5 s hidden then within 1 s alarm",
    "require eventually within 4 s alarm",
    "require always for 3 s hidden",
    "keep once within 2 s hidden reach time_holding(alarm) >= 3 s",
    "reach alarm then hidden",
)


@pytest.mark.parametrize("clauses", SPECS)
def test_witnesses_pass_as_tests_and_as_traces(clauses: str, tltlc: Run, inside: Path) -> None:
    text = f"{HEAD}spec s {{ {clauses} }}\n"
    Path("s.tltl").write_text(text)
    outcome = tltlc("witness", "s.tltl", "--cover")
    assert outcome.out.count('test "') >= 1
    assert "step for " in outcome.out
    Path("pasted.tltl").write_text(text + outcome.out)
    result = tltlc("test", "pasted.tltl")
    assert result.status == 0, result.err
    trace = tltlc("witness", "s.tltl", "--accepting", "--as", "csv")
    assert trace.out.splitlines()[0].endswith(",dt")
    Path("accepted.csv").write_text(trace.out)
    assert tltlc("monitor", "s.tltl", "accepted.csv").status == 0
    assert tltlc("monitor", "s.tltl", "accepted.csv", "--summary").status == 0


def test_a_signal_may_have_the_name_of_the_column(tltlc: Run, inside: Path) -> None:
    Path("s.tltl").write_text("clock varies\nsignal dt: bool\nspec s { reach always for 2 s dt }\n")
    trace = tltlc("witness", "s.tltl", "--accepting", "--as", "csv")
    assert trace.out.splitlines()[0] == "dt,DT"
    Path("accepted.csv").write_text(trace.out)
    assert tltlc("monitor", "s.tltl", "accepted.csv").status == 0


def test_explanations_say_when_steps_come(tltlc: Run, inside: Path) -> None:
    Path("s.tltl").write_text(f"{HEAD}spec s {{ {SPECS[0]} }}\n")
    lines = tltlc("explain", "s.tltl").out.splitlines()
    assert lines[2] == "  Whenever alarm, reach hidden within 2 s."
    fail = lines.index("A way to fail")
    assert lines[fail + 1] == "  1. alarm and not hidden (to state 1)"
    assert lines[fail + 2].startswith("  2. not hidden")
    assert lines[fail + 2].endswith(" steps in 2.5 s (to state 2)")


def test_differences_are_shown_with_times(tltlc: Run, inside: Path) -> None:
    Path("a.tltl").write_text(f"{HEAD}spec s {{ {SPECS[0]} }}\n")
    Path("b.tltl").write_text(f"{HEAD}spec s {{ {SPECS[0].replace('2 s', '1 s')} }}\n")
    outcome = tltlc("diff", "a.tltl", "b.tltl").out
    assert "B is stricter than A: A also accepts every trace that B accepts." in outcome
    assert "step 1: alarm\n    step 2 (2 s): hidden\n" in outcome
    assert "B is violated" in outcome
    Path("b.tltl").write_text(f"{HEAD}spec s {{ {SPECS[0]} }}\n".replace("varies", "60 Hz"))
    assert "clock: varies in A, 0.016" in tltlc("diff", "a.tltl", "b.tltl").out


def test_lint_reads_bounds_that_no_steps_replace(tltlc: Run, inside: Path) -> None:
    Path("s.tltl").write_text(f"{HEAD}spec s {{ reach always for 3 s hidden limit 90 steps }}\n")
    outcome = tltlc("lint", "s.tltl")
    assert "TLT0434" in outcome.err
    assert "time_holding(hidden) >= 3 s" in outcome.err
