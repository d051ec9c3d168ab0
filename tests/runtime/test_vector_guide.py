"""The guide on vector environments: its programs are run, its messages are those."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.docs.blocks import DOCS, ROOT, blocks
from tltl_runtime.vector import WorkerError, make_vec

PAGE = DOCS / "guides" / "vector.md"


def test_its_programs_print_what_it_says(tmp_path: Path) -> None:
    found = blocks(PAGE)
    assert [block.kind for block in found] == ["python", "", "python", ""]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    for program, printed in zip(found[::2], found[1::2], strict=True):
        (tmp_path / "program.py").write_text(program.text, encoding="utf-8")
        done = subprocess.run(
            [sys.executable, "program.py"],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            encoding="utf-8",
            timeout=60,
            check=False,
        )
        assert (done.stdout, done.returncode) == (printed.text, 0), done.stderr


def test_its_message_is_that() -> None:
    envs = make_vec("cover_and_hide", "v0", num_envs=4, workers=2)
    envs.reset(seed=5)
    stay = np.zeros((4, 5), dtype=np.int64)
    for _ in range(12):
        envs.step(stay)
    pid = envs.worker_pids[1]
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    with pytest.raises(WorkerError) as caught:
        envs.step(stay)
    said = f"WorkerError: {caught.value}".replace("\n", "\n    ")
    assert f"    {said}\n\n" in PAGE.read_text(encoding="utf-8")
