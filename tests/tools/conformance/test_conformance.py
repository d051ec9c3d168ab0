"""Every monitor that can be built here gives the same results as :class:`tltlc.monitor.Monitor` on
every trace."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.tools.conformance.runner import (
    Outcome,
    Runner,
    build,
    build_program,
    output_differences,
    run_monitor,
    runners,
    write,
)
from tests.tools.conformance.runners.c import OPTIMIZED, VERDICT_ONLY, WITHOUT_REGISTERS
from tltlc.core.record import replace
from tltlc.tools.conformance.case import ConformanceCase
from tltlc.tools.conformance.corpus import CASES, is_exact
from tltlc.tools.conformance.expected_output import COLUMNS, ExpectedOutput, expected_output

ALONE = ("by_zero", "exclusive_many", "names_of_code", "counting")
"""Cases whose programs are built one by one and started once per trace, as a user does;
``test_programs`` has one more."""

EVERY = {"c++": 4, "rust": 3}
"""Compilers that take long for all cases: every fourth or third one is built, and all of them as a slow test."""


@cache
def case_and_expected(name: str) -> tuple[ConformanceCase, tuple[ExpectedOutput, ...]]:
    case = CASES[name]()
    return case, tuple(expected_output(case.fspa, trace) for trace in case.traces)


def _usable(among: Iterable[Runner]) -> Iterator[Any]:
    """Yield each runner as a parameter; a runner that cannot be used here is skipped, with the
    reason."""
    for runner in among:
        reason = runner.missing()
        marks = [pytest.mark.skip(reason=reason)] if reason else []
        yield pytest.param(runner, id=runner.name, marks=marks)


def _differences(runner: Runner, name: str, outcomes: list[Outcome]) -> Iterator[str]:
    """Yield the differences from what is expected, over the outcomes of all traces of a case."""
    case, expectations = case_and_expected(name)
    tolerance = 0.0 if is_exact(case.fspa) else runner.tolerance
    for number, (outcome, expectation) in enumerate(zip(outcomes, expectations, strict=True), start=1):
        differences = list(output_differences(outcome, expectation, tolerance))
        if differences:
            yield f"{runner.name}, {name}.{number}.csv\n" + "\n".join(differences[:10])


def check_together(runner: Runner, names: Iterable[str], folder: Path) -> None:
    """Build the monitors of these cases as one program, and compare its rows on all their traces."""
    cases = {name: case_and_expected(name)[0] for name in names}
    runs = [(name, trace) for name, case in cases.items() for trace in case.traces]
    outcomes = iter(build_program(runner, [case.fspa for case in cases.values()], folder)(runs))
    differences: list[str] = []
    for name, case in cases.items():
        differences += _differences(runner, name, [next(outcomes) for _ in case.traces])
    assert not differences, f"{len(differences)} of {len(runs)} traces differ\n" + "\n".join(differences)


@pytest.mark.parametrize("runner", list(_usable(runners())))
def test_cases_built_as_one_program_match_the_expected_rows(runner: Runner, tmp_path: Path) -> None:
    check_together(runner, list(CASES)[:: EVERY.get(runner.name, 1)], tmp_path)


@pytest.mark.parametrize("runner", list(_usable([WITHOUT_REGISTERS])))
def test_monitors_whose_registers_nobody_reads_match_the_expected_rows(runner: Runner, tmp_path: Path) -> None:
    names = [name for name in CASES if CASES[name]().fspa.registers]
    assert len(names) >= 5
    check_together(runner, names, tmp_path)


@pytest.mark.parametrize("runner", list(_usable([VERDICT_ONLY])))
def test_monitors_of_verdicts_match_the_first_columns_of_the_expected_rows(runner: Runner, tmp_path: Path) -> None:
    cases = {name: case_and_expected(name) for name in CASES}
    runs = [(name, trace) for name, (case, _) in cases.items() for trace in case.traces]
    outcomes = build_program(runner, [case.fspa for case, _ in cases.values()], tmp_path)(runs)
    expectations = [expectation for _, expectations in cases.values() for expectation in expectations]
    for (name, _), outcome, expectation in zip(runs, outcomes, expectations, strict=True):
        rows = tuple(row[:3] for row in expectation.rows)
        assert not list(output_differences(outcome, replace(expectation, rows=rows), 0.0, COLUMNS[:3])), name


@pytest.mark.slow
@pytest.mark.parametrize(
    "runner", list(_usable([OPTIMIZED, *(runner for runner in runners() if runner.name in EVERY)]))
)
def test_all_cases_of_slow_compilers_match_the_expected_rows(runner: Runner, tmp_path: Path) -> None:
    check_together(runner, CASES, tmp_path)


@pytest.mark.parametrize("name", ALONE)
@pytest.mark.parametrize("runner", list(_usable(runners())))
def test_single_programs_match_the_expected_rows(runner: Runner, name: str, tmp_path: Path) -> None:
    case, _ = case_and_expected(name)
    write(runner, case.fspa, tmp_path)
    build(runner, name, tmp_path)
    differences = list(
        _differences(runner, name, [run_monitor(runner, name, tmp_path, trace) for trace in case.traces])
    )
    assert not differences, "\n".join(differences)
