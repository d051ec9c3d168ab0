"""Diagnostics as text, for people and for programs: one module of ``tltlc.diagnostics.formats`` per format."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Final, Protocol, cast

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.diagnostics.shortening import shortened

FORMATS: Final = ("text", "json", "sarif", "github")
"""The formats there are; each is the name of a module with a function ``render``."""


class Renderer(Protocol):
    """The function ``render`` of a format's module."""

    def __call__(self, diagnostics: Sequence[Diagnostic], *, color: bool) -> str:
        """All diagnostics as one text that ends with a newline, or is empty; ``color`` asks for ANSI codes."""


def render(diagnostics: Sequence[Diagnostic], format: str = "text", color: bool = False) -> str:  # noqa: A002
    """The diagnostics in one of the :data:`FORMATS`; raises ValueError for any other.

    ``color`` matters to ``text`` alone.  Very long names in messages are shortened in all formats.
    """
    if format not in FORMATS:
        raise ValueError(f"no format {format!r}: one of {', '.join(FORMATS)}")
    renderer = cast(Renderer, import_module(f"tltlc.diagnostics.formats.{format}").render)
    return renderer([shortened(diagnostic) for diagnostic in diagnostics], color=color)
