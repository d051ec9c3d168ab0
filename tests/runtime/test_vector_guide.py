"""The guide on vector environments: its programs and its error message are real."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import pytest

from tests.docs.blocks import DOCS, blocks
from tests.runtime.guides import check_program
from tests.waiting import until_gone
from tltl_runtime.vector import WorkerError, make_vec

PAGE = DOCS / "guides" / "vector.md"


def test_the_programs_print_the_output_shown(tmp_path: Path) -> None:
    page_blocks = blocks(PAGE)
    assert [block.kind for block in page_blocks] == ["python", "", "python", ""]
    for program, printed in zip(page_blocks[::2], page_blocks[1::2], strict=True):
        check_program(program, printed, tmp_path / "program.py")


def test_the_guide_shows_the_real_error_message() -> None:
    envs = make_vec("cover_and_hide", "v0", num_envs=4, workers=2)
    envs.reset(seed=5)
    stay = np.zeros((4, 5), dtype=np.int64)
    for _ in range(12):
        envs.step(stay)
    pid = envs.worker_pids[1]
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    until_gone([pid])
    with pytest.raises(WorkerError) as caught:
        envs.step(stay)
    message = f"WorkerError: {caught.value}".replace("\n", "\n    ")
    assert f"    {message}\n\n" in PAGE.read_text(encoding="utf-8")
