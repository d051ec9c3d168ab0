"""The colours of maps, which are the same in all pictures of levels."""

from __future__ import annotations

from tltl_runtime.game.palette import ENDS, INK
from tltl_runtime.stealth.rendering.film import MODES
from tltl_runtime.stealth.rendering.plan import BARRIERS, EXIT, MOVER, ROUTE, SOLIDS, SWITCH


def colours() -> dict[str, str]:
    """Return the colours of things on a map, as ``#rrggbb``, by names such as ``barrier-laser``."""
    return {
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
