"""Every monitor that can be built here says of every trace what :class:`tltlc.monitor.Monitor` says."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.conformance.runner import Runner, build, problems, runners, write
from tltlc.conformance.case import Case
from tltlc.conformance.corpus import CASES, is_exact
from tltlc.conformance.expected import Expected, expected
from tltlc.record import replace


@cache
def made(name: str) -> tuple[Case, tuple[Expected, ...]]:
    case = CASES[name]()
    return case, tuple(expected(case.fspa, trace) for trace in case.traces)


@pytest.fixture(scope="session")
def folders() -> dict[str, Path]:
    """Per runner a folder; one that builds all cases at once has done so when it is in here."""
    return {}


def _folder(runner: Runner, name: str, folders: dict[str, Path], factory: pytest.TempPathFactory) -> Path:
    """The folder in which the monitor of a case lies, built."""
    folder = folders.get(runner.name)
    if folder is None:
        folder = folders[runner.name] = factory.mktemp("monitors")
        if runner.build_all is not None:
            for each in CASES:
                write(runner, made(each)[0], folder)
            runner.build_all(folder, tuple(CASES))
    if runner.build_all is None:
        write(runner, made(name)[0], folder)
        build(runner, name, folder)
    return folder


def _runs() -> Iterator[Any]:
    """Each runner with each case; one that cannot be used here is skipped once, and says why."""
    for runner in runners():
        reason = runner.missing()
        if reason is None:
            yield from (pytest.param(runner, name, id=f"{runner.name}-{name}") for name in CASES)
        else:
            yield pytest.param(runner, "", id=runner.name, marks=pytest.mark.skip(reason=reason))


@pytest.mark.parametrize(("runner", "name"), list(_runs()))
def test_conformance(
    runner: Runner, name: str, folders: dict[str, Path], tmp_path_factory: pytest.TempPathFactory
) -> None:
    case, outcomes = made(name)
    runner = replace(runner, tolerance=0.0) if is_exact(case.fspa) else runner
    folder = _folder(runner, name, folders, tmp_path_factory)
    for number, (trace, outcome) in enumerate(zip(case.traces, outcomes, strict=True), start=1):
        found = list(problems(runner, name, folder, trace, outcome))
        assert not found, f"{name}.{number}.csv\n" + "\n".join(found[:10])
