"""Shorten what messages quote: a name in a file that somebody else made may be megabytes long."""

from __future__ import annotations

import re
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic

_QUOTED: Final = re.compile("`([^`]*)`")
LONGEST_QUOTE: Final = 300
"""Characters of a text in backticks; of a longer one, messages show the beginning and the end."""
LONGEST_TEXT: Final = 4000
"""Characters of a title, a help or a remark as a whole."""


def shortened(diagnostic: Diagnostic) -> Diagnostic:
    """The diagnostic with no text longer than :data:`LONGEST_TEXT`, and no quoted one than :data:`LONGEST_QUOTE`."""
    labels = tuple(
        label if len(label.message) <= LONGEST_QUOTE else replace(label, message=short_text(label.message))
        for label in diagnostic.labels
    )
    title, help_ = short_text(diagnostic.title), diagnostic.help and short_text(diagnostic.help)
    fixes = tuple(replace(fix, title=short_text(fix.title)) for fix in diagnostic.fixes)
    return replace(diagnostic, title=title, labels=labels, help=help_, fixes=fixes)


def short_text(text: str) -> str:
    """A text for people, with long quotes in it cut in the middle."""
    if len(text) <= LONGEST_QUOTE:
        return text
    return _cut(_QUOTED.sub(lambda quote: f"`{_cut(quote[1], LONGEST_QUOTE)}`", text), LONGEST_TEXT)


def _cut(text: str, most: int) -> str:
    """The first two thirds and the end of ``most`` characters of a longer text."""
    if len(text) <= most:
        return text
    end = most // 3
    return f"{text[: most - end - 1]}…{text[-end:]}"
