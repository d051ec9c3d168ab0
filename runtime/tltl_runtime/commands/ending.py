"""Being asked to end: as for Ctrl-C, what was done is kept, and the exit status says which request it was."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from tltlc.cli import exits
from tltlc.cli.interrupts import REQUESTS, interrupt


@contextmanager
def requests_heard() -> Iterator[None]:
    """Within, SIGTERM and SIGHUP raise KeyboardInterrupt; the command then ends with 128 and the signal's number."""
    heard: list[int] = []

    def request(number: int, frame: FrameType | None) -> None:
        heard.append(number)
        interrupt(number, frame)

    # Under `nohup`, SIGHUP stays ignored.
    listened = [number for number in REQUESTS if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, request) for number in listened}
    try:
        yield
    except BaseException as error:
        if heard and exits.is_interrupted(error):
            raise exits.StopQuietlyError(128 + heard[0]) from None
        raise
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
