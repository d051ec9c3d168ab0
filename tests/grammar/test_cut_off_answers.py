"""`unless the recording ends`, `weak_eventually` and `a for 2 s since b`: compared with traces."""

from __future__ import annotations

from itertools import product

import pytest

from tests.grammar.sentences import read
from tltlc.automaton.fspa import Fspa
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.monitor import Monitor
from tltlc.pipeline import compile_text

SIGNALS = "clock 1 Hz\nsignal fire: bool\nsignal spray: bool\nsignal boss_dead: bool\n"
WAIT = "avoid time_holding(not spray since ({} and not spray)) >= 2 s"


@pytest.mark.parametrize(
    ("typed", "clause"),
    [
        ("keep fire implies eventually within 2 s spray unless the recording ends", WAIT.format("fire")),
        ("keep fire implies weak_eventually within 2 s spray", WAIT.format("fire")),
        ("whenever fire begins, spray within 2 s, if the recording lasts that long", WAIT.format("begins fire")),
        ("keep begins fire implies spray within 2 s or play ends", WAIT.format("begins fire")),
        ("keep fire implies spray until boss_dead unless play ends", "keep fire implies spray weak_until boss_dead"),
        ("keep fire implies next spray unless the session is over", "keep fire implies weak_next spray"),
    ],
)
def test_an_answer_that_play_cuts_off_is_not_asked_for(typed: str, clause: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == [(clause, "")]


@pytest.mark.parametrize(
    "typed", ["avoid fire unless play ends", "keep weak_eventually spray", "reach fire or play ends"]
)
def test_what_asks_for_no_answer_has_no_reading(typed: str) -> None:
    assert not read(typed).readings


def _automaton(clause: str) -> Fspa:
    return compile_text(f"{SIGNALS}spec s {{\n    {clause}\n}}\n")[0]


def _verdicts(fspa: Fspa, trace: tuple[tuple[int, ...], ...]) -> list[str]:
    monitor = Monitor(fspa)
    return [monitor.step(dict(zip(("fire", "spray", "boss_dead"), (*step, 0), strict=False))).verdict for step in trace]


@pytest.mark.parametrize("event", ["fire", "begins fire"])
def test_the_clause_differs_from_the_answer_only_where_play_ends(event: str) -> None:
    strong = _automaton(f"keep {event} implies eventually within 2 s spray")
    weak = _automaton(WAIT.format(event))
    for trace in product(product((0, 1), repeat=2), repeat=5):
        expected = ["violated" if verdict == "violated" else "holding" for verdict in _verdicts(strong, trace)]
        assert _verdicts(weak, trace) == expected


SINCE = "(not begins fire since (time_holding(spray) >= 2 s and time_since(begins fire) >= 2 s))"


@pytest.mark.parametrize(
    "typed",
    [
        "keep ends fire implies spray for 2 s since begins fire",
        "keep ends fire implies spray for at least 2 s since begins fire",
        "keep ends fire implies once spray for 2 s since the last begins fire",
        "keep ends fire implies spray held for 2 s since begins fire",
    ],
)
def test_a_time_since_an_event_asks_for_a_time_in_a_row(typed: str) -> None:
    assert [(*reading.clauses, reading.condition) for reading in read(typed).readings] == [
        (f"keep ends fire implies {SINCE}", "")
    ]


def test_a_time_since_an_event_that_comes_later_is_no_time_in_a_row() -> None:
    assert not any(
        "time_holding" in "".join(reading.clauses)
        for reading in read("keep ends fire implies spray at least 2 s since fire").readings
    )


def test_the_time_begins_and_ends_since_the_event() -> None:
    fspa = _automaton(f"keep ends fire implies {SINCE}")
    for trace in product(product((0, 1), repeat=2), repeat=6):
        violated, long_enough, row = False, False, 0
        for step, (fire, spray) in enumerate(trace):
            before = trace[step - 1][0] if step else 0
            if fire and not before:
                row, long_enough = 0, False
            row = row + 1 if spray else 0
            long_enough = long_enough or row >= 3
            violated = violated or bool(before and not fire and not long_enough)
        assert (_verdicts(fspa, trace)[-1] == "violated") == violated


@pytest.mark.parametrize("time", ["5 steps", "0 s"])
def test_a_time_that_no_timer_can_compare_has_no_reading(time: str) -> None:
    assert not read(f"keep fire implies eventually within {time} spray unless the recording ends").readings


def test_where_the_clock_varies_there_is_no_reading() -> None:
    head = "clock varies\nsignal fire: bool\nsignal spray: bool\nspec s {\n    "
    clause = "keep fire implies eventually within 2 s spray unless the recording ends"
    with pytest.raises(TltlError) as caught:
        compile_text(f"{head}{clause}\n}}\n")
    assert "time_holding" not in (caught.value.diagnostics[0].help or "")
