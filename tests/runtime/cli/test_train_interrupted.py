"""``tltlc train``: trainings that a signal, a killed process or a killed worker ends."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from multiprocessing import active_children
from pathlib import Path

import pytest
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from tests.interfaces.cli.conftest import EXAMPLE, tltlc  # noqa: F401
from tests.runtime.cli.signals import interrupted, signal_at_call, with_signals  # noqa: F401
from tests.runtime.cli.small_training import SMALL, TltlcFunction, _here, _run, _second, _trainings, train_arguments  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.runner import Iteration, Runner


@pytest.mark.slow
@pytest.mark.usefixtures("run")
def test_a_training_killed_at_its_limit_is_finished_when_it_resumes(tltlc: TltlcFunction) -> None:  # noqa: F811
    folder = Path("run")
    before, description = (folder / "checkpoint.pt").read_bytes(), (folder / "run.json").read_bytes()
    tltlc("train", "--resume", "run", "--steps", "256")
    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128, 192, 256]
    # The same files as if it had been killed after its second iteration, in which it reached its limit.
    (folder / "checkpoint.pt").write_bytes(before)
    (folder / "run.json").write_bytes(description)
    (folder / "record.json").unlink()
    result = tltlc("train", "--resume", "run")
    assert result.status == 1
    assert "steps/s" not in result.err
    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128]
    assert [point["steps"] for point in json.loads((folder / "record.json").read_text())["curve"]] == [64, 128]
    events = EventAccumulator("run")
    events.Reload()
    assert [event.step for event in events.Scalars("time/episodes")] == [64, 128]


SIGNALS = pytest.mark.parametrize(("name", "status"), [("SIGINT", 130), ("SIGTERM", 143)])


@SIGNALS
def test_a_training_ended_by_a_signal_resumes(
    with_signals: TltlcFunction,  # noqa: F811
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    status: int,
) -> None:
    with monkeypatch.context() as patch:
        # An iteration steps 16 times; the signal arrives in the middle of the second one.
        signal_at_call(patch, Runner, "_step", getattr(signal, name), call=16 + 8)
        stopped = with_signals(*train_arguments("--steps", "100000000"))
    assert stopped.err.splitlines()[4].startswith("iteration 1: 64 steps in "), stopped.err
    _check_stopped(stopped.status, status, stopped.err)
    _check_resumed(tltlc, here / "run", done=1)


@pytest.mark.slow
@SIGNALS
def test_a_process_that_trains_ends_by_a_signal(tltlc: TltlcFunction, here: Path, name: str, status: int) -> None:  # noqa: F811
    with _training(here, "--steps", "100000000") as process:
        assert process.stderr is not None
        first = [process.stderr.readline() for _ in range(5)][-1]
        assert first.startswith("iteration 1: 64 steps in "), first + process.stderr.read()
        process.send_signal(getattr(signal, name))
        _, err = process.communicate(timeout=HANG_S)
    _check_stopped(process.returncode, status, err)
    _check_resumed(tltlc, here / "run", done=len(read_metrics(here / "run" / METRICS)))


def _check_stopped(status: int, expected: int, err: str) -> None:
    assert status == expected
    assert err.splitlines()[-1] == "stopped; to go on: tltlc train --resume run"


def _check_resumed(tltlc: TltlcFunction, run: Path, done: int) -> None:  # noqa: F811
    """Resume a training for one iteration more than it has done."""
    resumed = tltlc("train", "--resume", "run", "--steps", str(64 * (done + 1)))
    assert resumed.status == 1, resumed.err
    assert [line["iteration"] for line in read_metrics(run / METRICS)] == list(range(1, done + 2))


def test_a_killed_worker_is_reported(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    iterations = Runner.iterations

    def with_a_kill(runner: Runner) -> Iterator[Iteration]:
        for iteration in iterations(runner):
            yield iteration
            (worker,) = active_children()
            worker.kill()

    monkeypatch.setattr(Runner, "iterations", with_a_kill)
    result = tltlc("train", EXAMPLE, "--config", "small.toml", "--out", "run", "--steps", "100000000")
    assert result.status == 1
    assert result.err.splitlines()[4].startswith("iteration 1: ")
    assert "error[TLT0871]: the training was interrupted: worker 0 was killed by SIGKILL\n" in result.err
    assert "to go on from the last checkpoint: tltlc train --resume run" in result.err
    assert (here / "run" / "checkpoint.pt").is_file()


def test_a_worker_that_is_killed_in_the_search_is_reported(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def with_a_kill(*_: object) -> None:
        for worker in active_children():
            worker.kill()

    monkeypatch.setattr("tltl_runtime.cli.support.training_display._LineDisplay.show_search", with_a_kill)
    Path("search.toml").write_text(SMALL.replace("ways = 0", "ways = 2\nsteps = 6400"))
    result = tltlc("train", EXAMPLE, "--config", "search.toml", "--out", "run")
    assert "error[TLT0871]: the training was interrupted: worker 0 was killed by SIGKILL\n" in result.err
    assert "to start again: tltlc train --resume run" in result.err
    assert not (here / "run" / "checkpoint.pt").exists()


def _training(folder: Path, *options: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "tltlc", *train_arguments(*options)]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)
