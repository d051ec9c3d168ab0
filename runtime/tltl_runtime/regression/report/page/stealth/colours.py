"""The colours of the page's maps, which are the same in all pictures of levels."""

from __future__ import annotations

from tltl_runtime.stealth.rendering.film import MODES
from tltl_runtime.stealth.rendering.plan import BARRIERS, ENDS, EXIT, INK, MOVER, ROUTE, SOLIDS, SWITCH, state_colour


def colours() -> str:
    """Return a CSS rule that defines the colours as custom properties."""
    named = {
        **SOLIDS,
        **{f"barrier-{kind}": colour for kind, colour in BARRIERS.items()},
        **{f"end-{end}": colour for end, (_, colour) in ENDS.items()},
        **{f"mode-{mode}": colour for mode, colour in MODES.items()},
        "switch": SWITCH,
        "exit": EXIT,
        "mover": MOVER,
        "route": ROUTE,
        "ink": INK,
    }
    return f":root {{ {' '.join(f'--map-{name}: {colour};' for name, colour in named.items())} }}"


def state_colours(count: int) -> list[str]:
    """Return the colours of the first ``count`` states of an automaton, as ``#rrggbb``."""
    return [state_colour(state) for state in range(count)]
