"""Worker processes on this machine: Ctrl-C during their start, the fork server, and their end."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Final, cast

import pytest

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S
from tltl_runtime.evaluation.player import EpisodePlayer, EpisodeRequest
from tltl_runtime.evaluation.scheduler import WorkerLostError
from tltl_runtime.evaluation.worker_process import WorkerProcess

_MAIN = """
import os, signal
from pathlib import Path
from tests.waiting import until
from tltl_runtime.evaluation.worker_process import WorkerProcess

if __name__ == "__mp_main__":
    Path("imports").touch()
    until(Path("interrupted").exists, "the interrupt")

class Plays:
    def play(self, request):
        return request

    def close(self):
        pass

if __name__ == "__main__":
    worker = WorkerProcess(Plays)
    future = worker.play("played")
    until(Path("imports").exists, "a worker that imports what it needs")
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.killpg(os.getpgrp(), signal.SIGINT)
    Path("interrupted").touch()
    print(future.result())
    worker.close()
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="needs groups of processes")
def test_a_starting_worker_ignores_ctrl_c(tmp_path: Path) -> None:
    path = tmp_path / "main.py"
    path.write_text(_MAIN, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    done = subprocess.run(
        [sys.executable, path],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        start_new_session=True,
        timeout=HANG_S,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "played\n", "")


class Origin:
    """Returns the parent's process id, the number of its threads, and whether torch is loaded."""

    def play(self, request: EpisodeRequest) -> Any:
        return os.getppid(), len([*Path(f"/proc/{os.getppid()}/task").iterdir()]), "torch" in sys.modules

    def close(self) -> None:
        pass


@pytest.mark.skipif(sys.platform != "linux", reason="processes are started otherwise")
def test_workers_are_forked_from_one_process_with_one_thread_and_without_torch() -> None:
    workers = [WorkerProcess(cast("type[EpisodePlayer]", Origin)) for _ in range(2)]
    try:
        first_origin, second_origin = (worker.play(EpisodeRequest(0)).result() for worker in workers)
    finally:
        for worker in workers:
            worker.close()
    parent, *state = cast(Any, first_origin)
    assert first_origin == second_origin and parent != os.getpid() and state == [1, False]


LARGE: Final = b"x" * (100 << 20)


class Large:
    """Plays episodes whose results are so large that sending one takes a while, or that fail to be sent."""

    def play(self, request: EpisodeRequest) -> Any:
        if request.sampled:
            return LARGE
        raise OwnError(request, "in the game")

    def close(self) -> None:
        pass


class OwnError(Exception):
    """Cannot be pickled, because its constructor has two arguments."""

    def __init__(self, request: EpisodeRequest, message: str) -> None:
        super().__init__(f"episode {request.index}: {message}")


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.9])
def test_a_worker_that_sends_a_large_result_can_be_closed(share: float) -> None:
    worker = WorkerProcess(cast("type[EpisodePlayer]", Large))
    began = time.monotonic()
    assert cast(Any, worker.play(EpisodeRequest(0)).result(HANG_S)) == LARGE
    took = time.monotonic() - began
    worker.play(EpisodeRequest(1))
    time.sleep(share * took)
    worker.close()


def test_an_error_that_cannot_be_pickled_is_raised_with_the_traceback_of_the_worker() -> None:
    worker = WorkerProcess(cast("type[EpisodePlayer]", Large))
    try:
        with pytest.raises(RuntimeError, match="OwnError: episode 3: in the game") as caught:
            worker.play(EpisodeRequest(3, sampled=False)).result(HANG_S)
    finally:
        worker.close()
    assert "in play\n" in str(caught.value.__cause__)


def test_a_worker_that_is_never_closed_does_not_keep_python_from_ending() -> None:
    code = (
        "from tests.runtime.evaluation.test_local import EpisodeRequest, Large, WorkerProcess\n"
        "worker = WorkerProcess(Large)\n"
        "assert len(worker.play(EpisodeRequest(0)).result()) == 100 << 20\n"
        "worker.play(EpisodeRequest(1))\n"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    done = subprocess.run([sys.executable, "-c", code], env=environment, timeout=HANG_S, check=False)
    assert done.returncode == 0


class StartsProgram:
    """Starts a program that has all descriptors that it can have, and then never ends its episode."""

    def play(self, request: EpisodeRequest) -> Any:
        if request.index == 0:
            return subprocess.Popen(["sleep", str(HANG_S)], close_fds=False).pid
        time.sleep(HANG_S)
        return None

    def close(self) -> None:
        pass


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="needs the program sleep")
def test_a_program_of_a_killed_worker_does_not_keep_the_pipe_open() -> None:
    worker = WorkerProcess(cast("type[EpisodePlayer]", StartsProgram))
    worker.play(EpisodeRequest(0)).result(HANG_S)
    try:
        future = worker.play(EpisodeRequest(1))
        worker._process.kill()
        with pytest.raises(WorkerLostError):
            future.result(HANG_S)
    finally:
        worker.close()
