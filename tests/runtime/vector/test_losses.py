"""Lost workers are reported, the run stops or continues, and no process or memory remains."""

from __future__ import annotations

import logging
import os
import signal
import subprocess
import sys
import threading
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gymnasium.error import ClosedEnvironmentError, ResetNeeded

from tests.docs.blocks import ROOT
from tests.runtime.vector.clock import Clock
from tests.runtime.vector.envs import (
    EXIT,
    GO,
    HANG,
    HOLD,
    RAISE,
    Ending,
    Fragile,
    Held,
    Launched,
    Unmade,
    leaves_its_level,
)
from tests.waiting import HANG_S, is_running, until, until_gone
from tltl_runtime.vector import WorkerError, WorkerVectorEnv
from tltl_runtime.vector.errors import Loss


def fragile(workers: int, count: int = 2, **options: Any) -> WorkerVectorEnv:
    env = WorkerVectorEnv([Fragile] * count, workers, **{"timeout": HANG_S, **options})
    env.reset(seed=40)
    return env


def kill(pid: int | None) -> None:
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    until_gone([pid])


def time_out_with(env: WorkerVectorEnv, silent: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a silent worker time out as soon as it is the only one that has not answered."""
    pending: set[int] = env._workers._pending  # type: ignore[assignment]
    monkeypatch.setattr("tltl_runtime.vector.workers.time", Clock(lambda: pending == {silent}))


def error_of_loss(env: WorkerVectorEnv, *actions: list[int]) -> WorkerError:
    """Take steps until a worker is lost; check that the environment is closed and all workers are gone."""
    pids = [pid for pid in env.worker_pids if pid]
    with pytest.raises(WorkerError) as caught:
        for batch in actions:
            env.step(np.array(batch))
    assert env.closed
    until_gone(pids)
    with pytest.raises(ClosedEnvironmentError):
        env.step(np.array(actions[0]))
    return caught.value


def test_the_program_of_a_lost_worker_is_killed(tmp_path: Path) -> None:
    env = WorkerVectorEnv([partial(Launched, tmp_path)], 1, timeout=HANG_S)
    env.reset(seed=0)
    program = int((tmp_path / "program").read_text(encoding="utf-8"))
    assert is_running(program)
    error_of_loss(env, [EXIT])
    until_gone([program])


def test_a_program_ends_if_the_process_of_the_environment_is_killed(tmp_path: Path) -> None:
    code = f"""
import time
from functools import partial
from pathlib import Path
from tests.runtime.vector.envs import Launched
from tltl_runtime.vector import WorkerVectorEnv

env = WorkerVectorEnv([partial(Launched, Path({str(tmp_path)!r}))], 1, timeout={HANG_S})
env.reset(seed=0)
print("ready", flush=True)
time.sleep({HANG_S})
"""
    path = os.pathsep.join([str(ROOT), str(ROOT / "runtime")])
    words, environment = [sys.executable, "-c", code], {**os.environ, "PYTHONPATH": path}
    with subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.kill()
    until_gone([int((tmp_path / "program").read_text(encoding="utf-8"))])


def test_a_worker_without_a_status_had_to_be_killed() -> None:
    assert str(Loss(0)) == "worker 0 closed its connection without ending, and was killed"


def test_a_worker_that_exits_is_reported_with_its_status() -> None:
    error = error_of_loss(fragile(1), *[[GO, GO]] * 9, [GO, EXIT])
    assert str(error).splitlines() == [
        "worker 0 ended with exit status 3; its environments were",
        "  env 0: Fragile, seed 40, episode 2, step 3",
        "  env 1: Fragile, seed 41, episode 2, step 3 (at work)",
    ]
    assert (error.loss.status, error.playing[1].seed, error.playing[1].step) == (3, 41, 3)


def test_a_worker_that_is_killed_between_two_steps_is_reported() -> None:
    env = fragile(2)
    kill(env.worker_pids[1])
    error = error_of_loss(env, [GO, GO])
    assert str(error).splitlines()[:1] == ["worker 1 was killed by SIGKILL; its environments were"]
    assert [playing.env for playing in error.playing] == [1]


def test_a_worker_that_raises_is_reported_with_its_traceback() -> None:
    error = error_of_loss(fragile(2, names=["left", "right"]), [GO, GO], [RAISE, GO])
    lines = str(error).splitlines()
    assert lines[:3] == [
        "worker 0 ended with an exception; its environments were",
        "  env 0: left, seed 40, episode 1, step 2 (at work)",
        "Traceback (most recent call last):",
    ]
    assert lines[-1] == "RuntimeError: the bridge is out"


def test_a_silent_worker_is_reported_and_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    env = fragile(2)
    time_out_with(env, 1, monkeypatch)
    error = error_of_loss(env, [GO, HANG])
    message = f"worker 1 was silent for {HANG_S:g} s, and was killed; its environments were\n  env 1: Fragile, seed 41"
    assert str(error).startswith(message)


def test_a_silent_worker_is_reported_though_another_answers_and_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    env = WorkerVectorEnv([Fragile, Ending], 2, timeout=HANG_S)
    env.reset(seed=40)
    pending: set[int] = env._workers._pending  # type: ignore[assignment]
    ending_pids = [pid for pid in env.worker_pids[1:] if pid]

    def is_over() -> bool:
        if pending != {0}:
            return False
        until_gone(ending_pids)
        return True

    monkeypatch.setattr("tltl_runtime.vector.workers.time", Clock(is_over))
    error = error_of_loss(env, [HANG, GO])
    assert str(error).startswith(f"worker 0 was silent for {HANG_S:g} s, and was killed")


def test_an_error_of_the_game_is_reported_with_its_traceback() -> None:
    env = WorkerVectorEnv([leaves_its_level], names=["navigation v0"])
    env.reset(seed=3)
    error = error_of_loss(env, *[[[1, 1, 0, 0, 0]]] * 20)
    assert "env 0: navigation v0, seed 3, episode 1, step " in str(error)
    assert "WorldError: level navigation v0, step " in str(error)


def test_an_environment_that_cannot_be_made_is_reported() -> None:
    with pytest.raises(WorkerError, match="no room for another") as caught:
        WorkerVectorEnv([partial(Unmade, os.getpid())])
    assert "env 0: Unmade, not reset yet" in str(caught.value)


def test_a_lost_worker_is_replaced(caplog: pytest.LogCaptureFixture) -> None:
    """The environments of the other workers are not affected."""
    plain, env = fragile(2, 4), fragile(2, 4, on_death="replace")
    actions = np.zeros(4, dtype=np.int64)
    for step in range(1, 20):
        killed = step == 10
        if killed:
            kill(env.worker_pids[1])
        with caplog.at_level(logging.WARNING):
            expected, (observations, rewards, terminated, truncated, infos) = plain.step(actions), env.step(actions)
        assert np.array_equal(observations["pair"][0][:2], expected[0]["pair"][0][:2])
        assert list(rewards[:2]) == list(expected[1][:2]) and not truncated[:2].any()
        if killed:
            assert list(infos["lost"]) == [False, False, True, True]
            assert list(truncated) == [False, False, True, True] and not terminated.any()
            assert list(rewards[2:]) == [0.0, 0.0] and list(observations["count"][2:]) == [0, 0]
            assert [final["count"] for final in infos["final_obs"][2:]] == [2, 2]
            seeds = env.call("seeds")[2:]
            assert f"another worker begins with seeds {[env_seeds[0] for env_seeds in seeds]}" in caplog.text
            assert (
                "worker 1 was killed by SIGKILL; its environments were\n  env 2: Fragile, seed 42, episode 2, step 2"
                in caplog.text
            )
        else:
            assert "lost" not in infos
    assert list(observations["count"][2:]) == [2, 2]
    plain.close()
    env.close()


def test_a_worker_that_is_lost_again_at_once_stops_the_run() -> None:
    env = fragile(1, 1, on_death="replace")
    assert list(env.step(np.array([EXIT]))[3]) == [True]
    assert "exit status 3" in str(error_of_loss(env, [EXIT]))
    env = WorkerVectorEnv([partial(Fragile, dies_in_reset=True)], on_death="replace")
    with pytest.raises(WorkerError, match="exit status 5"):
        env.reset(seed=1)


def test_an_interrupted_step_must_be_followed_by_a_reset(tmp_path: Path) -> None:
    env = WorkerVectorEnv([partial(Held, tmp_path)], 1, timeout=HANG_S)
    env.reset(seed=40)

    def interrupt(*_: Any) -> None:
        raise KeyboardInterrupt

    def alarm() -> None:
        until(lambda: list(tmp_path.glob("held-*")), "a step that is under way")
        os.kill(os.getpid(), signal.SIGALRM)

    before = signal.signal(signal.SIGALRM, interrupt)
    thread = threading.Thread(target=alarm)
    try:
        with pytest.raises(KeyboardInterrupt):
            thread.start()
            env.step(np.array([HOLD]))
    finally:
        thread.join()
        signal.signal(signal.SIGALRM, before)
        (tmp_path / "released").touch()
    with pytest.raises(ResetNeeded, match="interrupted"):
        env.step(np.array([GO]))
    env.reset(seed=2)
    assert list(env.step(np.array([GO]))[1]) == [1.0]
    env.close()


SCRIPT = """
import sys
from functools import partial
from pathlib import Path
import numpy as np
from tests.runtime.vector.envs import HOLD, Held
from tltl_runtime.vector import WorkerVectorEnv

if __name__ == "__main__":
    env = WorkerVectorEnv([partial(Held, Path(sys.argv[2]))] * 2, 2)
    env.reset(seed=1)
    print(*env.worker_pids, flush=True)
    if sys.argv[1] == "step":
        env.step(np.array([HOLD, HOLD]))
    if sys.argv[1] == "forget":
        env = None
        print("forgotten", flush=True)
        sys.stdin.read()
"""


@pytest.mark.parametrize("how", ["exit", "forget", "interrupt", "kill"])
def test_no_process_and_no_shared_memory_remains(how: str, tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    mode = how if how in ("exit", "forget") else "step"
    child = subprocess.Popen(
        [sys.executable, str(script), mode, str(tmp_path)],
        env=environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        start_new_session=True,
    )
    assert child.stdout is not None
    pids = [int(pid) for pid in child.stdout.readline().split()]
    assert len(pids) == 2
    if how == "forget":
        assert child.stdout.readline() == "forgotten\n"
        until_gone(pids)
    if mode == "step":
        until(lambda: len(list(tmp_path.glob("held-*"))) == 2, "workers that are in a step")
    if how == "interrupt":
        os.killpg(child.pid, signal.SIGINT)
    if how == "kill":
        child.kill()
    (tmp_path / "released").touch()
    _, errors = child.communicate(timeout=HANG_S)
    until_gone(pids)
    assert child.returncode == {"interrupt": -signal.SIGINT, "kill": -signal.SIGKILL}.get(how, 0), errors
    assert ("KeyboardInterrupt" in errors) is (how == "interrupt") and "leaked" not in errors
    # Python gives shared memory these names.
    assert [path for pid in (child.pid, *pids) for path in Path("/dev/shm").glob(f"pym-{pid}-*")] == []
