"""Connecting to a Ray cluster that is not there, and without Ray."""

from __future__ import annotations

import signal
import socket
import sys

import pytest

from tests.runtime.own_cluster import needs_ray, start_alone
from tltl_runtime.vector.cluster import cluster
from tltlc.diagnostics.diagnostic import TltlError


@needs_ray
def test_where_there_is_no_cluster_one_of_this_machine_is_started_and_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    import ray

    monkeypatch.setenv("RAY_ADDRESS", "local")
    before = signal.getsignal(signal.SIGTERM)
    with start_alone(), cluster() as found:
        assert found is ray
        assert ray.is_initialized()
        assert signal.getsignal(signal.SIGTERM) is before
    assert not ray.is_initialized()


@needs_ray
def test_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    # A port that is bound and listens to nobody refuses, and is nobody else's meanwhile.
    with socket.socket() as deaf:
        deaf.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{deaf.getsockname()[1]}"
        monkeypatch.setenv("RAY_ADDRESS", address)
        with pytest.raises(TltlError, match=f"TLT0852: there is no Ray cluster at `{address}`: .*refused"), cluster():
            pass


def test_without_ray(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(TltlError) as found, cluster():
        pass
    (diagnostic,) = found.value.diagnostics
    assert (diagnostic.code, diagnostic.help) == (
        "TLT0730",
        "in the clone of tltlc: pip install -c constraints.txt '.[ray]'",
    )
