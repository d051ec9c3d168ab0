"""Read a clock: the time from one sample to the next, written as a frequency or as a time."""

from __future__ import annotations

from typing import Final

from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import ClockDecl
from tltlc.resolve import units

SHORTEST_S: Final = 1e-9
LONGEST_S: Final = 1e9


def period_s(value: float, unit: str | None) -> float | None:
    """Return the seconds between two samples, given a frequency (``20``, ``"Hz"``) or a time (``50``, ``"ms"``).

    Return None if the value is not above zero, or if the unit is neither Hz nor a unit of time.
    """
    in_si = units.in_si(value, unit)
    if in_si is None or value <= 0:
        return None
    if unit == "Hz":
        return 1.0 / in_si[0]
    return in_si[0] if in_si[1] == units.TYPES["time"] else None


def clock_from_text(text: str) -> float | None:
    """Return the seconds between two samples for a text such as ``20 Hz`` or ``0.05 s``.

    The text is what follows the word ``clock`` in a declaration. Return None for any other text, and
    for a period outside [1e-9, 1e9] seconds.
    """
    module, errors = parse(SourceFile("<clock>", f"clock {text}", "text"))
    if errors or module.comments or len(module.declarations) != 1:
        return None
    (clock,) = module.declarations
    value = clock.value if isinstance(clock, ClockDecl) else None
    period = None if value is None else period_s(value.value, value.unit)
    return period if period is not None and SHORTEST_S <= period <= LONGEST_S else None
