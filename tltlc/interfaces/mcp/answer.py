"""The answer of a tool: a text for people, a JSON object for programs, and whether the call failed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.diagnostics.formats.json import entry
from tltlc.diagnostics.formats.text import render
from tltlc.diagnostics.shortening import shorten

MOST_DIAGNOSTICS: Final = 100
"""An answer has at most this many diagnostics; errors come before warnings and notes."""

_RANKS: Final = {"error": 0, "warning": 1, "note": 2}


class WrongUseError(Exception):
    """Raised for arguments of a tool that make no sense together; the text says what to write instead."""


@record
class Answer:
    """The answer of a tool.

    ``document`` has the form of the tool's output schema. It is None if the call failed before there
    was any result. ``is_error`` says whether the call failed. A mistake in a spec, or a trace that a
    spec rejects, is a result and no failure.
    """

    text: str
    document: Mapping[str, Any] | None = None
    is_error: bool = False


def with_diagnostics(document: Mapping[str, Any], diagnostics: Iterable[Diagnostic], text: str = "") -> Answer:
    """Return the answer with this document and text, to which the diagnostics are added.

    The call failed if an error points at no place in a source, such as a file that does not exist:
    then there is nothing in a spec to mend.
    """
    everything = tuple(dict.fromkeys(diagnostics))
    shown = tuple(map(shorten, _most_important(everything)))
    values = {"diagnostics": [_values(item) for item in shown], "left_out": len(everything) - len(shown)}
    parts = [text.rstrip("\n")] if text else []
    parts += map(diagnostic_text, shown)
    if len(everything) > len(shown):
        parts.append(f"{len(everything) - len(shown)} more are left out")
    is_error = any(item.severity == "error" and not item.labels for item in everything)
    return Answer("\n\n".join(parts), {**document, **values}, is_error)


def guarded(empty: Mapping[str, Any], work: Callable[[], Answer]) -> Answer:
    """Return the answer of ``work``; if it raises a TltlError, the document ``empty`` with the diagnostics."""
    try:
        return work()
    except TltlError as error:
        return with_diagnostics(empty, error.diagnostics)


def diagnostic_text(diagnostic: Diagnostic) -> str:
    """Return a diagnostic as the command line shows it, with a line for each of its fixes."""
    fixes = [f"  fix ({fix.applicability}): {fix.title}\n" for fix in diagnostic.fixes]
    return (render([diagnostic]) + "".join(fixes)).rstrip("\n")


def _most_important(diagnostics: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    if len(diagnostics) <= MOST_DIAGNOSTICS:
        return diagnostics
    return tuple(sorted(diagnostics, key=lambda item: _RANKS[item.severity])[:MOST_DIAGNOSTICS])


def _values(diagnostic: Diagnostic) -> dict[str, Any]:
    """Return a diagnostic as JSON; each edit of its fixes also has the text that it replaces."""
    values: dict[str, Any] = entry(diagnostic)
    for fix, fix_values in zip(diagnostic.fixes, values["fixes"], strict=True):
        for edit, edit_values in zip(fix.edits, fix_values["edits"], strict=True):
            edit_values["replaces"] = diagnostic.labels[0].source.slice(edit.span)
    return values
