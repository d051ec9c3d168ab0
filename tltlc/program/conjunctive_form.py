"""Convert a disjunction of conjunctions (terms) to an equivalent conjunction of disjunctions (clauses)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, TypeVar

_MOST: Final = 16
"""The most clauses. There can be exponentially many; the conversion gives up if there are more."""

_Literal = TypeVar("_Literal")


def shorter_clauses(terms: Sequence[Sequence[_Literal]]) -> list[list[_Literal]] | None:
    """Return clauses that are equivalent to ``terms``, if they are shorter.

    A term is true if all its literals are; a clause is true if one of its literals is. ``[[a, b],
    [a, c]]`` gives ``[[a], [b, c]]``. Return None if the clauses do not have fewer literals than
    the terms, or if there are more clauses than :data:`_MOST`.

    The robustness stays the same, except for the sign of a zero: ``max(min(term) for each term)``
    is ``min(max(clause) for each clause)``. Literals keep the order of the terms. No term may be
    empty.
    """
    clauses = equivalent_clauses(terms)
    return clauses if clauses is not None and sum(map(len, clauses)) < sum(map(len, terms)) else None


def equivalent_clauses(terms: Sequence[Sequence[_Literal]]) -> list[list[_Literal]] | None:
    """Return clauses that are equivalent to ``terms``: the minimal sets of literals that share one with every term.

    Return None if there are more clauses than :data:`_MOST`. The method is from C. Berge,
    Hypergraphs, 1989.
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
