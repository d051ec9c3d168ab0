"""Truth and robustness of guards at a sample (``docs/semantics.md``, sections 1 and 3).

In all functions, ``values`` has the value (robustness) of each atom at the sample, in [-1, 1]. The
value of a literal is the value of its atom, multiplied by -1 if the literal is negated.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.fspa import Guard, Implicant


def holds(guard: Guard, values: Sequence[float]) -> bool:
    """Whether a guard is true, that is, whether at least one of its prime implicants is true.

    An atom is true if its value is above 0.
    """
    # Plain loops take half the time of `any` and `all` with generators, and each step asks this of several guards.
    for prime in guard.primes:
        for atom, polarity in prime:
            if (values[atom] > 0.0) != polarity:
                break
        else:
            return True
    return False


def robustness(guard: Guard, values: Sequence[float]) -> float:
    """Return the robustness of a guard, in [-1, 1]: the greatest robustness of a prime implicant.

    ▲ Unlike here, the paper (Gutiérrez-Sánchez et al. 2024) computes it from the guard's formula. So
    in the paper, equivalent formulas may have different robustness. Here their robustness is the
    same, because their prime implicants are the same.
    """
    return max([prime_robustness(prime, values) for prime in guard.primes])


def prime_robustness(prime: Implicant, values: Sequence[float]) -> float:
    """Return the robustness of a prime implicant: the least value of its literals, 1 if it has no literals."""
    least = 1.0
    for atom, polarity in prime:
        value = values[atom] if polarity else -values[atom]
        if value < least:
            least = value
    return least


def bounding_atom(guards: Sequence[Guard], values: Sequence[float]) -> int:
    """Return the index of the atom that limits the robustness of the most robust guard.

    It is the atom of the literal that :func:`bounding_literal` returns.
    """
    return bounding_literal(guards, values)[0]


def bounding_literal(guards: Sequence[Guard], values: Sequence[float]) -> tuple[int, bool]:
    """Return the literal that limits the robustness of the most robust of the guards.

    Take the most robust prime implicant of all guards, and its literal with the least value; the
    first one if values are equal. The literal is returned as the index of its atom, and whether it
    is positive. No guard may be always true.
    """
    primes = (prime for guard in guards for prime in guard.primes)
    best = max(primes, key=lambda prime: prime_robustness(prime, values))
    return min(best, key=lambda literal: values[literal[0]] if literal[1] else -values[literal[0]])
