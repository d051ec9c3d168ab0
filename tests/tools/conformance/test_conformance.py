"""Every monitor that can be built here says of every trace what :class:`tltlc.monitor.Monitor` says."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.tools.conformance.runner import Outcome, Runner, build, built, problems, ran, runners, write
from tltlc.tools.conformance.case import Case
from tltlc.tools.conformance.corpus import CASES, is_exact
from tltlc.tools.conformance.expected import Expected, expected

ALONE = ("by_zero", "exclusive_many", "names_of_code")
"""Cases whose programs are built, and started for each trace, as a person does it; ``test_programs`` has one more."""


@cache
def made(name: str) -> tuple[Case, tuple[Expected, ...]]:
    case = CASES[name]()
    return case, tuple(expected(case.fspa, trace) for trace in case.traces)


def _usable() -> Iterator[Any]:
    """Each runner; one that cannot be used here is skipped, and says why."""
    for runner in runners():
        reason = runner.missing()
        marks = [pytest.mark.skip(reason=reason)] if reason else []
        yield pytest.param(runner, id=runner.name, marks=marks)


def _differences(runner: Runner, name: str, outcomes: list[Outcome]) -> Iterator[str]:
    """What is otherwise than expected in the outcomes of all traces of a case."""
    case, wanted = made(name)
    tolerance = 0.0 if is_exact(case.fspa) else runner.tolerance
    for number, (outcome, right) in enumerate(zip(outcomes, wanted, strict=True), start=1):
        found = list(problems(outcome, right, tolerance))
        if found:
            yield f"{runner.name}, {name}.{number}.csv\n" + "\n".join(found[:10])


@pytest.mark.parametrize("runner", list(_usable()))
def test_conformance(runner: Runner, tmp_path: Path) -> None:
    """All cases, by one program."""
    cases = {name: made(name)[0] for name in CASES}
    runs = [(name, trace) for name, case in cases.items() for trace in case.traces]
    outcomes = iter(built(runner, [case.fspa for case in cases.values()], tmp_path)(runs))
    found: list[str] = []
    for name, case in cases.items():
        found += _differences(runner, name, [next(outcomes) for _ in case.traces])
    assert not found, f"{len(found)} of {len(runs)} traces differ\n" + "\n".join(found)


@pytest.mark.parametrize("name", ALONE)
@pytest.mark.parametrize("runner", list(_usable()))
def test_programs_alone(runner: Runner, name: str, tmp_path: Path) -> None:
    case, _ = made(name)
    write(runner, case.fspa, tmp_path)
    build(runner, name, tmp_path)
    found = list(_differences(runner, name, [ran(runner, name, tmp_path, trace) for trace in case.traces]))
    assert not found, "\n".join(found)
