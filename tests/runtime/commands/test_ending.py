from __future__ import annotations

import signal

import pytest

from tltl_runtime.commands.ending import requests_heard
from tltlc.cli.exits import StopQuietlyError

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="there is no such signal")


@pytest.mark.parametrize("number", ["SIGTERM", "SIGHUP"])
def test_a_request_ends_with_its_status(number: str) -> None:
    request = getattr(signal, number)
    before = signal.getsignal(request)
    with pytest.raises(StopQuietlyError) as error, requests_heard():
        signal.raise_signal(request)
    assert error.value.status == 128 + request
    assert signal.getsignal(request) == before


def test_what_nohup_ignores_stays_ignored() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with requests_heard():
            signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)
