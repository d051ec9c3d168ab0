"""Tell a person at a terminal why a game takes long to start."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

import click

from tltl_runtime.cli.support.plain_text import plain_text

if TYPE_CHECKING:
    from tltl_runtime.wire.start_watch import SlowStart


@contextmanager
def slow_starts_shown() -> Iterator[None]:
    """Within this context, print a line if a game in another process is still starting after some seconds.

    The line goes to standard error, and only if that is a terminal.
    """
    from tltl_runtime.wire.start_watch import telling_slow_starts

    with telling_slow_starts(_print):
        yield


def _print(start: SlowStart) -> None:
    if sys.stderr.isatty():
        click.echo(plain_text(slow_start_text(start)), err=True)


def slow_start_text(start: SlowStart) -> str:
    """Return the line about a game that is still starting."""
    wrote = f"it wrote last: {start.last_line}" if start.last_line else "it has written nothing to standard error"
    return f"`{start.name}` has been starting for {start.waited_s:.0f} of at most {start.start_s:g} s; {wrote}"
