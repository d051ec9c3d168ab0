"""Connecting to a Ray cluster that is not there, and without Ray."""

from __future__ import annotations

import socket
import sys
from importlib.util import find_spec

import pytest

from tltl_runtime.vector.cluster import cluster
from tltlc.diagnostics.diagnostic import TltlError


@pytest.mark.skipif(find_spec("ray") is None, reason="Ray is not installed: pip install '.[ray]'")
def test_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{unused.getsockname()[1]}"
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
