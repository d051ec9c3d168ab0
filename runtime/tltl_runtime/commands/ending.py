"""Being asked to end: as for Ctrl-C, what was done is kept, and the exit status says which request it was."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tltlc.cli import exits

_REQUESTS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


@contextmanager
def requests_heard() -> Iterator[None]:
    """Within, SIGTERM and SIGHUP raise KeyboardInterrupt; the command then ends with 128 and the signal's number."""
    heard: list[int] = []

    def interrupt(number: int, _: Any) -> None:
        heard.append(number)
        raise KeyboardInterrupt

    before = {number: signal.signal(number, interrupt) for number in _REQUESTS}
    try:
        yield
    except KeyboardInterrupt:
        if heard:
            raise exits.StopQuietlyError(128 + heard[0]) from None
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
