"""A Ray cluster for tests, with the same number of cores on every machine."""

from __future__ import annotations

import fcntl
import logging
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

import pytest

from tests.waiting import HANG_S, until
from tltl_runtime.vector.cluster import keep_sigterm_handler

needs_ray = pytest.mark.skipif(find_spec("ray") is None, reason="Ray is not installed: pip install '.[ray]'")

CORES: Final = 2

_SYSTEM: Final = {
    # On a busy machine a process is slow to start. Ray would kill it and start another one.
    "worker_register_timeout_seconds": int(HANG_S),
    "health_check_timeout_ms": int(1000 * HANG_S),
    "health_check_failure_threshold": 1000,
    # Ray must not kill an actor because other programs use much memory.
    "memory_monitor_refresh_ms": 0,
}
_LOCK: Final = Path(tempfile.gettempdir(), f"tltlc-tests-ray-{os.getuid()}.lock")
_OBJECTS_BYTES: Final = 100 * 2**20
"""The memory of Ray for objects, far more than a test needs.

By default, Ray takes a third of the machine's memory.
"""


@contextmanager
def own_cluster() -> Iterator[None]:
    """Connect this process to a new Ray cluster of ``CORES`` cores until the block ends.

    Nothing else uses the cluster. The time limits of the runtime are raised to ``HANG_S``.
    """
    import ray

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("RAY_USAGE_STATS_ENABLED", "0")
        patch.setattr("tltl_runtime.vector.ray_workers.TO_START_S", HANG_S)
        patch.setattr("tltl_runtime.vector.cluster._AFTER_THE_FIRST_S", HANG_S)
        patch.setattr("tltl_runtime.evaluation.ray_pool.PATIENCE_S", HANG_S)
        with start_alone(), keep_sigterm_handler():
            ray.init(
                address="local",
                num_cpus=CORES,
                include_dashboard=False,
                log_to_driver=False,
                logging_level=logging.ERROR,
                object_store_memory=_OBJECTS_BYTES,
                _system_config=_SYSTEM,
            )
        try:
            yield
        finally:
            ray.shutdown()


@contextmanager
def start_alone() -> Iterator[None]:
    """Let no other test start a cluster until the block ends.

    Ray chooses free ports first and binds them later, so two starts could choose the same ports.
    Ray limits one part of the start to 30 s, whatever its options; this function raises that limit
    to ``HANG_S``.
    """
    from ray._private import services

    get_node = services.get_node

    def wait_for_node(*arguments: Any) -> Any:
        def node() -> Any:
            with suppress(RuntimeError):
                return get_node(*arguments)

        return until(node, "the node of the cluster", 0.2)

    with pytest.MonkeyPatch.context() as patch, _LOCK.open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        patch.setenv("RAY_gcs_server_port_wait_time_s", str(int(HANG_S)))
        patch.setattr(services, "get_node", wait_for_node)
        yield
