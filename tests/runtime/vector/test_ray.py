"""Actors of a Ray cluster give what worker processes give, bit for bit, and are missed alike."""

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
from tests.runtime.vector.test_vector import COUNT, SPEC, played, same
from tests.waiting import HANG_S, until
from tltl_runtime.vector import WorkerError, WorkerVectorEnv, make_vec
from tltlc.diagnostics.diagnostic import TltlError

pytestmark = needs_ray


@pytest.fixture(scope="module", autouse=True)
def ray_here() -> Iterator[None]:
    """A cluster for all tests of this module."""
    with own_cluster():
        yield


@pytest.fixture(autouse=True)
def _all_cores_are_free(ray_here: None) -> None:
    """Ray counts a core as free some time after its actor was killed."""
    import ray

    until(lambda: ray.available_resources().get("CPU", 0) == CORES, "cores that are all free")


def test_processes_of_torchrun_share_the_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WORLD_SIZE", str(CORES))
    with closing(WorkerVectorEnv([Fragile] * (2 * CORES), "ray", timeout=HANG_S)) as env:
        assert len(env.worker_pids) == 1
        env.reset(seed=1)
        assert list(env.step(np.full(2 * CORES, GO))[1]) == [1.0] * (2 * CORES)


def test_the_same_as_local_workers() -> None:
    found = played(make_vec("cover_and_hide", "v2", COUNT, "ray", spec=SPEC))
    expected = played(make_vec("cover_and_hide", "v2", COUNT, 2, spec=SPEC))
    for ours, theirs in zip(found, expected, strict=True):
        assert all(map(same, ours, theirs))


def test_one_that_raises() -> None:
    env = WorkerVectorEnv([Fragile] * 2, "ray", timeout=HANG_S)
    env.reset(seed=[4, 8])
    env.step(np.array([GO, GO]))
    with pytest.raises(WorkerError) as found:
        env.step(np.array([GO, RAISE]))
    assert "the bridge is out" in str(found.value)
    assert "seed 8, episode 1, step 1" in str(found.value)


def test_another_takes_the_place_of_one_that_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    env = WorkerVectorEnv([Fragile] * 2, "ray", on_death="replace", timeout=HANG_S)
    asked: dict[Any, int] = env._workers._asked  # type: ignore[assignment]
    clock = Clock(lambda: set(asked.values()) == {1})
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


def test_a_cluster_without_a_free_core_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    monkeypatch.setattr("tltl_runtime.vector.ray_workers.TO_START_S", 2.0)
    busy = ray.remote(num_cpus=ray.cluster_resources()["CPU"])(Fragile).remote()
    ray.get(busy.__ray_ready__.remote())
    with pytest.raises(TltlError, match=r"no worker started within 2 s on the Ray cluster, which has \d+ cores?"):
        WorkerVectorEnv([Fragile], "ray", timeout=2.0)
    ray.kill(busy)


def test_an_actor_that_is_slow_to_start_on_a_free_core_is_not_said_to_lack_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ray does not tell one from the other."""
    import ray

    monkeypatch.setattr("tltl_runtime.vector.ray_workers.TO_START_S", 2.0)
    monkeypatch.setattr("tltl_runtime.vector.cluster.time", Clock(lambda: True))
    monkeypatch.setattr(ray, "wait", lambda asked, **_: ([], asked))
    with pytest.raises(TltlError) as found:
        WorkerVectorEnv([Fragile], "ray", timeout=2.0)
    (diagnostic,) = found.value.diagnostics
    assert diagnostic.title == f"no worker started within 2 s on the Ray cluster, which has {CORES} cores"
    assert "whether others use the cores" in str(diagnostic.help)


def test_environments_are_shared_out_over_the_cores_that_are_really_free(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    there, wait = [], ray.wait

    def noted(*arguments: Any, **options: Any) -> Any:
        there[:], left = wait(*arguments, **options)
        return list(there), left

    monkeypatch.setattr(ray, "wait", noted)
    monkeypatch.setattr("tltl_runtime.vector.ray_workers.free_cores", lambda _: CORES + 1)
    with monkeypatch.context() as patch:
        # Nobody waits any longer for the one for which there is no core.
        patch.setattr("tltl_runtime.vector.cluster.time", Clock(lambda: len(there) == CORES))
        env = WorkerVectorEnv([Fragile] * (2 * CORES + 2), "ray", timeout=HANG_S)
    with closing(env):
        assert len(env.worker_pids) == CORES
        env.reset(seed=1)
        assert list(env.step(np.full(2 * CORES + 2, GO))[1]) == [1.0] * (2 * CORES + 2)


def test_an_environment_that_cannot_be_made() -> None:
    with pytest.raises(WorkerError, match="no room"):
        WorkerVectorEnv([Fragile, partial(missing, True)], "ray")


def missing(_: bool) -> Fragile:
    raise RuntimeError("no room for another")
