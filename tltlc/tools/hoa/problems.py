"""The messages for a HOA file."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError

FORMAT: Final = "the format is described at https://adl.github.io/hoaf/"
DETERMINISTIC: Final = "make it deterministic and complete first, e.g. with Spot: `autfilt -G -D -C`"


def broken(source: SourceFile, span: Span, title: str, way_out: str = FORMAT, remark: str = "") -> TltlError:
    """TLT0651: a text is not of the format."""
    return TltlError([Diagnostic("TLT0651", title, (Label(source, span, remark),), way_out)])


def other_kind(source: SourceFile, span: Span, title: str, way_out: str, remark: str = "") -> TltlError:
    """TLT0652: an automaton of a kind that cannot be read."""
    return TltlError([Diagnostic("TLT0652", title, (Label(source, span, remark),), way_out)])
