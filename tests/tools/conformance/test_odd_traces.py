"""The programs of most languages read odd traces, listed and random ones, as
:mod:`tltlc.monitor.traces` does."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.monitor.odd_bytes import csv_traces
from tests.tools.conformance.runner import Runner, build_program, output_differences, runners
from tltlc.automaton.fspa import Fspa
from tltlc.tools.conformance.corpus import CASES
from tltlc.tools.conformance.expected_output import expected_output
from tltlc.tools.conformance.odd_traces import CELLS, LINES, MORE_VALUES, VALUES

NAME = "trace_values"
# The C++ program is the C program compiled as C++, and Godot takes long to read a megabyte.
LEFT_OUT = ("c++", "gdscript3")
# test_conformance.py reports which runners cannot be used here, and why.
USABLE = [runner for runner in runners() if runner.build_all and not runner.missing() and runner.name not in LEFT_OUT]


def automaton() -> Fspa:
    return CASES[NAME]().fspa


def problems(run, traces: list[bytes]) -> list[str]:  # type: ignore[no-untyped-def]
    fspa, messages = automaton(), []
    for trace, outcome in zip(traces, run([(NAME, trace) for trace in traces]), strict=True):
        messages += [
            f"{trace[:200]!r}: {difference}"
            for difference in output_differences(outcome, expected_output(fspa, trace), 0.0)
        ]
    return messages


@pytest.fixture(scope="module", params=USABLE, ids=lambda runner: runner.name)
def run(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):  # type: ignore[no-untyped-def]
    runner: Runner = request.param
    return build_program(runner, [automaton()], tmp_path_factory.mktemp(runner.name))


def test_programs_read_the_listed_traces_as_the_monitor_does(run) -> None:  # type: ignore[no-untyped-def]
    odd = [odd_trace.trace for odd_trace in (*LINES.values(), *CELLS.values(), *VALUES.values(), *MORE_VALUES.values())]
    assert not problems(run, odd)


# One example consists of a hundred traces, which one process reads.
@settings(max_examples=2, phases=(Phase.generate,), suppress_health_check=list(HealthCheck))
@given(traces=st.lists(csv_traces(), min_size=100, max_size=100))
def test_programs_read_random_traces_as_the_monitor_does(run, traces: list[bytes]) -> None:  # type: ignore[no-untyped-def]
    assert not problems(run, traces)
