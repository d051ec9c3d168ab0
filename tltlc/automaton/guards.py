"""Guards: Boolean functions of the atoms, as their prime implicants and as a short formula.

A guard is stored as a decision diagram with the leaves ``ACCEPT`` (true) and ``REJECT`` (false) of
:mod:`tltlc.automaton.transitions`. A literal is an int: ``2 * i + 1`` if atom ``i`` is true,
``2 * i`` if it is false. A cube is a conjunction of literals, as an ascending tuple.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.diagrams import LEAF
from tltlc.automaton.fspa import Implicant
from tltlc.automaton.transitions import ACCEPT, IMPOSSIBLE, REJECT, TransitionDiagrams
from tltlc.io.limits import WORK
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula

LiteralCube = tuple[int, ...]

PRIME_LIMIT = 10_000
"""The most prime implicants of one guard, and the most conjunctions in its short formula."""
TOTAL_PRIME_LIMIT = 1_500_000
"""The most prime implicants of all guards of an automaton together; a million takes up a gigabyte of memory."""

_MOST_REMEMBERED = 200_000
"""The caches of covers and prime implicants are emptied when they have more entries than this."""
_MOST_PRODUCTS_REMEMBERED = 1_000_000
"""The caches are also emptied when more cubes than this were computed since they were last emptied."""

_PRIMES_OF_CONSTANTS: dict[int, tuple[LiteralCube, ...]] = {REJECT: (), ACCEPT: ((),)}


class TooManyPrimes(Exception):
    """Raised when the guards of an automaton are too large.

    The message is "``subject``: more than ``limit`` ``unit``", such as "a guard: more than 10000
    prime implicants". ``subject`` is "a guard", "all guards" or "the automaton". The limits are:

    - :data:`PRIME_LIMIT`, for the prime implicants or conjunctions of one guard;
    - :data:`TOTAL_PRIME_LIMIT`, for the prime implicants of all guards;
    - the entries "edges" and "partial products" of :data:`~tltlc.io.limits.WORK`.
    """

    def __init__(self, subject: str = "a guard", limit: int = PRIME_LIMIT, unit: str = "prime implicants") -> None:
        super().__init__(f"{subject}: more than {limit} {unit}")
        self.subject, self.limit, self.unit = subject, limit, unit

    def title(self, name: str) -> str:
        """Return the title of the error message; ``name`` is the name of the automaton."""
        verb = "have" if self.subject == "all guards" else "has"
        return f"{self.subject} of `{name}` {verb} more than {self.limit} {self.unit}"


class Guards:
    """Computes the prime implicants and the short formulas of guards.

    A guard is a node of the decision diagrams ``diagrams``. ``names`` are the names of the atoms.
    ``allowed`` is a guard that is true on exactly the letters that ``exclusive`` declarations
    allow; a letter is the set of the atoms that hold at a sample. A cube is a conjunction of
    literals, which are ints: ``2 * i + 1`` if atom ``i`` is true, ``2 * i`` if it is false.
    """

    __slots__ = (
        "_allowed",
        "_by_leaf",
        "_covers",
        "_diagrams",
        "_literals",
        "_negations",
        "_pairs",
        "_possible_cubes",
        "_primes",
        "_products",
        "_remembered",
        "_total",
    )

    def __init__(self, diagrams: TransitionDiagrams, names: Sequence[str], allowed: int = ACCEPT) -> None:
        self._diagrams = diagrams
        self._allowed = allowed
        self._total = 0
        self._products = 0
        self._remembered = 0
        self._literals = [literal for name in names for literal in (build.not_(build.atom(name)), build.atom(name))]
        self._pairs = [(atom, polarity) for atom in range(len(names)) for polarity in (False, True)]
        self._by_leaf: dict[int, dict[int, int]] = {}
        self._primes = dict(_PRIMES_OF_CONSTANTS)
        self._possible_cubes: dict[LiteralCube, bool] = {}
        self._covers: dict[tuple[int, int], tuple[tuple[LiteralCube, ...], int]] = {}
        self._negations: dict[int, int] = {ACCEPT: REJECT, REJECT: ACCEPT}

    def by_leaf(self, transition: int) -> dict[int, int]:
        """Map each leaf of a transition to a guard, which is true on the letters that lead to this leaf.

        A transition is a decision diagram that maps each letter to a leaf. The result does not have
        ``IMPOSSIBLE``, the leaf for letters that cannot occur.
        """
        guards = self._split(transition)
        return {leaf: guard for leaf, guard in guards.items() if leaf != IMPOSSIBLE}

    def _split(self, transition: int) -> dict[int, int]:
        guards = self._by_leaf.get(transition)
        if guards is None:
            diagrams = self._diagrams
            atom = diagrams.variable[transition]
            if atom == LEAF:
                guards = {transition: ACCEPT}
            else:
                below, above = self._split(diagrams.low[transition]), self._split(diagrams.high[transition])
                guards = {
                    leaf: diagrams.node(atom, below.get(leaf, REJECT), above.get(leaf, REJECT))
                    for leaf in (*below, *(leaf for leaf in above if leaf not in below))
                }
            self._by_leaf[transition] = guards
        return guards

    def primes(self, guard: int) -> tuple[Implicant, ...]:
        """Return all prime implicants of a guard, sorted by length, then by atom.

        ``docs/semantics.md``, "Guards and their robustness", says why an automaton has all of them.
        If atoms are declared ``exclusive``, let D be true on the letters that the declarations
        allow. Then the result has the prime implicants of ``guard or not D``, without those that no
        letter in D satisfies. Raises :class:`TooManyPrimes`.
        """
        if self._allowed == ACCEPT:
            cubes = self._all_primes(guard)
        else:
            cubes = tuple(cube for cube in self._all_primes(self._upper(guard)) if self._is_possible(cube))
        self._total += len(cubes)
        if self._total > TOTAL_PRIME_LIMIT:
            raise TooManyPrimes("all guards", TOTAL_PRIME_LIMIT)
        if len(cubes) > 1:
            cubes = tuple(sorted(cubes, key=lambda cube: (len(cube), [literal ^ 1 for literal in cube])))
        pairs = self._pairs
        return tuple([tuple([pairs[literal] for literal in cube]) for cube in cubes])

    def formula(self, guard: int) -> Formula:
        """Return a short formula of the guard.

        The formula is a disjunction of conjunctions without redundant parts, or a conjunction of
        disjunctions if that is shorter. On letters that ``exclusive`` rules out, the formula may
        have any value. Raises :class:`TooManyPrimes`.
        """
        if (
            len(self._covers) + len(self._primes) > _MOST_REMEMBERED
            or self._products - self._remembered > _MOST_PRODUCTS_REMEMBERED
        ):
            self._covers.clear()
            self._possible_cubes.clear()
            self._primes = dict(_PRIMES_OF_CONSTANTS)
            self._remembered = self._products
        literals = self._literals
        products = self._cover(guard, self._upper(guard))
        if len(products) > 1:
            sums = self._negated_sums(guard)
            if sums and sum(map(len, sums)) < sum(map(len, products)):
                disjunctions = sorted([tuple([literal ^ 1 for literal in cube]) for cube in sums])
                return build.and_(*[build.or_(*[literals[literal] for literal in cube]) for cube in disjunctions])
        return build.or_(*[build.and_(*[literals[literal] for literal in cube]) for cube in sorted(products)])

    def _negated_sums(self, guard: int) -> tuple[LiteralCube, ...]:
        """Write the guard as a conjunction of disjunctions, and return the negation of each disjunction.

        The negation of a disjunction is a cube: ``(a | b) & c`` gives the cubes ``!a & !b`` and
        ``!c``. Returns an empty tuple if there are too many cubes (:class:`TooManyPrimes`).
        """
        try:
            return self._cover(self._negation(self._upper(guard)), self._negation(guard))
        except TooManyPrimes:
            return ()

    # --- Boolean functions --------------------------------------------------------------------

    def _cover(self, lower: int, upper: int) -> tuple[LiteralCube, ...]:
        """Return cubes whose disjunction lies between two functions; no cube can be left out.

        ``lower`` implies the disjunction, and the disjunction implies ``upper``.
        """
        if lower == upper:
            primes = self._all_primes(lower)
            literals = {literal for cube in primes for literal in cube}
            if not any(literal ^ 1 in literals for literal in literals):
                return primes  # if no atom has both polarities, all primes are needed
        return self._irredundant(lower, upper)[0]

    def _upper(self, guard: int) -> int:
        """Return ``guard or not D``, where D is true on the letters that ``exclusive`` declarations allow."""
        if self._allowed == ACCEPT:
            return guard
        return self._diagrams.disjoin(guard, self._negation(self._allowed))

    def _negation(self, guard: int) -> int:
        negations = self._negations
        negation = negations.get(guard)
        return self._diagrams.map_leaves(_negate_leaf, guard, negations) if negation is None else negation

    def _is_possible(self, cube: LiteralCube) -> bool:
        """Whether a letter that ``exclusive`` allows satisfies the cube.

        Results are cached, since guards share many cubes.
        """
        known = self._possible_cubes.get(cube)
        if known is None:
            known = self._possible_cubes[cube] = self._is_met(cube)
        return known

    def _is_met(self, cube: LiteralCube) -> bool:
        diagrams = self._diagrams
        rest = self._allowed
        polarity_of = {literal >> 1: literal & 1 for literal in cube}
        stack, seen = [rest], {rest}
        while stack:
            node = stack.pop()
            if node == ACCEPT:
                return True
            if node == REJECT:
                continue
            polarity = polarity_of.get(diagrams.variable[node])
            for value, child in ((0, diagrams.low[node]), (1, diagrams.high[node])):
                if polarity in (None, value) and child not in seen:
                    seen.add(child)
                    stack.append(child)
        return False

    def _all_primes(self, function: int) -> tuple[LiteralCube, ...]:
        """Return every prime implicant of a function.

        Splits the function by its first atom ``a``: ``low`` is the function with ``a`` false,
        ``high`` with ``a`` true. The prime implicants are those of ``low & high``; the other ones
        of ``high``, with ``a`` added; and the other ones of ``low``, with ``!a`` added.
        """
        known = self._primes.get(function)
        if known is None:
            diagrams = self._diagrams
            atom, low, high = diagrams.variable[function], diagrams.low[function], diagrams.high[function]
            shared = self._all_primes(diagrams.conjoin(low, high))
            common = set(shared)
            known = (
                *(((2 * atom + 1), *cube) for cube in self._all_primes(high) if cube not in common),
                *(((2 * atom), *cube) for cube in self._all_primes(low) if cube not in common),
                *shared,
            )
            self._count(len(known))
            self._primes[function] = known
        return known

    def _irredundant(self, lower: int, upper: int) -> tuple[tuple[LiteralCube, ...], int]:
        """Return cubes as :meth:`_cover` does, and their disjunction as a function (Minato 1993)."""
        if lower == REJECT:
            return (), REJECT
        if upper == ACCEPT:
            return ((),), ACCEPT
        cover = self._covers.get((lower, upper))
        if cover is None:
            diagrams, negation = self._diagrams, self._negation
            conjoin, disjoin = diagrams.conjoin, diagrams.disjoin
            atom = min(diagrams.variable[lower], diagrams.variable[upper])
            lower0, lower1 = _cofactors(diagrams, lower, atom)
            upper0, upper1 = _cofactors(diagrams, upper, atom)
            # First cover the letters that need a cube with a literal of the atom, then the other letters with cubes
            # without it.
            without, covered0 = self._irredundant(conjoin(lower0, negation(upper1)), upper0)
            with_, covered1 = self._irredundant(conjoin(lower1, negation(upper0)), upper1)
            rest = disjoin(conjoin(lower0, negation(covered0)), conjoin(lower1, negation(covered1)))
            free, covered = self._irredundant(rest, conjoin(upper0, upper1))
            cubes = (
                *((2 * atom + 1, *cube) for cube in with_),
                *((2 * atom, *cube) for cube in without),
                *free,
            )
            self._count(len(cubes))
            cover = cubes, disjoin(diagrams.node(atom, covered0, covered1), covered)
            self._covers[lower, upper] = cover
        return cover

    def _count(self, products: int) -> None:
        """Add ``products``, a number of new cubes, to the count of all cubes computed so far.

        Raises :class:`TooManyPrimes` if this number or the count is too large.
        """
        self._products += products
        if products > PRIME_LIMIT:
            raise TooManyPrimes
        if self._products > WORK["partial products"]:
            raise TooManyPrimes("all guards", WORK["partial products"], "partial products")


def _negate_leaf(leaf: tuple[int, int]) -> tuple[int, int]:
    """Return the opposite leaf of a guard: ``(TRUE, 1)`` for ``(FALSE, 0)``, and the other way round."""
    return 1 - leaf[0], 1 - leaf[1]


def _cofactors(diagrams: TransitionDiagrams, function: int, atom: int) -> tuple[int, int]:
    if diagrams.variable[function] != atom:
        return function, function
    return diagrams.low[function], diagrams.high[function]
