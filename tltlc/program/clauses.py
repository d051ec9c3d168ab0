"""From terms to clauses: what an ``or`` of ``and``s is as an ``and`` of ``or``s."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, TypeVar

_MOST: Final = 16
"""How many clauses are followed up; there can be exponentially many."""

_Literal = TypeVar("_Literal")


def shorter(terms: Sequence[Sequence[_Literal]]) -> list[list[_Literal]] | None:
    """The clauses of some terms, where they have fewer literals than these, else None.

    The greatest of the terms' least values is the least of the clauses' greatest, but for the sign of a zero, since min
    and max distribute.  Literals stand in the order of the terms, none of which is empty.
    """
    found = _clauses(terms)
    return found if found is not None and sum(map(len, found)) < sum(map(len, terms)) else None


def _clauses(terms: Sequence[Sequence[_Literal]]) -> list[list[_Literal]] | None:
    """The least sets of literals that share one with each term (Berge, Hypergraphs, 1989); None if they are many."""
    literals = list(dict.fromkeys(literal for term in terms for literal in term))
    bits = {literal: 1 << place for place, literal in enumerate(literals)}
    clauses = [0]
    for term in terms:
        mask = sum(bits[literal] for literal in term)
        met = [clause for clause in clauses if clause & mask]
        longer = [clause | bits[literal] for clause in clauses if not clause & mask for literal in term]
        clauses = met + [one for one in longer if not any(one & other == other for other in met)]
        if len(clauses) > _MOST:
            return None
    places = sorted([place for place in range(len(literals)) if clause >> place & 1] for clause in clauses)
    return [[literals[place] for place in clause] for clause in places]
