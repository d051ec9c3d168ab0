"""Worker processes on this machine: Ctrl-C during their start, and the fork server."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any, cast

import pytest

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S
from tltl_runtime.evaluation.player import EpisodePlayer, EpisodeRequest
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
