"""Show diagnostics in the format that the user chose, and compute the resulting exit status."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from types import TracebackType
from typing import Any, Final, TextIO

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits

_MOST_ALIKE: Final = 20
"""The text format shows at most this many diagnostics with the same code in the same file."""


class Report:
    """Collects the diagnostics of a command, and shows them.

    As a context manager, it also reports a TltlError that ends the block, and suppresses it. Each
    diagnostic is reported once, even if two files import the file with the error. In the format
    ``text``, diagnostics appear at once, on standard error. In the machine formats, such as JSON,
    they form one document, which appears at the end: on standard output, or on standard error if
    the command prints ``results`` there. The keys of ``diagnostics`` are the diagnostics in order.
    ``status`` is the exit status so far. ``facts`` are further entries of the document in JSON, by
    their keys.
    """

    def __init__(self, format: str = "text", *, results: bool = False) -> None:  # noqa: A002
        self.format = format
        self.diagnostics: dict[Diagnostic, None] = {}
        self.status = exits.CLEAN
        self.facts: dict[str, list[Any]] = {}
        self._document = sys.stderr if results else sys.stdout

    def add(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Add diagnostics; show the new ones at once in the format ``text``, otherwise at the end."""
        new = tuple(diagnostic for diagnostic in dict.fromkeys(diagnostics) if diagnostic not in self.diagnostics)
        if self.format == "text":
            # A full standard error must not change the exit status.
            with suppress(OSError):
                if self.diagnostics and new:
                    print(file=sys.stderr)
                show(new, "text", sys.stderr)
        self.diagnostics.update(dict.fromkeys(new))
        self.status = max(self.status, exits.status_of(new))

    def say(self, text: str) -> None:
        """Print a progress message on standard error; the machine formats omit it."""
        if self.format == "text":
            from tltlc.diagnostics.shortening import short_text

            with suppress(OSError):
                print(short_text(text), file=sys.stderr, flush=True)

    def __enter__(self) -> Report:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        if isinstance(error, TltlError):
            self.add(error.diagnostics)
        elif error is not None:
            return False
        if self.format == "json" and self.facts:
            from tltlc.diagnostics.formats.json import render
            from tltlc.diagnostics.shortening import shorten

            self._document.write(render(list(map(shorten, self.diagnostics)), facts=self.facts))
            self._document.flush()
        elif self.format != "text":
            show(self.diagnostics, self.format, self._document)
        return error is not None


def count_text(number: int, noun: str) -> str:
    """Return a number with its noun: ``1 file``, ``2 files``."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def tally(diagnostics: Iterable[Diagnostic]) -> str:
    """Count diagnostics by severity: ``1 error, 2 warnings``, or ``nothing to report``."""
    severities = [diagnostic.severity for diagnostic in diagnostics]
    counts = [(severities.count(severity), severity) for severity in ("error", "warning", "note")]
    return ", ".join(count_text(number, severity) for number, severity in counts if number) or "nothing to report"


def show(diagnostics: Iterable[Diagnostic], format: str, stream: TextIO) -> None:  # noqa: A002
    """Write diagnostics to a stream; use colour only for text at a terminal.

    The format ``text`` shows the first 20 diagnostics with the same severity and code in a file, and
    counts the rest. The other formats show all.
    """
    all_diagnostics = tuple(diagnostics)
    if not all_diagnostics and format == "text":
        return
    from tltlc.diagnostics.formats.text import replace_unprintable
    from tltlc.diagnostics.render import render

    shown, left_out = _first_of_each(all_diagnostics) if format == "text" else (all_diagnostics, Counter[_Alike]())
    text = render(shown, format, color=format == "text" and wants_colour(stream))
    stream.write(text if text.endswith("\n") or not text else text + "\n")
    for (severity, code, file), count in left_out.items():
        place = f" in {replace_unprintable(file)}" if file else ""
        stream.write(f"\n{severity}[{code}]: {count:,} more like the {_MOST_ALIKE} above{place}\n")
    stream.flush()


_Alike = tuple[str, str, str]
"""Severity, code and file of a diagnostic; diagnostics that share them are counted together."""


def _first_of_each(diagnostics: Iterable[Diagnostic]) -> tuple[tuple[Diagnostic, ...], Counter[_Alike]]:
    """Return the diagnostics to show, at most 20 of each kind, and how many of each are left out.

    Diagnostics are of the same kind if their severity, code and file are equal.
    """
    counts: Counter[_Alike] = Counter()
    shown = []
    for diagnostic in diagnostics:
        alike = diagnostic.severity, diagnostic.code, diagnostic.labels[0].source.name if diagnostic.labels else ""
        counts[alike] += 1
        if counts[alike] <= _MOST_ALIKE:
            shown.append(diagnostic)
    left_out = Counter({alike: count - _MOST_ALIKE for alike, count in counts.items() if count > _MOST_ALIKE})
    return tuple(shown), left_out


def wants_colour(stream: TextIO) -> bool:
    """Whether to use colour: the stream is a capable terminal, and NO_COLOR is not set."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
