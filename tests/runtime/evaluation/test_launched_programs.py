"""Programs that a game has started in a worker process end with the worker."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT
from tests.runtime.evaluation.launchers import Deaf, Launcher, Mortal, Stubborn
from tests.waiting import HANG_S, is_running, until, until_gone
from tltl_runtime.evaluation import worker_process
from tltl_runtime.evaluation.player import EpisodeRequest
from tltl_runtime.evaluation.scheduler import WorkerLostError
from tltl_runtime.evaluation.worker_process import WorkerProcess


def playing(folder: Path) -> int:
    """Wait until an episode is played; return the id of the program that plays it."""
    path = folder / "program"
    until(path.exists, "the episode")
    return int(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("make", [Launcher, Stubborn])
def test_a_worker_closes_its_player_in_the_middle_of_an_episode(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, make: type[Launcher]
) -> None:
    monkeypatch.setattr(worker_process, "_TO_END_S", HANG_S)
    worker = WorkerProcess(partial(make, tmp_path))
    worker.play(EpisodeRequest(0))
    program = playing(tmp_path)
    assert is_running(program)
    worker.close()
    until_gone([program])
    assert (tmp_path / "closed").exists()


def test_a_worker_that_cannot_be_interrupted_is_killed_with_its_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(worker_process, "_TO_END_S", 0.1)
    worker = WorkerProcess(partial(Deaf, tmp_path))
    worker.play(EpisodeRequest(0))
    program = playing(tmp_path)
    worker.close()
    until_gone([program])
    assert not (tmp_path / "closed").exists()


def test_the_program_of_a_lost_worker_is_killed(tmp_path: Path) -> None:
    worker = WorkerProcess(partial(Mortal, tmp_path))
    with pytest.raises(WorkerLostError):
        worker.play(EpisodeRequest(0)).result(HANG_S)
    program = playing(tmp_path)
    worker.close()
    until_gone([program])


def test_a_program_ends_if_the_process_of_the_evaluation_is_killed(tmp_path: Path) -> None:
    code = f"""
import time
from functools import partial
from pathlib import Path
from tests.runtime.evaluation.launchers import Launcher
from tltl_runtime.evaluation.player import EpisodeRequest
from tltl_runtime.evaluation.worker_process import WorkerProcess

worker = WorkerProcess(partial(Launcher, Path({str(tmp_path)!r})))
worker.play(EpisodeRequest(0))
time.sleep({HANG_S})
"""
    path = os.pathsep.join([str(ROOT), str(ROOT / "runtime")])
    with subprocess.Popen([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}) as process:
        program = playing(tmp_path)
        process.kill()
    until_gone([program])
