"""Truth and robustness of guards at the values of the atoms (semantics, sections 1 and 3).

A guard is given by its prime implicants; ``values`` holds the robustness of each atom, in [-1, 1].
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Guard, Implicant


def holds(guard: Guard, values: Sequence[float]) -> bool:
    """Whether some prime implicant is true. An atom is true iff its value is strictly above 0."""
    return any(all((values[atom] > 0.0) == polarity for atom, polarity in prime) for prime in guard.primes)


def robustness(guard: Guard, values: Sequence[float]) -> float:
    """Return the greatest robustness of a prime implicant, in [-1, 1].

    ▲ The paper evaluates the guard as written. Over all primes, the value is independent of how the
    guard is written.
    """
    return max([prime_robustness(prime, values) for prime in guard.primes])


def prime_robustness(prime: Implicant, values: Sequence[float]) -> float:
    """Return the least value of a literal (the atom's value or its negative); 1 if there are no literals."""
    least = 1.0
    for atom, polarity in prime:
        value = values[atom] if polarity else -values[atom]
        if value < least:
            least = value
    return least


def bounding_atom(guards: Sequence[Guard], values: Sequence[float]) -> int:
    """Return the atom of :func:`bounding_literal`."""
    return bounding_literal(guards, values)[0]


def bounding_literal(guards: Sequence[Guard], values: Sequence[float]) -> tuple[int, bool]:
    """Return the literal that bounds the most robust guard: the first least literal of the first best prime."""
    primes = (prime for guard in guards for prime in guard.primes)
    best = max(primes, key=lambda prime: prime_robustness(prime, values))
    return min(best, key=lambda literal: values[literal[0]] if literal[1] else -values[literal[0]])
