"""Showing diagnostics in the format that the user chose, and the exit status that follows."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from types import TracebackType
from typing import Final, TextIO

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import exits

_MOST_ALIKE: Final = 20
"""At most this many diagnostics of one code in one file are shown to people at a time."""


class Report:
    """Collects what a command finds; as a context, ends the command at the first :class:`TltlError`.

    What was found before is not told again: two files may import a third one, of which there is something to say.
    Text is shown at once, on standard error.  The formats for machines are one document per run,
    shown at the end: on standard output, or on standard error for commands that put results there.
    ``status`` is the exit status.
    """

    def __init__(self, format: str = "text", *, results: bool = False) -> None:  # noqa: A002
        self.format = format
        self.found: dict[Diagnostic, None] = {}
        self.status = exits.CLEAN
        self._document = sys.stderr if results else sys.stdout

    def add(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Show (or keep for the end) what was found."""
        new = tuple(each for each in dict.fromkeys(diagnostics) if each not in self.found)
        if self.format == "text":
            # A full standard error changes no verdict.
            with suppress(OSError):
                if self.found and new:
                    print(file=sys.stderr)
                show(new, "text", sys.stderr)
        self.found.update(dict.fromkeys(new))
        self.status = max(self.status, exits.status_of(new))

    def say(self, text: str) -> None:
        """Narration: a line on standard error, only beside diagnostics for people."""
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
        if self.format != "text":
            show(self.found, self.format, self._document)
        return error is not None


def counted(number: int, noun: str) -> str:
    """``1 file``, ``2 files``."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def tally(diagnostics: Iterable[Diagnostic]) -> str:
    """How many there are of each severity: ``1 error, 2 warnings``; ``nothing to report`` of none."""
    severities = [each.severity for each in diagnostics]
    counts = [(severities.count(severity), severity) for severity in ("error", "warning", "note")]
    return ", ".join(counted(number, severity) for number, severity in counts if number) or "nothing to report"


def show(diagnostics: Iterable[Diagnostic], format: str, stream: TextIO) -> None:  # noqa: A002
    """Write diagnostics to a stream; in colour only for people at a terminal.

    Text has the first 20 of each code in a file, and says how many more there are. Formats for machines have all.
    """
    found = tuple(diagnostics)
    if not found and format == "text":
        return
    from tltlc.diagnostics.formats.text import visible
    from tltlc.diagnostics.render import render

    shown, left_out = _first(found) if format == "text" else (found, Counter[_Alike]())
    text = render(shown, format, color=format == "text" and wants_colour(stream))
    stream.write(text if text.endswith("\n") or not text else text + "\n")
    for (severity, code, file), count in left_out.items():
        place = f" in {visible(file)}" if file else ""
        stream.write(f"\n{severity}[{code}]: {count:,} more like the {_MOST_ALIKE} above{place}\n")
    stream.flush()


_Alike = tuple[str, str, str]
"""Severity, code and file of diagnostics."""


def _first(found: Iterable[Diagnostic]) -> tuple[tuple[Diagnostic, ...], Counter[_Alike]]:
    """The first diagnostics of each code in each file, and how many of them are left out."""
    counts: Counter[_Alike] = Counter()
    shown = []
    for each in found:
        alike = each.severity, each.code, each.labels[0].source.name if each.labels else ""
        counts[alike] += 1
        if counts[alike] <= _MOST_ALIKE:
            shown.append(each)
    left_out = Counter({alike: count - _MOST_ALIKE for alike, count in counts.items() if count > _MOST_ALIKE})
    return tuple(shown), left_out


def wants_colour(stream: TextIO) -> bool:
    """Whether colour helps here: a terminal that can, and no NO_COLOR in the environment."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
