"""Monitors of random specs on a clock that varies give the same rows as :class:`tltlc.monitor.Monitor`."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pytest

from tests.tools.conformance.runner import Runner, build_program, output_differences, runners
from tltlc.automaton.fspa import Fspa
from tltlc.tools.conformance.corpus import is_exact
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.expected_output import COLUMNS, expected_output
from tltlc.tools.conformance.traces import random_trace
from tltlc.tools.conformance.varying_clock import LENGTHS, random_spec

RUNNERS: Final = [runner for runner in runners() if runner.name not in ("c++", "gdscript")]


def check_random_specs(runner: Runner, folder: Path, seeds: range, traces: int) -> int:
    """Compare the rows of monitors of random specs with those of :class:`tltlc.monitor.Monitor`, to the last digit.

    Return the number of specs; those in error do not count. Each runs on ``traces`` random traces.
    """
    if runner.missing():
        pytest.skip(str(runner.missing()))
    fspas: list[Fspa] = []
    runs: list[tuple[Fspa, bytes]] = []
    for seed in seeds:
        draw = Draw(seed)
        _, fspa = random_spec(f"random_{seed}", draw)
        if fspa is not None:
            assert fspa.clock_varies and is_exact(fspa)
            fspas.append(fspa)
            runs += [(fspa, random_trace(fspa, draw, 30, step_lengths=LENGTHS)) for _ in range(traces)]
    outcomes = build_program(runner, fspas, folder)([(fspa.name, trace) for fspa, trace in runs])
    verdicts: set[str] = set()
    for (fspa, trace), outcome in zip(runs, outcomes, strict=True):
        expected = expected_output(fspa, trace)
        differences = [*output_differences(outcome, expected, 0.0)]
        assert not differences, f"{fspa.formula}\n{trace.decode()}" + "\n".join(differences)
        verdicts |= {row[COLUMNS.index("verdict")] for row in expected.rows}
    assert verdicts == {"satisfied", "holding", "pending", "violated"}
    return len(fspas)


@pytest.mark.parametrize("runner", RUNNERS, ids=lambda runner: runner.name)
def test_monitors_of_random_specs_agree_with_the_monitor(runner: Runner, tmp_path: Path) -> None:
    assert check_random_specs(runner, tmp_path, range(12), 10) >= 10


@pytest.mark.slow
@pytest.mark.parametrize("runner", RUNNERS, ids=lambda runner: runner.name)
def test_monitors_of_many_random_specs_agree_with_the_monitor(runner: Runner, tmp_path: Path) -> None:
    assert check_random_specs(runner, tmp_path, range(12, 100), 20) >= 80
