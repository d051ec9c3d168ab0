"""Markdown for the report: tables and figures."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

MISSED = "**missed**"


def met_or_missed(met: bool) -> str:
    return "met" if met else MISSED


def spread(quartiles: Sequence[float], digits: int = 1) -> str:
    """Return the median, and the quartiles in brackets."""
    lower, middle, upper = quartiles
    return f"{middle:.{digits}f} ({lower:.{digits}f}–{upper:.{digits}f})"


def table(header: Sequence[str], body: Iterable[Sequence[object]]) -> str:
    lines = [header, ["---"] * len(header), *body]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)
