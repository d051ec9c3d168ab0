"""Workers that are lost are reported, the run stops or goes on, and nothing is left behind."""

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
from tests.runtime.vector.envs import EXIT, GO, HANG, HOLD, RAISE, Ending, Fragile, Held, Unmade, leaves_its_level
from tests.waiting import HANG_S, until, until_gone
from tltl_runtime.vector import WorkerError, WorkerVectorEnv


def fragile(workers: int, count: int = 2, **options: Any) -> WorkerVectorEnv:
    env = WorkerVectorEnv([Fragile] * count, workers, **{"timeout": HANG_S, **options})
    env.reset(seed=40)
    return env


def kill(pid: int | None) -> None:
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    until_gone([pid])


def patience_ends_with(env: WorkerVectorEnv, silent: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the time of a silent worker be over as soon as nobody else is waited for."""
    asked: set[int] = env._workers._asked  # type: ignore[assignment]
    monkeypatch.setattr("tltl_runtime.vector.workers.time", Clock(lambda: asked == {silent}))


def lost(env: WorkerVectorEnv, *actions: list[int]) -> WorkerError:
    pids = [pid for pid in env.worker_pids if pid]
    with pytest.raises(WorkerError) as caught:
        for each in actions:
            env.step(np.array(each))
    assert env.closed
    until_gone(pids)
    with pytest.raises(ClosedEnvironmentError):
        env.step(np.array(actions[0]))
    return caught.value


def test_one_that_exits() -> None:
    error = lost(fragile(1), *[[GO, GO]] * 9, [GO, EXIT])
    assert str(error).splitlines() == [
        "worker 0 ended with exit status 3; it had",
        "  env 0: Fragile, seed 40, episode 2, step 3",
        "  env 1: Fragile, seed 41, episode 2, step 3 (at work)",
    ]
    assert (error.loss.status, error.playing[1].seed, error.playing[1].step) == (3, 41, 3)


def test_one_that_is_killed_between_two_steps() -> None:
    env = fragile(2)
    kill(env.worker_pids[1])
    error = lost(env, [GO, GO])
    assert str(error).splitlines()[:1] == ["worker 1 was killed by SIGKILL; it had"]
    assert [each.env for each in error.playing] == [1]


def test_one_that_raises() -> None:
    error = lost(fragile(2, names=["left", "right"]), [GO, GO], [RAISE, GO])
    lines = str(error).splitlines()
    assert lines[:3] == [
        "worker 0 ended with an exception; it had",
        "  env 0: left, seed 40, episode 1, step 2 (at work)",
        "Traceback (most recent call last):",
    ]
    assert lines[-1] == "RuntimeError: the bridge is out"


def test_one_that_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    env = fragile(2)
    patience_ends_with(env, 1, monkeypatch)
    error = lost(env, [GO, HANG])
    silent = f"worker 1 was silent for {HANG_S:g} s, and was killed; it had\n  env 1: Fragile, seed 41"
    assert str(error).startswith(silent)


def test_one_that_answers_and_ends_does_not_keep_the_silent_from_being_found(monkeypatch: pytest.MonkeyPatch) -> None:
    env = WorkerVectorEnv([Fragile, Ending], 2, timeout=HANG_S)
    env.reset(seed=40)
    asked: set[int] = env._workers._asked  # type: ignore[assignment]
    ending = [pid for pid in env.worker_pids[1:] if pid]

    def is_over() -> bool:
        if asked != {0}:
            return False
        until_gone(ending)
        return True

    monkeypatch.setattr("tltl_runtime.vector.workers.time", Clock(is_over))
    error = lost(env, [HANG, GO])
    assert str(error).startswith(f"worker 0 was silent for {HANG_S:g} s, and was killed")


def test_a_body_that_leaves_its_level() -> None:
    env = WorkerVectorEnv([leaves_its_level], names=["navigation v0"])
    env.reset(seed=3)
    error = lost(env, *[[[1, 1, 0, 0, 0]]] * 20)
    assert "env 0: navigation v0, seed 3, episode 1, step " in str(error)
    assert "WorldError: level navigation v0, step " in str(error)


def test_an_environment_that_cannot_be_made() -> None:
    with pytest.raises(WorkerError, match="no room for another") as caught:
        WorkerVectorEnv([partial(Unmade, os.getpid())])
    assert "env 0: Unmade, not reset yet" in str(caught.value)


def test_another_takes_its_place(caplog: pytest.LogCaptureFixture) -> None:
    """The other workers' environments are not disturbed."""
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
            assert f"another begins with seeds {[each[0] for each in seeds]}" in caplog.text
            assert "worker 1 was killed by SIGKILL; it had\n  env 2: Fragile, seed 42, episode 2, step 2" in caplog.text
        else:
            assert "lost" not in infos
    assert list(observations["count"][2:]) == [2, 2]
    plain.close()
    env.close()


def test_one_that_is_lost_again_at_once_stops_the_run() -> None:
    env = fragile(1, 1, on_death="replace")
    assert list(env.step(np.array([EXIT]))[3]) == [True]
    assert "exit status 3" in str(lost(env, [EXIT]))
    env = WorkerVectorEnv([partial(Fragile, dies_in_reset=True)], on_death="replace")
    with pytest.raises(WorkerError, match="exit status 5"):
        env.reset(seed=1)


def test_after_a_step_was_interrupted_only_a_reset_is_of_use(tmp_path: Path) -> None:
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
def test_no_process_and_no_memory_is_left(how: str, tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    what = how if how in ("exit", "forget") else "step"
    child = subprocess.Popen(
        [sys.executable, str(script), what, str(tmp_path)],
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
    if what == "step":
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
    # As Python names what processes share.
    assert [path for pid in (child.pid, *pids) for path in Path("/dev/shm").glob(f"pym-{pid}-*")] == []
