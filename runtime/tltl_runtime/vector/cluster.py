"""The Ray cluster that this process is connected to."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


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
        raise TltlError([Diagnostic("TLT0730", title, help="pip install 'tltlc[ray]'")]) from None
    if ray.is_initialized():
        yield ray
        return
    # A cluster of this machine's own tells nobody that there is one.
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    try:
        ray.init(include_dashboard=False, log_to_driver=False, logging_level=logging.ERROR)
    except (ConnectionError, ValueError, RuntimeError) as error:
        place = os.environ.get("RAY_ADDRESS", "this machine")
        title, help_ = f"there is no Ray cluster at `{place}`: {_first_line(error)}", "set RAY_ADDRESS, or unset it"
        raise TltlError([Diagnostic("TLT0852", title, help=help_)]) from None
    try:
        yield ray
    finally:
        ray.shutdown()


def free_cores(ray: Any) -> int:
    """How many cores of the cluster nobody uses, at least one."""
    return max(1, int(ray.available_resources().get("CPU", 1)))


def _first_line(error: Exception) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)
