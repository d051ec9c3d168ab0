"""Convert diagnostics to text in one of several formats, each a module of ``tltlc.diagnostics.formats``."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Final, Protocol, cast

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.diagnostics.shortening import shorten

FORMATS: Final = ("text", "json", "sarif", "github")
"""The names of all formats; each is a module with a function ``render``."""


class RenderFunction(Protocol):
    """The type of the function ``render`` that the module of each format has."""

    def __call__(self, diagnostics: Sequence[Diagnostic], *, color: bool) -> str:
        """Return the diagnostics as one text, which is empty or ends with a newline.

        ``color`` asks for ANSI colours; formats for programs ignore it.
        """


def render(diagnostics: Sequence[Diagnostic], format: str = "text", color: bool = False) -> str:  # noqa: A002
    """Return the diagnostics in one of the :data:`FORMATS`; raise ValueError for any other format.

    ``color`` adds ANSI colours to the format ``text``. Very long names in messages are shortened.
    """
    if format not in FORMATS:
        raise ValueError(f"there is no format {format!r}: use one of {', '.join(FORMATS)}")
    renderer = cast(RenderFunction, import_module(f"tltlc.diagnostics.formats.{format}").render)
    return renderer([shorten(diagnostic) for diagnostic in diagnostics], color=color)
