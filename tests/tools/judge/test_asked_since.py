"""The step at which a broken clause began to ask for what failed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tltlc.core.source import SourceFile
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import run
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.pipeline import Session
from tltlc.tools.judge.asked_since import asked_since
from tltlc.tools.judge.clauses import clauses_of

STEADY = "clock 10 Hz"
RARELY = st.sampled_from((0, 0, 0, 0, 1))
TRACES = st.lists(st.tuples(st.integers(0, 1), RARELY), min_size=6, max_size=12)


def samples(rows: Sequence[tuple[float, ...]]) -> list[Mapping[str, float]]:
    return [dict(zip(("alarm", "safe", STEP_LENGTH), row, strict=False)) for row in rows]


def failed_and_since(clause: str, rows: Sequence[tuple[float, ...]], clock: str = STEADY) -> tuple[int, int | None]:
    """Return the step at which the rows (``alarm``, ``safe``, ``dt``) break the clause, 0 for none, and its reason."""
    session = Session(
        SourceFile("a.tltl", f"{clock}\nsignal alarm: bool\nsignal safe: bool\nspec s {{\n    {clause}\n}}\n")
    )
    (fspa,), (spec,) = session.automata, session.specs
    monitor, trace = Monitor(fspa), samples(rows)
    for _ in run(monitor, trace):
        pass
    if monitor.failure is None:
        return 0, None
    return monitor.failure.step, asked_since(clauses_of(fspa, spec), fspa.clauses, trace, monitor.failure)


@given(TRACES)
def test_a_deadline_counts_from_the_step_that_asks_for_an_answer(rows: list[tuple[int, int]]) -> None:
    failed, since = failed_and_since("keep alarm implies eventually within 3 steps safe", rows)
    assume(failed)
    expected = failed - 3
    assert rows[expected - 1][0]
    assert since == (expected if expected > 1 else None)


@given(TRACES)
def test_of_several_steps_that_forbid_the_same_the_last_counts(rows: list[tuple[int, int]]) -> None:
    failed, since = failed_and_since("keep alarm implies next always for 4 steps not safe", rows)
    assume(failed)
    expected = max(step for step in range(1, failed) if rows[step - 1][0])
    assert since == (expected if expected > 1 else None)


@pytest.mark.parametrize("clock", [STEADY, "clock varies"])
@pytest.mark.parametrize(
    ("clause", "safe_from", "failed"),
    [
        ("keep begins alarm implies eventually within 20 s safe", 1000, 207),
        ("keep begins alarm implies always for 20 s not safe", 150, 150),
        ("keep alarm implies eventually within 20 s safe", 1000, 207),
    ],
)
def test_a_timer_counts_from_the_step_of_its_event(clause: str, safe_from: int, failed: int, clock: str) -> None:
    length = () if clock == STEADY else (0.1,)
    rows = [(float(step == 7), float(step >= safe_from), *length) for step in range(1, 300)]
    assert failed_and_since(clause, rows, clock) == (failed, 7)


@pytest.mark.parametrize(
    "clause",
    [
        "avoid alarm",
        "keep alarm implies once (alarm and safe)",
        "require eventually within 0.5 s (safe and alarm)",
        "keep alarm implies time_since(safe) <= 0.1 s",
    ],
)
def test_a_clause_about_one_step_or_all_steps_counts_from_none(clause: str) -> None:
    failed, since = failed_and_since(clause, [(float(step == 7), float(step == 1)) for step in range(1, 9)])
    assert failed > 1
    assert since is None
