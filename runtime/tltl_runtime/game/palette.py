"""The colours of states and of ends of episodes, which are the same in all pictures."""

from __future__ import annotations

from typing import Final

from tltl_runtime.spec.episode_summary import End

_STATES: Final = ("#2563eb", "#9333ea", "#0d9488", "#ca8a04", "#db2777", "#65a30d", "#0284c7", "#ea580c")
INK: Final = "#0f172a"
ENDS: Final[dict[End, tuple[str, str]]] = {
    "success": ("D", "#16a34a"),
    "violation": ("X", "#dc2626"),
    "limit": ("s", "#64748b"),
    "stopped": ("o", "#64748b"),
}
"""The marker of matplotlib and the colour for each end of an episode."""


def state_colour(state: int) -> str:
    """Return the colour of a state of the automaton, as ``#rrggbb``."""
    return _STATES[state % len(_STATES)]
