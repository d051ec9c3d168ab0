"""All small formulas; a wrong law usually fails on one of them."""

from __future__ import annotations

from functools import lru_cache

from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula

UNARY = (f.not_, f.next_, f.weak_next, f.eventually, f.always)
BINARY = (f.and_, f.or_, f.implies, f.iff, f.until, f.weak_until, f.release, f.strong_release)


@lru_cache
def formulas_of_size(size: int, atoms: tuple[str, ...] = ("a", "b")) -> tuple[Formula, ...]:
    """Return all formulas over the atoms with exactly ``size`` atoms, constants and operators."""
    if size == 1:
        return (*map(f.atom, atoms), TRUE, FALSE)
    formulas = [make(inner) for make in UNARY for inner in formulas_of_size(size - 1, atoms)]
    for left_size in range(1, size - 1):
        for left in formulas_of_size(left_size, atoms):
            for right in formulas_of_size(size - 1 - left_size, atoms):
                formulas.extend(make(left, right) for make in BINARY)
    return tuple(dict.fromkeys(formulas))


def formulas_up_to(size: int, atoms: tuple[str, ...] = ("a", "b")) -> tuple[Formula, ...]:
    """Return all formulas with at most ``size`` atoms, constants and operators."""
    return tuple(formula for exactly in range(1, size + 1) for formula in formulas_of_size(exactly, atoms))
