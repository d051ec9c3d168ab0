"""Errors for HOA files."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError

FORMAT: Final = "the format is described at https://adl.github.io/hoaf/"
DETERMINISTIC: Final = "make it deterministic and complete first, e.g. with Spot: `autfilt -G -D -C`"


def format_error(source: SourceFile, span: Span, title: str, help_: str = FORMAT, label_message: str = "") -> TltlError:
    """Return the error TLT0651: the text does not follow the format.

    ``label_message`` is the text of the label at ``span``.
    """
    return TltlError([Diagnostic("TLT0651", title, (Label(source, span, label_message),), help_)])


def unsupported_error(source: SourceFile, span: Span, title: str, help_: str, label_message: str = "") -> TltlError:
    """Return the error TLT0652: tltlc cannot read this kind of automaton.

    ``label_message`` is the text of the label at ``span``.
    """
    return TltlError([Diagnostic("TLT0652", title, (Label(source, span, label_message),), help_)])
