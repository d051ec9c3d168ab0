"""Show the whole clause in a help that says how to write a part of it."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CLAUSES

_LONGEST: Final = 100
"""The most characters of a clause that a help shows as a whole."""
_WRITE: Final = "write `"
_OF_PARTS: Final = (" alone", ", or ", " or", " if ", "; otherwise")
"""What follows the text that a help shows, where the help goes on with other texts for the same part."""


def showing_clause(diagnostic: Diagnostic, source: SourceFile, clause: Span) -> Diagnostic:
    """Return an error whose help shows the clause as its first fix leaves it, not only the part that changes.

    People replace a whole line by what a help shows. So a part alone would cost them the keyword. The help stays as it
    is if one word takes the place of another, if it shows several texts for the part, or if the clause is long, has a
    comment or goes on on another line.
    """
    edits, help_ = diagnostic.fixes[0].edits if diagnostic.fixes else (), diagnostic.help or ""
    before = source.slice(clause)
    if len(edits) != 1 or "\n" in before or "//" in before or diagnostic.labels[0].source is not source:
        return diagnostic
    edit, text = edits[0], edits[0].text.strip()
    is_part = clause.start <= edit.span.start and edit.span.end <= clause.end and edit.span != clause
    is_phrase = " " in text or " " in source.slice(edit.span)
    after = source.text[clause.start : edit.span.start] + edit.text + source.text[edit.span.end : clause.end]
    shown = f"{_WRITE}{text}`"
    rest = help_[len(shown) :]
    if not is_part or not is_phrase or len(after) > _LONGEST or not help_.startswith(shown):
        return diagnostic
    if rest.startswith(_OF_PARTS) or after.split()[0] not in CLAUSES:
        return diagnostic
    return replace(diagnostic, help=f"{_WRITE}{' '.join(after.split())}`{rest}")
