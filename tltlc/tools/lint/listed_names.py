"""List the names that several findings point at."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic

_MOST_NAMES: Final = 20


def listed_names(group: Sequence[Diagnostic]) -> str:
    """Return the names that the findings point at, in backquotes: at most 20, and the number of the others."""
    labels = [diagnostic.labels[0] for diagnostic in group]
    names = [f"`{label.source.slice(label.span)}`" for label in labels[:_MOST_NAMES]]
    more = f" and {len(group) - _MOST_NAMES:,} more" if len(group) > _MOST_NAMES else ""
    return f"{', '.join(names)}{more}"
