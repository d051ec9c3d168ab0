"""Connect to a Ray cluster, and wait for its actors."""

from __future__ import annotations

import logging
import os
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Final

from tltl_runtime.vector.cores import torchrun_variable
from tltlc.api import Diagnostic, TltlError

_TO_ANSWER_S: Final = 10.0
"""The seconds that a cluster may take to answer."""
_AFTER_THE_FIRST_S: Final = 30.0
"""The seconds that the other actors may take to start after the first actor has started."""
_REPORT_INTERVAL_S: Final = 10.0
"""Seconds between two reports that no actor has started."""


@contextmanager
def cluster() -> Iterator[Any]:
    """Connect to a Ray cluster for the duration of a context, and yield the module ``ray``.

    If this process is connected already, that connection is used and stays open. Otherwise, the
    function connects to a running cluster: the cluster at the address in the environment variable
    ``RAY_ADDRESS``, or a cluster that ``ray start`` began on this machine. If there is neither, it
    starts a cluster on this machine. At the end of the context, it closes the connection.

    Raises:
        TltlError: TLT0730, Ray is not installed; TLT0852, there is no cluster at ``RAY_ADDRESS``.
    """
    try:
        import ray
    except ModuleNotFoundError:
        title = "workers of a Ray cluster need `ray`, which is not installed"
        raise TltlError(
            [Diagnostic("TLT0730", title, help="in the clone of tltlc: pip install -c constraints.txt '.[ray]'")]
        ) from None
    if ray.is_initialized():
        yield ray
        return
    # A cluster that this process starts must not send usage statistics.
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    try:
        _check_address(os.environ.get("RAY_ADDRESS", ""))
        with keep_sigterm_handler():
            ray.init(include_dashboard=False, log_to_driver=False, logging_level=logging.ERROR)
    except (OSError, ValueError, RuntimeError) as error:
        address = os.environ.get("RAY_ADDRESS", "this machine")
        title, help_ = f"there is no Ray cluster at `{address}`: {_first_line(error)}", "set RAY_ADDRESS, or unset it"
        raise TltlError([Diagnostic("TLT0852", title, help=help_)]) from None
    try:
        yield ray
    finally:
        ray.shutdown()


@contextmanager
def keep_sigterm_handler() -> Iterator[None]:
    """Restore the handler of SIGTERM at the end of a context in which Ray replaces it.

    With Ray's handler, the process would end with another exit status and without cleanup.
    """
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        # Only the main thread may set handlers; in other threads Ray does not change them.
        if before is not None and threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)


def free_cores(ray: Any) -> int:
    """Return how many free cores of the cluster this process may use, at least 1.

    Processes that torchrun started together share the free cores equally. ``ray`` is the connected
    module.
    """
    return max(1, int(ray.available_resources().get("CPU", 1)) // torchrun_variable("WORLD_SIZE", 1))


def wait_for_actors(
    ray: Any, actors: Sequence[Any], patience: float, waiting: Callable[[float], None] = lambda left: None
) -> list[int]:
    """Wait until actors have started; return the indices of the started actors, in order.

    The first actor may take ``patience`` seconds to start. Until it starts, ``waiting`` is called
    every 10 seconds with the seconds that are left. The other actors then have up to 30 seconds more,
    but no more than ``patience`` in all. Actors that do not start in time, for example because other
    programs use the cores, are missing in the result.

    Raises:
        TltlError: TLT0852, no actor starts in time.
    """
    deadline = time.monotonic() + patience
    references = [actor.__ray_ready__.remote() for actor in actors]
    ready: list[Any] = []
    while len(ready) < len(references) and (left := deadline - time.monotonic()) > 0:
        newly_ready, _ = ray.wait(references, num_returns=len(ready) + 1, timeout=min(left, _REPORT_INTERVAL_S))
        if newly_ready and not ready:
            deadline = min(deadline, time.monotonic() + _AFTER_THE_FIRST_S)
        elif not newly_ready:
            waiting(left)
        ready = newly_ready
    if not ready:
        raise no_worker_error(ray, patience)
    return [index for index, reference in enumerate(references) if reference in ready]


def no_worker_error(ray: Any, waited_s: float) -> TltlError:
    """Return the error TLT0852: no worker started on the cluster within ``waited_s`` seconds.

    Ray does not say why: other programs may use all cores, or the process of a worker may start
    slowly.
    """
    cores = int(ray.cluster_resources().get("CPU", 0))
    size = "1 core" if cores == 1 else f"{cores} cores"
    title = f"no worker started within {waited_s:g} s on the Ray cluster, which has {size}"
    help_ = "`ray status` tells whether others use the cores; try again when they are free, or play with `--workers 0`"
    return TltlError([Diagnostic("TLT0852", title, help=help_)])


def _check_address(address: str) -> None:
    """Check that something answers at the address ``HOST:PORT``, because Ray would try for minutes.

    Other addresses, such as the empty one, are not checked.

    Raises:
        OSError: nothing answers.
    """
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdecimal():
        socket.create_connection((host, int(port)), _TO_ANSWER_S).close()


def _first_line(error: Exception) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)
