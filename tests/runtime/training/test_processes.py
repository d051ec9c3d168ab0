"""Trainings in separate processes: killed ones, and several that train together."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import Any

import pytest

from tests.runtime.training import runs
from tests.runtime.training.runs import run_in
from tests.waiting import HANG_S, children, until_gone
from tltl_runtime.policies.file import read_policy
from tltl_runtime.training.files.checkpoint import read_checkpoint
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.run_file import CHECKPOINT, POLICY, RUN, identity

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
PROGRAM = ["-c", f"import sys; from {runs.__name__} import main; main(*sys.argv[1:])"]
"""The program as a string; worker processes would import a file, and torch, again."""
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}


@contextmanager
def _started(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, *arguments]
    with subprocess.Popen(
        command, env=ENVIRONMENT, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def _lines(process: subprocess.Popen[str]) -> list[dict[str, Any]]:
    """Wait for the processes to end; return the lines of JSON that they printed."""
    output, errors = process.communicate(timeout=HANG_S)
    assert process.returncode == 0, errors
    return [json.loads(line) for line in output.splitlines()]


@pytest.mark.skipif(sys.platform != "linux", reason="looks at processes as Linux shows them")
def test_a_training_killed_at_any_time_resumes_from_its_last_checkpoint(tmp_path: Path) -> None:
    random, steps = Random(0), 64 * 400
    run = run_in(tmp_path / "run", stop__steps=steps)
    reported = 0
    for kill in range(3):
        resume = ["--resume"] if kill else []
        with _started(*PROGRAM, str(run.folder), *resume, f"stop__steps={steps}") as process:
            assert process.stdout is not None
            first = json.loads(process.stdout.readline())
            assert first["number"] == reported + 1
            output = [process.stdout.readline().rstrip() for _ in range(random.randrange(12))]
            workers = children(process.pid)
            process.send_signal(signal.SIGKILL)
            output += process.stdout.read().splitlines()
        # Each iteration writes a checkpoint before it is reported, and the last line may be incomplete.
        reported = max((json.loads(line)["number"] for line in output if line.endswith("}")), default=first["number"])
        checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
        assert checkpoint is not None
        assert reported <= checkpoint.iteration <= reported + 1
        assert checkpoint.steps == 64 * checkpoint.iteration
        measured = [line["iteration"] for line in read_metrics(run.folder / METRICS)]
        assert measured in (
            list(range(1, checkpoint.iteration + 1)),
            list(range(1, checkpoint.iteration + 2)),
        )
        assert workers
        until_gone(workers)
        reported = checkpoint.iteration
    last = reported + 3
    with _started(*PROGRAM, str(run.folder), "--resume", f"stop__steps={64 * last}") as process:
        lines = _lines(process)
    assert [line["number"] for line in lines] == [reported + 1, reported + 2, reported + 3]
    assert [line["iteration"] for line in read_metrics(run.folder / METRICS)] == list(range(1, last + 1))
    assert read_policy(run.folder / POLICY).card.level == "cover_and_hide"


def test_a_killed_training_loses_the_iterations_after_its_last_checkpoint(tmp_path: Path) -> None:
    """One checkpoint is written before the first iteration; the next one would follow hours later."""
    run = run_in(tmp_path / "run", checkpoint_s=7200.0, stop__steps=10**6)
    arguments = [str(run.folder), "checkpoint_s=7200.0"]
    with _started(*PROGRAM, *arguments, "stop__steps=1000000") as process:
        assert process.stdout is not None
        numbers = [json.loads(process.stdout.readline())["number"] for _ in range(4)]
        process.send_signal(signal.SIGKILL)
    assert numbers == [1, 2, 3, 4]
    assert len(read_metrics(run.folder / METRICS)) >= 4
    checkpoint = read_checkpoint(run.folder / CHECKPOINT, identity(run))
    assert checkpoint is not None
    assert checkpoint.iteration == 0
    with _started(*PROGRAM, *arguments, "stop__steps=64", "--resume") as process:
        (line,) = _lines(process)
    assert (line["number"], line["stop"]) == (1, "steps")
    assert len(read_metrics(run.folder / METRICS)) == 1


def test_a_training_killed_in_its_search_restarts_the_search(tmp_path: Path) -> None:
    spec = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
    arguments = [f"spec={json.dumps(spec)}", "exploration__ways=100000", "exploration__steps=20000", "stop__steps=64"]
    folder = tmp_path / "run"
    with _started(*PROGRAM, str(folder), *arguments, "--wait-in-search") as process:
        assert process.stdout is not None
        assert json.loads(process.stdout.readline())["searched"] > 0
        process.send_signal(signal.SIGKILL)
    assert (folder / RUN).exists()
    assert not (folder / CHECKPOINT).exists()
    with _started(*PROGRAM, str(folder), *arguments, "--resume") as process:
        (line,) = _lines(process)
    assert (line["number"], line["stop"]) == (1, "steps")


def _together(folder: Path, *arguments: str) -> list[dict[str, Any]]:
    """Train in two processes of torchrun; check that both print the same lines, and return them."""
    torchrun = ["-m", "torch.distributed.run", "--standalone", "--nproc_per_node", "2", "--no-python", sys.executable]
    runner = 'classes__runner="tests.runtime.training.runs:WeightPrinting"'
    with _started(*torchrun, *PROGRAM, str(folder), runner, *arguments) as process:
        lines = _lines(process)
    one, other = ([{**line, "rank": None} for line in lines if line["rank"] == rank] for rank in "01")
    assert one == other
    return one


def test_processes_of_torchrun_learn_the_same_and_end_together(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    started = _together(folder, "rollout__steps=64", "stop__steps=1536")
    resumed = _together(folder, "rollout__steps=64", "stop__steps=2048", "--resume")
    reports = [line for line in started + resumed if "number" in line]
    # Steps are the sum of both processes: 2 processes, 4 environments, 64 decisions.
    assert [(line["number"], line["steps"], line["stop"]) for line in reports] == [
        (1, 512, None),
        (2, 1024, None),
        (3, 1536, "steps"),
        (4, 2048, "steps"),
    ]
    assert len({line["weights"] for line in started + resumed if "weights" in line}) == 4
    assert [line["iteration"] for line in read_metrics(folder / METRICS)] == [1, 2, 3, 4]


def test_only_the_first_process_of_a_command_prints(tmp_path: Path) -> None:
    settings = "[rollout]\nenvs = 4\nsteps = 16\n[network]\nhidden = [16]\nchannels = [4]\n[exploration]\nways = 0\n"
    (tmp_path / "small.toml").write_text(settings, encoding="utf-8")
    torchrun = ["-m", "torch.distributed.run", "--standalone", "--nproc_per_node", "2"]
    # The spec cannot be met on this level, which gives a warning.
    train = ["-m", "tltlc", "train", "--level", "navigation:v2", "--config", str(tmp_path / "small.toml")]
    limits = ["--steps", "256", "--workers", "1", "--out", str(tmp_path / "run")]
    with _started(*torchrun, *train, *limits) as process:
        output, errors = process.communicate(timeout=HANG_S)
    assert output.count("ended by the limit of steps after 256 steps") == 1, errors
    assert errors.count("training navigation on navigation:v2") == 1
    assert errors.count("nobody can reach `s2`") == 1
    assert read_policy(tmp_path / "run" / POLICY).card.variant == "v2"


def test_processes_of_torchrun_imitate_their_own_demonstrations_together(tmp_path: Path) -> None:
    # A spec that every policy meets after eight steps.
    spec = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
    changes = {"exploration__ways": 2, "exploration__parts": 4, "stop__episodes": 10**5}
    arguments = [f"spec={json.dumps(spec)}", *(f"{name}={value}" for name, value in changes.items())]
    folder, ways, replayed, weights = tmp_path / "run", [], [], set()
    for steps, resume in ((256, []), (512, ["--resume"])):
        lines = _together(folder, *arguments, f"stop__steps={steps}", *resume)
        weights |= {line["weights"] for line in lines if "weights" in line}
        run = run_in(folder, spec, **changes, classes__runner="tests.runtime.training.runs:WeightPrinting")
        checkpoint = read_checkpoint(folder / CHECKPOINT, identity(run))
        assert checkpoint is not None
        ways.append([{*process["way_seeds"].tolist()} for process in checkpoint.processes])
        replayed.append(checkpoint.replayed)
    assert len(weights) == 4
    # Steps are the sum of both processes: 2 processes, 4 environments, 16 decisions.
    measured = read_metrics(folder / METRICS)
    assert [line["steps"] for line in measured] == [128, 256, 384, 512]
    assert any("imitation" in line["losses"] for line in measured)
    assert 0 < replayed[0] < replayed[1]
    started, resumed = ways
    assert started[0].isdisjoint(started[1])
    for first, later in zip(started, resumed, strict=True):
        assert first
        assert first <= later


def test_processes_of_torchrun_imitate_the_same_demonstrations(tmp_path: Path) -> None:
    spec = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
    changes = {"method": "imitation", "imitation__demonstrations": 2, "imitation__cloning": 0.5}
    arguments = [f"spec={json.dumps(spec)}", *(f"{name}={json.dumps(value)}" for name, value in changes.items())]
    lines = _together(tmp_path / "run", *arguments, "stop__steps=512", "stop__episodes=100000")
    assert len({line["weights"] for line in lines if "weights" in line}) == 4
    # Steps are the sum of both processes: 2 processes, 4 environments, 16 decisions.
    losses = [line["losses"].keys() for line in read_metrics(tmp_path / "run" / METRICS)]
    assert ["cloning" in keys for keys in losses] == [True, True, False, False]
    assert len(list((tmp_path / "run" / "demonstrations").iterdir())) == 2
