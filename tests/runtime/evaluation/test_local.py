"""Workers of this machine, as a terminal's Ctrl-C meets them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S

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
