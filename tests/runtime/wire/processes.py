"""The processes of games that this process has started, directly or in its workers."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.waiting import children


def descendants(pid: int) -> Iterator[int]:
    """Yield the ids of a process and of all processes that descend from it."""
    yield pid
    for child in children(pid):
        yield from descendants(child)


def supervisors(pid: int) -> list[int]:
    """Return the ids of the supervisors of games among a process and its descendants."""
    return [descendant for descendant in descendants(pid) if _is_supervisor(descendant)]


@contextmanager
def no_game_is_left() -> Iterator[None]:
    """Check that at the end no supervisor runs that was started within the context.

    Other processes may have been started, such as the fork server of Python, which stays for later workers.
    """
    before = set(supervisors(os.getpid()))
    yield
    assert set(supervisors(os.getpid())) <= before


def _is_supervisor(pid: int) -> bool:
    try:
        return b"supervisor.py" in Path(f"/proc/{pid}/cmdline").read_bytes()
    except OSError:
        return False
