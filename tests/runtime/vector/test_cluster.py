"""Connecting to a Ray cluster: none is running, the address does not answer, Ray is not installed."""

from __future__ import annotations

import signal
import socket
import sys

import pytest

from tests.runtime.own_cluster import needs_ray, start_alone
from tltl_runtime.vector.cluster import cluster
from tltlc.diagnostics.diagnostic import TltlError


@pytest.mark.slow
@needs_ray
def test_a_local_cluster_is_started_and_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    monkeypatch.setenv("RAY_ADDRESS", "local")
    before = signal.getsignal(signal.SIGTERM)
    with start_alone(), cluster() as module:
        assert module is ray
        assert ray.is_initialized()
        assert signal.getsignal(signal.SIGTERM) is before
    assert not ray.is_initialized()


@needs_ray
def test_an_address_without_a_cluster_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    # A bound port that does not listen refuses connections, and no other process can take it meanwhile.
    with socket.socket() as bound:
        bound.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{bound.getsockname()[1]}"
        monkeypatch.setenv("RAY_ADDRESS", address)
        with pytest.raises(TltlError, match=f"TLT0852: there is no Ray cluster at `{address}`: .*refused"), cluster():
            pass


def test_a_missing_ray_package_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(TltlError) as error, cluster():
        pass
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, diagnostic.help) == (
        "TLT0730",
        "in the clone of tltlc: pip install -c constraints.txt '.[ray]'",
    )
