"""The guide on massively parallel simulators: its program trains, and its steps keep all data on the device."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import torch

from tests.docs.blocks import DOCS, ROOT, blocks

pytest.importorskip("rsl_rl")

PROGRAM, PRINTED = blocks(DOCS / "guides" / "rsl-rl.md")
LINE = re.compile(r" *\d+ iterations: +\d+ episodes, +[\d.]+% met")


@pytest.fixture
def errand(tmp_path: Path) -> dict[str, Any]:
    """The names that the program of the guide defines."""
    path = tmp_path / "errand.py"
    path.write_text(PROGRAM.text, encoding="utf-8")
    return runpy.run_path(str(path))


@pytest.mark.slow
def test_the_program_prints_lines_of_the_form_shown(tmp_path: Path) -> None:
    short = PROGRAM.text.replace("train(4096, 8, DEVICE)", "train(256, 2, DEVICE)").replace("learn(15)", "learn(1)")
    assert short != PROGRAM.text
    (tmp_path / "errand.py").write_text(short, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    command = [sys.executable, "errand.py"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()[-2:]
    assert all(map(LINE.fullmatch, [*lines, *PRINTED.text.splitlines()]))


def test_a_step_does_not_read_values(errand: dict[str, Any]) -> None:
    """Tensors on the device "meta" have no values, so reading one raises an error."""
    env = errand["Plane"](4096, "meta")
    for _ in range(2):
        observation, reward, done, extras = env.step(torch.empty(4096, 2, device="meta"))
        results = [observation["policy"], reward, done, extras["time_outs"], env.episode_length_buf, env.ended]
        assert {result.device.type for result in results} == {"meta"}


@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU is at hand")
def test_a_step_does_not_wait_for_a_gpu(errand: dict[str, Any]) -> None:
    env = errand["Plane"](4096, "cuda")
    actions = torch.zeros(4096, 2, device="cuda")
    torch.cuda.set_sync_debug_mode("error")
    try:
        for _ in range(3):
            env.step(actions)
    finally:
        torch.cuda.set_sync_debug_mode("default")


def test_a_steered_robot_satisfies_the_spec_and_starts_again(errand: dict[str, Any]) -> None:
    """Steer the first robot to the dock, around the zone, to the goal.

    The second robot drives straight into the zone.
    """
    torch.manual_seed(1)
    env = errand["Plane"](2, "cpu")
    env.position = torch.tensor([[-3.0, 1.0], [0.0, 1.0]])
    up, right, down = (0.0, 1.0), (1.0, 0.0), (0.0, -1.0)
    actions = [up] * 12 + [right] * 20 + [down] * 10
    totals, first_totals = torch.zeros(2), dict[int, float]()
    for action in actions:
        _, reward, done, extras = env.step(10 * torch.tensor([action, up]))
        totals += reward
        assert not extras["time_outs"].any()
        for robot in done.nonzero()[:, 0].tolist():
            first_totals.setdefault(robot, float(totals[robot]))
        if 0 in first_totals:
            break
    assert first_totals[1] < 0 < 0.5 < first_totals[0]
    assert int(env.ended[1]) == 1
    assert env.position[0, 1] <= 0 and env.monitor.state[0] == 0 and env.monitor.progress[0] == 0
