"""The limit of minutes counts from the start of the command, and is looked at while an iteration is played."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tests.runtime.training.runs import checkpoint_of, run_in
from tltl_runtime.training.files.run_file import POLICY
from tltl_runtime.training.run.train import train
from tltl_runtime.training.run.training_clock import TrainingClock
from tltl_runtime.training.runner import Runner
from tltlc.core.record import replace


class _Time:
    """A time that only the test moves on."""

    now = 5.0


@pytest.fixture
def time(monkeypatch: pytest.MonkeyPatch) -> _Time:
    moved = _Time()
    fake = SimpleNamespace(perf_counter=lambda: moved.now)
    monkeypatch.setattr("tltl_runtime.training.run.training_clock.time", fake)
    return moved


def test_the_clock_adds_the_seconds_of_earlier_runs(time: _Time) -> None:
    clock = TrainingClock(4.0, 10.0)
    time.now = 6.0
    clock.add(3.0)
    assert clock.seconds == 15.0


def test_the_start_of_the_games_counts(tmp_path: Path, time: _Time) -> None:
    def start() -> None:
        time.now += 70.0

    run = run_in(tmp_path / "run", stop__minutes=1.0)
    (report,) = train(run, on_start=start, began=2.0)
    assert (report.iteration.number, report.steps, report.stop) == (1, 64, "minutes")
    assert (report.seconds, report.setup_s) == (73.0, 73.0)


def test_the_limit_drops_the_iteration_that_is_played(
    tmp_path: Path, time: _Time, monkeypatch: pytest.MonkeyPatch
) -> None:
    step, steps = Runner._step, list[int]()

    def counted(runner: Runner, observation: Any) -> Any:
        steps.append(runner.current_learning_iteration)
        if len(steps) == 20:
            time.now += 61.0
        return step(runner, observation)

    monkeypatch.setattr(Runner, "_step", counted)
    run = run_in(tmp_path / "run", stop__minutes=1.0)
    first, last = train(run, began=time.now)
    assert (first.stop, last.stop) == (None, "minutes")
    assert (last.iteration.number, last.iteration.steps, last.steps, len(steps)) == (1, 0, 64, 20)
    assert (run.folder / POLICY).exists() and checkpoint_of(run).iteration == 1
    longer = replace(run, settings=replace(run.settings, stop=replace(run.settings.stop, minutes=0.0)))
    assert [report.iteration.number for report in train(longer, resume=True)] == [2, 3]
