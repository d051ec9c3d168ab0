"""Actors of a Ray cluster give what worker processes give, bit for bit, and are missed alike."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import closing
from functools import partial
from importlib.util import find_spec

import numpy as np
import pytest

from tests.runtime.vector.envs import EXIT, GO, HANG, RAISE, Fragile
from tests.runtime.vector.test_vector import COUNT, SPEC, played, same
from tltl_runtime.vector import WorkerError, WorkerVectorEnv, make_vec
from tltlc.diagnostics.diagnostic import TltlError

pytestmark = pytest.mark.skipif(find_spec("ray") is None, reason="Ray is not installed: pip install '.[ray]'")


@pytest.fixture(scope="module", autouse=True)
def ray_here() -> Iterator[None]:
    """A Ray instance of this machine, for all tests of this module."""
    from tltl_runtime.vector.cluster import cluster

    with cluster():
        yield


def test_processes_of_torchrun_share_the_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    # What actors leave is counted as free a while later only: this is the first test.
    cores = int(ray.cluster_resources()["CPU"])
    monkeypatch.setenv("WORLD_SIZE", str(cores))
    with closing(WorkerVectorEnv([Fragile] * (2 * cores), "ray")) as env:
        assert len(env.worker_pids) == 1
        env.reset(seed=1)
        assert list(env.step(np.full(2 * cores, GO))[1]) == [1.0] * (2 * cores)


def test_the_same_as_local_workers() -> None:
    found = played(make_vec("cover_and_hide", "v2", COUNT, "ray", spec=SPEC))
    expected = played(make_vec("cover_and_hide", "v2", COUNT, 2, spec=SPEC))
    for ours, theirs in zip(found, expected, strict=True):
        assert all(map(same, ours, theirs))


def test_one_that_raises() -> None:
    env = WorkerVectorEnv([Fragile] * 2, "ray")
    env.reset(seed=[4, 8])
    env.step(np.array([GO, GO]))
    with pytest.raises(WorkerError) as found:
        env.step(np.array([GO, RAISE]))
    assert "the bridge is out" in str(found.value)
    assert "seed 8, episode 1, step 1" in str(found.value)


def test_another_takes_the_place_of_one_that_ended() -> None:
    env = WorkerVectorEnv([Fragile] * 2, "ray", on_death="replace", timeout=5.0)
    env.reset(seed=[4, 8])
    for action in (EXIT, HANG):
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
    with pytest.raises(TltlError, match=r"no core of the Ray cluster, which has \d+, became free within 2 s"):
        WorkerVectorEnv([Fragile], "ray", timeout=2.0)
    ray.kill(busy)


def test_environments_are_shared_out_over_the_cores_that_are_really_free(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    # On a busy machine the process of an actor takes seconds to start, once its core is free.
    monkeypatch.setattr("tltl_runtime.vector.cluster._AFTER_THE_FIRST_S", 10.0)
    cores = int(ray.cluster_resources()["CPU"])
    _until(lambda: ray.available_resources().get("CPU", 0) >= cores)
    monkeypatch.setattr("tltl_runtime.vector.ray_workers.free_cores", lambda _: cores + 1)
    with closing(WorkerVectorEnv([Fragile] * (2 * cores + 2), "ray")) as env:
        assert len(env.worker_pids) == cores
        env.reset(seed=1)
        assert list(env.step(np.full(2 * cores + 2, GO))[1]) == [1.0] * (2 * cores + 2)


def _until(is_so: Callable[[], bool], seconds: float = 30.0) -> None:
    deadline = time.monotonic() + seconds
    while not is_so():
        assert time.monotonic() < deadline, f"not so within {seconds:g} s"
        time.sleep(0.1)


def test_an_environment_that_cannot_be_made() -> None:
    with pytest.raises(WorkerError, match="no room"):
        WorkerVectorEnv([Fragile, partial(missing, True)], "ray")


def missing(_: bool) -> Fragile:
    raise RuntimeError("no room for another")
