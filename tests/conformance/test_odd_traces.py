"""The programs of all languages read odd traces, those of a table and random ones, as :mod:`tltlc.monitor.traces` does.

Godot is left to ``test_conformance``: its programs end the engine.
"""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.conformance.batch import BATCHES, NAME, Batch, built
from tests.monitor.odd_bytes import csv_traces
from tltlc.automaton.fspa import Fspa
from tltlc.conformance.check import differences
from tltlc.conformance.corpus import CASES
from tltlc.conformance.expected import COLUMNS, expected
from tltlc.conformance.odd_traces import CELLS, LINES, MORE_VALUES, VALUES
from tltlc.record import replace


def automaton() -> Fspa:
    return replace(CASES["trace_values"]().fspa, name=NAME)


def problems(run, traces: list[bytes]) -> list[str]:  # type: ignore[no-untyped-def]
    fspa, found = automaton(), []
    for trace, (status, out, err) in zip(traces, run(traces), strict=True):
        wanted = expected(fspa, trace)
        error = wanted.refusal and wanted.refusal.document()
        said = differences(status, out, err, [COLUMNS, *wanted.rows], wanted.warnings, error, 0.0)
        found += [f"{trace[:200]!r}: {problem}" for problem in said]
    return found


@pytest.fixture(scope="module", params=BATCHES, ids=lambda batch: batch.name)
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):  # type: ignore[no-untyped-def]
    batch: Batch = request.param
    reason = batch.missing()
    if reason:
        pytest.skip(reason)
    return built(batch, automaton(), tmp_path_factory.mktemp(batch.name))


def test_odd_traces_are_read_alike(run) -> None:  # type: ignore[no-untyped-def]
    odd = [each.trace for each in (*LINES.values(), *CELLS.values(), *VALUES.values(), *MORE_VALUES.values())]
    assert not problems(run, odd)


# One example is a hundred traces, which one process reads.
@settings(max_examples=2, phases=(Phase.generate,), suppress_health_check=list(HealthCheck))
@given(traces=st.lists(csv_traces(), min_size=100, max_size=100))
def test_random_traces_are_read_alike(run, traces: list[bytes]) -> None:  # type: ignore[no-untyped-def]
    assert not problems(run, traces)
