"""Check the guards of an artefact.

A guard must be the list of all its prime implicants. At each sample, exactly one guard of each state
must be true. Only samples at which no two atoms of an exclusive group hold count
(``docs/semantics.md``, "Guards and their robustness").

A cube is a conjunction of literals. It is stored as two bit sets: the atoms that must be true, and
the atoms that must be false.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from tltlc.artefact.locations import JsonPath
from tltlc.automaton.fspa import Fspa, Implicant

MaskCube = tuple[int, int]

WORK_LIMIT = 200_000
"""The most operations on cubes in one check. They take about a fifth of a second.

A check that needs more operations stops without a result.
"""

_BITS_OF_A_STEP = 512
"""With more atoms than this, one operation on cubes may count as several operations."""


class _TooManyCubesError(Exception):
    """Raised when the check of guards reaches its work limit."""


class _CubeBudget:
    """Counts operations on cubes, and raises _TooManyCubesError when there are too many.

    The limit is not in seconds, because then the result would depend on the machine.
    """

    def __init__(self) -> None:
        self.left = WORK_LIMIT

    def spend(self, amount: int = 1) -> None:
        self.left -= amount
        if self.left < 0:
            raise _TooManyCubesError


def guard_problems(fspa: Fspa) -> Iterator[tuple[JsonPath, str]]:
    """Yield the first problem of the guards, as a path in the document and a message; nothing without a problem.

    There are two kinds of problems. A guard may not be the complete list of its prime implicants. In a
    state, several guards, or none, may be true at some sample. The check stops without a result after
    :data:`WORK_LIMIT` operations. The indices in ``fspa`` must be in range.
    """
    work = _CubeBudget()
    leaving: list[list[int]] = [[] for _ in fspa.states]
    for index, edge in enumerate(fspa.edges):
        leaving[edge.source].append(index)
    cubes: list[list[MaskCube]] = []
    try:
        # Building the pairs is work too: each has a bit for each atom, and each guard is compared with all pairs.
        work.spend(sum(len(group) ** 2 // 2 for group in fspa.exclusive) * (1 + len(fspa.atoms) // _BITS_OF_A_STEP))
        pairs = [(1 << a | 1 << b, 0) for group in fspa.exclusive for a, b in combinations(group, 2)]
        for index, edge in enumerate(fspa.edges):
            cubes.append([_cube(prime) for prime in edge.guard.primes])
            message = _guard_problem(edge.guard.primes, cubes[index], pairs, work)
            if message:
                yield ("edges", index, "guard", "primes"), message
                return
        for state, edges in enumerate(leaving):
            for one, other in combinations(edges, 2):
                if any(_intersect(p, q, pairs, work) for p in cubes[one] for q in cubes[other]):
                    targets = f"to states {fspa.edges[one].target} and {fspa.edges[other].target}"
                    yield ("edges", other, "guard"), f"the guards from state {state} {targets} can be true at once"
                    return
            if not _covers_all([cube for index in edges for cube in cubes[index]] + pairs, work):
                yield ("states", state), f"state {state} has no edge for some samples"
                return
    except _TooManyCubesError:
        return


def _cube(prime: Implicant) -> MaskCube:
    positive = negative = 0
    for atom, polarity in prime:
        if polarity:
            positive |= 1 << atom
        else:
            negative |= 1 << atom
    return positive, negative


def _guard_problem(
    primes: Sequence[Implicant], cubes: Sequence[MaskCube], pairs: Sequence[MaskCube], work: _CubeBudget
) -> str | None:
    """Return in words why a list of implicants is not the list of all prime implicants of a guard.

    Return None if it is. ``cubes`` are the implicants ``primes`` as bit sets. ``pairs`` has the cube
    ``a & b`` for each two exclusive atoms a and b. The check uses a theorem of Quine (1955): a set of
    cubes has all prime implicants of its disjunction if and only if no cube implies another cube, and
    the consensus of every two cubes implies a cube of the set.
    """
    for prime, cube in zip(primes, cubes, strict=True):
        if len({atom for atom, _ in prime}) < len(prime):
            return "an implicant names an atom twice"
        work.spend(1 + len(pairs) // 8)
        if any(_lies_in(cube, pair) for pair in pairs):
            return "an implicant requires two exclusive atoms at once"
    work.spend(len(pairs) * len(cubes) // 8)
    uncovered = {pair for pair in pairs if not any(_lies_in(pair, cube) for cube in cubes)}
    whole = [*cubes, *sorted(uncovered)]
    for one, other in combinations(whole, 2):
        work.spend()
        if _lies_in(one, other) or _lies_in(other, one):
            return "an implicant is contained in another"
        consensus = _consensus(one, other)
        if consensus is not None:
            work.spend(len(whole))
            if not any(_lies_in(consensus, cube) for cube in whole):
                return "an implicant is missing, so that the guard's robustness would be wrong"
    return None


def _lies_in(inner: MaskCube, outer: MaskCube) -> bool:
    """Whether ``inner`` implies ``outer``: every sample that satisfies ``inner`` satisfies ``outer``."""
    return outer[0] & ~inner[0] == 0 and outer[1] & ~inner[1] == 0


def _consensus(one: MaskCube, other: MaskCube) -> MaskCube | None:
    """Return the consensus of two cubes: ``b & c`` for ``a & b`` and ``!a & c``.

    Returns None unless exactly one atom is true in one cube and false in the other.
    """
    opposed = one[0] & other[1] | one[1] & other[0]
    if opposed == 0 or opposed & (opposed - 1):
        return None
    return (one[0] | other[0]) & ~opposed, (one[1] | other[1]) & ~opposed


def _intersect(one: MaskCube, other: MaskCube, pairs: Sequence[MaskCube], work: _CubeBudget) -> bool:
    """Whether both cubes are true at some sample at which no two exclusive atoms hold.

    ``pairs`` has the cube ``a & b`` for each two exclusive atoms a and b.
    """
    work.spend()
    if one[0] & other[1] or one[1] & other[0]:
        return False
    both = (one[0] | other[0], one[1] | other[1])
    work.spend(len(pairs) // 8)
    return not any(_lies_in(both, pair) for pair in pairs)


def _covers_all(cubes: Sequence[MaskCube], work: _CubeBudget) -> bool:
    """Whether at least one of the cubes is true at every sample."""
    work.spend(1 + len(cubes))
    if (0, 0) in cubes:
        return True
    counts: dict[int, int] = {}
    for positive, negative in cubes:
        bits = positive | negative
        while bits:
            bit = bits & -bits
            counts[bit] = counts.get(bit, 0) + 1
            bits ^= bit
    if not counts:
        return False
    split = max(counts, key=lambda bit: counts[bit])
    true = [(positive & ~split, negative) for positive, negative in cubes if not negative & split]
    false = [(positive, negative & ~split) for positive, negative in cubes if not positive & split]
    return _covers_all(true, work) and _covers_all(false, work)
