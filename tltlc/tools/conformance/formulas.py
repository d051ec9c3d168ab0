"""Random formulas with every operator."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula
from tltlc.tools.conformance.draw import Draw

UNARY: Final[tuple[Callable[[Formula], Formula], ...]] = (f.not_, f.next_, f.weak_next, f.eventually, f.always)
BINARY: Final[tuple[Callable[[Formula, Formula], Formula], ...]] = (
    *(f.and_, f.or_, f.implies, f.iff, f.then),
    *(f.until, f.weak_until, f.release, f.strong_release),
)


def formula(draw: Draw, atoms: Sequence[str], leaves: int) -> Formula:
    """Return a random formula over ``atoms``. It has ``leaves`` leaves: most are atoms, a few true or false."""
    if leaves == 1:
        leaf = draw.choice((TRUE, FALSE)) if draw.chance(0.05) else f.atom(draw.choice(atoms))
        return draw.choice(UNARY)(leaf) if draw.chance(0.5) else leaf
    left = 1 + draw.below(leaves - 1)
    combined = draw.choice(BINARY)(formula(draw, atoms, left), formula(draw, atoms, leaves - left))
    return draw.choice(UNARY)(combined) if draw.chance(0.3) else combined
