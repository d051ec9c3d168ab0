"""Workers of this machine, as a terminal's Ctrl-C meets them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

_MAIN = """
import os, signal, time
from tltl_runtime.evaluation.local import Process

class Plays:
    def play(self, task):
        return task

if __name__ == "__main__":
    worker = Process(Plays)
    future = worker.play("played")
    # It imports what it needs by now: that takes longer than this.
    time.sleep(0.2)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.killpg(os.getpgrp(), signal.SIGINT)
    print(future.result(60))
    worker.close()
"""


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="needs groups of processes")
def test_a_worker_that_begins_does_not_hear_of_ctrl_c(tmp_path: Path) -> None:
    path = tmp_path / "main.py"
    path.write_text(_MAIN, encoding="utf-8")
    done = subprocess.run([sys.executable, path], capture_output=True, text=True, start_new_session=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "played\n", "")
