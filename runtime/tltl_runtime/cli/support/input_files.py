"""Commands on several files: what is wrong with one keeps nobody from the next."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli.report import Report

T = TypeVar("T")


def read_each(files: Sequence[str], read: Callable[[str], T], report: Report) -> Iterator[tuple[str, T]]:
    """Each file by its name, with what ``read`` makes of it; what is wrong with the others goes into the report."""
    for name in files:
        try:
            made = read(name)
        except TltlError as error:
            report.add(error.diagnostics)
            continue
        yield name, made
