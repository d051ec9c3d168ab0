"""Convert terms to clauses: an ``or`` of ``and``s to an ``and`` of ``or``s."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, TypeVar

_MOST: Final = 16
"""The conversion stops if there are more clauses than this; their number can be exponential."""

_Literal = TypeVar("_Literal")


def shorter_clauses(terms: Sequence[Sequence[_Literal]]) -> list[list[_Literal]] | None:
    """Return the clauses equivalent to some terms if they have fewer literals, else None.

    ``min`` and ``max`` distribute, so the maximum over terms of their minima equals the minimum
    over clauses of their maxima, except for the sign of a zero. Literals keep the order of the
    terms, none of which may be empty.
    """
    clauses = _clauses(terms)
    return clauses if clauses is not None and sum(map(len, clauses)) < sum(map(len, terms)) else None


def _clauses(terms: Sequence[Sequence[_Literal]]) -> list[list[_Literal]] | None:
    """Return the minimal sets of literals that have a literal of every term; None if there are more than :data:`_MOST`.

    C. Berge, Hypergraphs, 1989.
    """
    literals = list(dict.fromkeys(literal for term in terms for literal in term))
    bits = {literal: 1 << index for index, literal in enumerate(literals)}
    clauses = [0]
    for term in terms:
        mask = sum(bits[literal] for literal in term)
        hitting = [clause for clause in clauses if clause & mask]
        extended = [clause | bits[literal] for clause in clauses if not clause & mask for literal in term]
        clauses = hitting + [candidate for candidate in extended if not any(candidate & hit == hit for hit in hitting)]
        if len(clauses) > _MOST:
            return None
    places = sorted([index for index in range(len(literals)) if clause >> index & 1] for clause in clauses)
    return [[literals[index] for index in clause] for clause in places]
