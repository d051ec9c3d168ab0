"""Errors for HOA files."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError

FORMAT: Final = "the format is described at https://adl.github.io/hoaf/"
DETERMINISTIC: Final = "make it deterministic and complete first, e.g. with Spot: `autfilt -G -D -C`"


def broken(source: SourceFile, span: Span, title: str, suggestion: str = FORMAT, remark: str = "") -> TltlError:
    """Return TLT0651: the text does not follow the format."""
    return TltlError([Diagnostic("TLT0651", title, (Label(source, span, remark),), suggestion)])


def other_kind(source: SourceFile, span: Span, title: str, suggestion: str, remark: str = "") -> TltlError:
    """Return TLT0652: the automaton is of a kind that cannot be read."""
    return TltlError([Diagnostic("TLT0652", title, (Label(source, span, remark),), suggestion)])
