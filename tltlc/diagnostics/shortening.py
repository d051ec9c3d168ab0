"""Shorten quoted texts in messages, because a name in a file may be megabytes long."""

from __future__ import annotations

import re
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic

_QUOTED: Final = re.compile("`([^`]*)`")
LONGEST_QUOTE: Final = 300
"""The most characters of a text in backticks. Messages show the beginning and the end of a longer text."""
LONGEST_TEXT: Final = 4000
"""The most characters of a whole title, help or label."""


def shorten(diagnostic: Diagnostic) -> Diagnostic:
    """Return the diagnostic with shortened texts: its title, help, labels, and the titles of its fixes.

    An ellipsis replaces the middle of a part in backticks longer than :data:`LONGEST_QUOTE`, and the
    middle of a text longer than :data:`LONGEST_TEXT`.
    """
    labels = tuple(
        label if len(label.message) <= LONGEST_QUOTE else replace(label, message=short_text(label.message))
        for label in diagnostic.labels
    )
    title, help_ = short_text(diagnostic.title), diagnostic.help and short_text(diagnostic.help)
    fixes = tuple(replace(fix, title=short_text(fix.title)) for fix in diagnostic.fixes)
    return replace(diagnostic, title=title, labels=labels, help=help_, fixes=fixes)


def short_text(text: str) -> str:
    """Return a message, with an ellipsis in place of the middle of each part in backticks that is too long.

    If the whole message is still too long, an ellipsis also replaces its middle. The limits are
    :data:`LONGEST_QUOTE` and :data:`LONGEST_TEXT`.
    """
    if len(text) <= LONGEST_QUOTE:
        return text
    return _cut(_QUOTED.sub(lambda quote: f"`{_cut(quote[1], LONGEST_QUOTE)}`", text), LONGEST_TEXT)


def _cut(text: str, most: int) -> str:
    """Return the text; if it has more than ``most`` characters, an ellipsis replaces its middle."""
    if len(text) <= most:
        return text
    end = most // 3
    return f"{text[: most - end - 1]}…{text[-end:]}"
