"""Truth and robustness of guards at the values of the atoms (semantics, sections 1 and 3).

A guard is its prime implicants; ``values`` holds the robustness of each atom, in [-1, 1].
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Guard, Implicant


def holds(guard: Guard, values: Sequence[float]) -> bool:
    """Whether some prime implicant is true; an atom is true iff its value is > 0, strictly."""
    return any(all((values[atom] > 0.0) == polarity for atom, polarity in prime) for prime in guard.primes)


def robustness(guard: Guard, values: Sequence[float]) -> float:
    """The greatest robustness of a prime implicant, in [-1, 1].

    ▲ The paper takes the guard as it is written; over all primes the value does not depend on how that is.
    """
    return max([prime_robustness(prime, values) for prime in guard.primes])


def prime_robustness(prime: Implicant, values: Sequence[float]) -> float:
    """The least value of a literal, which is the atom's or its negative; of no literals, 1."""
    least = 1.0
    for atom, polarity in prime:
        value = values[atom] if polarity else -values[atom]
        if value < least:
            least = value
    return least


def bounding_atom(guards: Sequence[Guard], values: Sequence[float]) -> int:
    """The atom of :func:`bounding_literal`."""
    return bounding_literal(guards, values)[0]


def bounding_literal(guards: Sequence[Guard], values: Sequence[float]) -> tuple[int, bool]:
    """What bounds the most robust of the guards: the first least literal of the first best prime."""
    primes = (prime for guard in guards for prime in guard.primes)
    best = max(primes, key=lambda prime: prime_robustness(prime, values))
    return min(best, key=lambda literal: values[literal[0]] if literal[1] else -values[literal[0]])
