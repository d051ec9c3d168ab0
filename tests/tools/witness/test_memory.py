"""Traces of specs with registers: each is confirmed by a monitor, as a test block and as CSV."""

from __future__ import annotations

from itertools import product

import pytest

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import Session
from tltlc.tools.witness import captions
from tltlc.tools.witness.cover import cover
from tltlc.tools.witness.memory_search import MemorySearch
from tltlc.tools.witness.text import as_csv, as_test
from tltlc.tools.witness.traces import Witness, accepting_trace, rejecting_trace
from tltlc.tools.witness.transitions import Moves

NAMES = """
clock 10 Hz
signal seen: bool
signal hidden: bool
signal alarm: bool
signal hp in [0, 100]
"""


def _fspa(spec: str) -> Fspa:
    (fspa,) = compile_text(NAMES + spec)
    return fspa


def _check(spec: str, witness: Witness) -> None:
    """Assert that the trace passes as a test block of the spec, and that a monitor takes its states as CSV."""
    fspa = _fspa(spec)
    as_csv(fspa, witness)
    text = NAMES + spec + "\n" + as_test(fspa, witness, "t")
    compiled = Session(SourceFile("s.tltl", text)).compiled()
    assert [result.failure for result in run_tests(compiled.program, compiled.automata)] == [None]


@pytest.mark.parametrize(
    ("spec", "accepted", "rejected"),
    [
        ("spec s { keep times(seen) <= 2 }", 1, 5),
        ("spec s { reach times(seen) >= 3 }", 5, None),
        ("spec s { keep alarm implies once seen }", 1, 1),
        ("spec s { reach time_holding(hidden) >= 2 s }", 21, None),
        ("spec s { keep time_since(seen) > 1 s implies not alarm }", 1, 1),
        ("spec s { reach seen then ends seen  keep not (hidden since alarm) }", 2, 1),
        ("spec s { keep hp >= previous(hp) }", 1, 2),
        ("spec s { reach highest(hp) - lowest(hp) > 50 }", 2, None),
        ("spec s { reach begins seen and once within 3 steps hidden }", 1, None),
        ("spec s { semantics infinite  keep alarm implies once seen }", None, 2),
        ("spec s { reach seen then time_holding(hidden) >= 60 s then times(alarm) >= 2 }", 605, None),
    ],
)
def test_traces_are_those_of_a_monitor(spec: str, accepted: int | None, rejected: int | None) -> None:
    moves = Moves(_fspa(spec))
    for witness, length in ((accepting_trace(moves), accepted), (rejecting_trace(moves), rejected)):
        if length is None:
            continue
        assert witness is not None
        assert len(witness.moves) == length
        _check(spec, witness)


def test_a_cover_takes_every_edge_that_is_found() -> None:
    spec = "spec s { reach times(seen) >= 2 then once hidden  keep not (previously alarm) }"
    covering = cover(Moves(_fspa(spec)))
    assert covering.untaken == ()
    for witness in covering.traces:
        _check(spec, witness)


def test_a_trace_that_is_not_found_is_not_called_impossible() -> None:
    moves = Moves(_fspa("spec s { keep seen implies once seen }"))
    assert rejecting_trace(moves) is None
    warning = captions.no_trace_warning(moves, "rejected")
    assert warning.title == "no trace was found that is rejected by `s`"
    (edge,) = [edge for edge in cover(moves).untaken if moves.fspa.edges[edge.edge].source == 0]
    (first, *_) = captions.untaken_warnings(moves.fspa, [edge])
    assert first.help == "its atoms remember the trace so far, and the search for such a trace is not complete"


def test_the_work_of_a_search_is_bounded() -> None:
    fspa = _fspa("spec s { keep seen implies once seen  keep time_since(alarm) <= 1000 s or times(hidden) < 1000 }")
    names = [signal.name for signal in fspa.signals]
    search = MemorySearch([fspa], [dict(zip(names, values, strict=True)) for values in product((0.0, 1.0), repeat=3)])
    assert sum(1 for _ in search.positions()) == 68_000
