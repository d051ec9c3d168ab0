"""Read several files, so that errors in one do not stop the others."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from tltlc.api import TltlError, cli

T = TypeVar("T")


def read_each(files: Sequence[str], read: Callable[[str], T], report: cli.Report) -> Iterator[tuple[str, T]]:
    """Yield the name of each file and the result of ``read``.

    If ``read`` raises TltlError, add the error to ``report`` and go on with the next file.
    """
    for name in files:
        try:
            content = read(name)
        except TltlError as error:
            report.add(error.diagnostics)
            continue
        yield name, content
