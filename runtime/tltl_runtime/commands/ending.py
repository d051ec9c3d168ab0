"""Being asked to end: as for Ctrl-C, what was done is kept, and the exit status says which request it was."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from tltlc.cli import exits
from tltlc.cli.interrupts import interrupt

_REQUESTS = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


@contextmanager
def requests_heard() -> Iterator[None]:
    """Within, SIGTERM and SIGHUP raise KeyboardInterrupt; the command then ends with 128 and the signal's number."""
    heard: list[int] = []

    def request(number: int, frame: FrameType | None) -> None:
        heard.append(number)
        interrupt(number, frame)

    before = {number: signal.signal(number, request) for number in _REQUESTS}
    try:
        yield
    except BaseException as error:
        if heard and exits.is_interrupted(error):
            raise exits.StopQuietlyError(128 + heard[0]) from None
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
