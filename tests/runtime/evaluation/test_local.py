"""Workers of this machine, as a terminal's Ctrl-C meets them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any, cast

import pytest

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S
from tltl_runtime.evaluation.local import Process
from tltl_runtime.evaluation.player import Plays, Task

_MAIN = """
import os, signal
from pathlib import Path
from tests.waiting import until
from tltl_runtime.evaluation.local import Process

if __name__ == "__mp_main__":
    Path("imports").touch()
    until(Path("interrupted").exists, "the interrupt")

class Plays:
    def play(self, task):
        return task

if __name__ == "__main__":
    worker = Process(Plays)
    future = worker.play("played")
    until(Path("imports").exists, "a worker that imports what it needs")
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.killpg(os.getpgrp(), signal.SIGINT)
    Path("interrupted").touch()
    print(future.result())
    worker.close()
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="needs groups of processes")
def test_a_worker_that_begins_does_not_hear_of_ctrl_c(tmp_path: Path) -> None:
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
    """Tells which process its own is a copy of, how many threads that one has, and whether torch is loaded here."""

    def play(self, task: Task) -> Any:
        return os.getppid(), len([*Path(f"/proc/{os.getppid()}/task").iterdir()]), "torch" in sys.modules

    def close(self) -> None:
        pass


@pytest.mark.skipif(sys.platform != "linux", reason="processes are started otherwise")
def test_workers_are_copies_of_one_process_that_has_loaded_torch_and_has_no_threads() -> None:
    workers = [Process(cast("type[Plays]", Origin)) for _ in range(2)]
    try:
        one, other = (worker.play(Task(0)).result() for worker in workers)
    finally:
        for worker in workers:
            worker.close()
    parent, *told = cast(Any, one)
    assert one == other and parent != os.getpid() and told == [1, True]
