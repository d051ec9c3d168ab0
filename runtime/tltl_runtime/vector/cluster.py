"""The Ray cluster that this process is connected to."""

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

from tltl_runtime.vector.cores import started
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

_TO_ANSWER_S: Final = 10.0
"""How long a cluster may take to answer."""
_AFTER_THE_FIRST_S: Final = 30.0
"""How long other actors may take to start once one has."""
_TOLD_EVERY_S: Final = 10.0


@contextmanager
def cluster() -> Iterator[Any]:
    """The module ``ray``, connected: as it is already, else to the cluster that runs, else to one of this machine.

    A running cluster is the one of the environment variable ``RAY_ADDRESS``, or one that ``ray start`` began here.
    What was connected here is disconnected at the end.

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
    # A cluster of this machine's own tells nobody that there is one.
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    try:
        _call(os.environ.get("RAY_ADDRESS", ""))
        with sigterm_handler_kept():
            ray.init(include_dashboard=False, log_to_driver=False, logging_level=logging.ERROR)
    except (OSError, ValueError, RuntimeError) as error:
        place = os.environ.get("RAY_ADDRESS", "this machine")
        title, help_ = f"there is no Ray cluster at `{place}`: {_first_line(error)}", "set RAY_ADDRESS, or unset it"
        raise TltlError([Diagnostic("TLT0852", title, help=help_)]) from None
    try:
        yield ray
    finally:
        ray.shutdown()


@contextmanager
def sigterm_handler_kept() -> Iterator[None]:
    """Undo what Ray does to the handler of SIGTERM: the command would end with another status, and clean up nothing."""
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        # Only the main thread may set handlers, which is why Ray leaves them alone in others.
        if before is not None and threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)


def free_cores(ray: Any) -> int:
    """How many cores of the cluster nobody uses, at least one; where torchrun started several processes, for each."""
    return max(1, int(ray.available_resources().get("CPU", 1)) // started("WORLD_SIZE", 1))


def there(
    ray: Any, actors: Sequence[Any], patience: float, waiting: Callable[[float], None] = lambda left: None
) -> list[int]:
    """The places, in order, of those actors that have started: all of them unless others use some of the cores.

    The first may take ``patience`` seconds, of which ``waiting`` is told now and then how many are left; the others may
    take a while more.  Raises TltlError, TLT0852, where none starts.
    """
    deadline = time.monotonic() + patience
    asked = [actor.__ray_ready__.remote() for actor in actors]
    found: list[Any] = []
    while len(found) < len(asked) and (left := deadline - time.monotonic()) > 0:
        now, _ = ray.wait(asked, num_returns=len(found) + 1, timeout=min(left, _TOLD_EVERY_S))
        if now and not found:
            deadline = min(deadline, time.monotonic() + _AFTER_THE_FIRST_S)
        elif not now:
            waiting(left)
        found = now
    if not found:
        raise not_started(ray, patience)
    return [place for place, reference in enumerate(asked) if reference in found]


def not_started(ray: Any, waited_s: float) -> TltlError:
    """TLT0852: no worker started within so many seconds.

    Ray does not say why: others may use all cores, or the process of a worker may be slow to start on its core.
    """
    cores = int(ray.cluster_resources().get("CPU", 0))
    size = "1 core" if cores == 1 else f"{cores} cores"
    title = f"no worker started within {waited_s:g} s on the Ray cluster, which has {size}"
    help_ = "`ray status` tells whether others use the cores; try again when they are free, or play with `--workers 0`"
    return TltlError([Diagnostic("TLT0852", title, help=help_)])


def _call(address: str) -> None:
    """Raise OSError where nobody answers at HOST:PORT: Ray would try for minutes."""
    host, _, port = address.removeprefix("ray://").rpartition(":")
    if host and port.isdecimal():
        socket.create_connection((host, int(port)), _TO_ANSWER_S).close()


def _first_line(error: Exception) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)
