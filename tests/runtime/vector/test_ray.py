"""Actors of a Ray cluster give the same steps as worker processes, bit for bit, and are replaced like them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from functools import partial
from typing import Any

import numpy as np
import pytest

from tests.runtime.own_cluster import CORES, needs_ray, own_cluster
from tests.runtime.vector.clock import Clock
from tests.runtime.vector.envs import EXIT, GO, HANG, RAISE, Fragile
from tests.runtime.vector.test_vector import COUNT, SPEC, equal_values, results_of_steps
from tests.waiting import HANG_S, until
from tltl_runtime.vector import WorkerError, WorkerVectorEnv, make_vec
from tltlc.diagnostics.diagnostic import TltlError

pytestmark = [needs_ray, pytest.mark.slow]


@pytest.fixture(scope="module", autouse=True)
def ray_here() -> Iterator[None]:
    """A cluster for all tests of this module."""
    with own_cluster():
        yield


@pytest.fixture(autouse=True)
def _all_cores_are_free(ray_here: None) -> None:
    """Wait until all cores are free: Ray frees a core some time after its actor was killed."""
    import ray

    until(lambda: ray.available_resources().get("CPU", 0) == CORES, "cores that are all free")


def test_processes_of_torchrun_share_the_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WORLD_SIZE", str(CORES))
    with closing(WorkerVectorEnv([Fragile] * (2 * CORES), "ray", timeout=HANG_S)) as env:
        assert len(env.worker_pids) == 1
        env.reset(seed=1)
        assert list(env.step(np.full(2 * CORES, GO))[1]) == [1.0] * (2 * CORES)


def test_ray_gives_the_same_steps_as_local_workers() -> None:
    rows = results_of_steps(make_vec("cover_and_hide", "v2", COUNT, "ray", spec=SPEC))
    expected_rows = results_of_steps(make_vec("cover_and_hide", "v2", COUNT, 2, spec=SPEC))
    for ours, theirs in zip(rows, expected_rows, strict=True):
        assert all(map(equal_values, ours, theirs))


def test_an_actor_that_raises_is_reported_with_its_traceback() -> None:
    env = WorkerVectorEnv([Fragile] * 2, "ray", timeout=HANG_S)
    env.reset(seed=[4, 8])
    env.step(np.array([GO, GO]))
    with pytest.raises(WorkerError) as error:
        env.step(np.array([GO, RAISE]))
    assert "the bridge is out" in str(error.value)
    assert "seed 8, episode 1, step 1" in str(error.value)


def test_a_lost_actor_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    env = WorkerVectorEnv([Fragile] * 2, "ray", on_death="replace", timeout=HANG_S)
    pending: dict[Any, int] = env._workers._pending  # type: ignore[assignment]
    clock = Clock(lambda: set(pending.values()) == {1})
    env.reset(seed=[4, 8])
    for action in (EXIT, HANG):
        if action == HANG:
            monkeypatch.setattr("tltl_runtime.vector.ray_workers.time", clock)
        *_, truncated, infos = env.step(np.array([GO, action]))
        assert truncated[1]
        assert infos["lost"][1]
        *_, truncated, infos = env.step(np.array([GO, GO]))
        assert not truncated.any()
    env.close()


def test_a_cluster_without_a_free_core_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    monkeypatch.setattr("tltl_runtime.vector.ray_workers.TO_START_S", 2.0)
    busy = ray.remote(num_cpus=ray.cluster_resources()["CPU"])(Fragile).remote()
    ray.get(busy.__ray_ready__.remote())
    with pytest.raises(TltlError, match=r"no worker started within 2 s on the Ray cluster, which has \d+ cores?"):
        WorkerVectorEnv([Fragile], "ray", timeout=2.0)
    ray.kill(busy)


def test_the_message_for_a_slow_actor_does_not_say_that_no_core_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ray does not distinguish an actor that is slow to start from one that waits for a core."""
    import ray

    monkeypatch.setattr("tltl_runtime.vector.ray_workers.TO_START_S", 2.0)
    monkeypatch.setattr("tltl_runtime.vector.cluster.time", Clock(lambda: True))
    monkeypatch.setattr(ray, "wait", lambda actors, **_: ([], actors))
    with pytest.raises(TltlError) as error:
        WorkerVectorEnv([Fragile], "ray", timeout=2.0)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.title == f"no worker started within 2 s on the Ray cluster, which has {CORES} cores"
    assert "whether others use the cores" in str(diagnostic.help)


def test_environments_are_spread_over_the_actors_that_start(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    started, wait = [], ray.wait

    def recorded_wait(*arguments: Any, **options: Any) -> Any:
        started[:], waiting = wait(*arguments, **options)
        return list(started), waiting

    monkeypatch.setattr(ray, "wait", recorded_wait)
    monkeypatch.setattr("tltl_runtime.vector.ray_workers.free_cores", lambda _: CORES + 1)
    with monkeypatch.context() as patch:
        # The wait for the actor without a core ends once all others have started.
        patch.setattr("tltl_runtime.vector.cluster.time", Clock(lambda: len(started) == CORES))
        env = WorkerVectorEnv([Fragile] * (2 * CORES + 2), "ray", timeout=HANG_S)
    with closing(env):
        assert len(env.worker_pids) == CORES
        env.reset(seed=1)
        assert list(env.step(np.full(2 * CORES + 2, GO))[1]) == [1.0] * (2 * CORES + 2)


def test_an_environment_that_cannot_be_made_is_reported() -> None:
    with pytest.raises(WorkerError, match="no room"):
        WorkerVectorEnv([Fragile, partial(missing, True)], "ray")


def missing(_: bool) -> Fragile:
    raise RuntimeError("no room for another")
